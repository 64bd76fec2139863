// How many unbiased samples correct a picture by many lights.
#pragma once

namespace brisance {

// As many as lighting.error and the frame's forecast time say (forecast/correction_plan.h).
inline constexpr int kAutomaticCorrection = -1;

struct CorrectionSettings {
    int samples = kAutomaticCorrection;  // camera rays with their paths, in the whole picture; 0: none
};

}  // namespace brisance
