// How many unbiased samples correct a picture by many lights (correction/correct.h), decided from counts.
//
// Below some hundredths the error of lighting grids falls slowly: half the error takes several times as long, and some
// of it stays. Samples of what the picture misses are cheaper there, as it misses alike over many pixels. With
// correction.samples=auto the lights are therefore built for an error of 0.02, or for twice that which is asked where
// that is less (but not below 0.01). Lattices may add up to three times as much as without samples, since that is what
// samples see best, if that saves more time than samples usually take. It leaves more error in single cells. Samples
// follow until the picture is expected to err as little as is asked. They may take twice as long as the picture where
// 0.02 is asked for, and up to twelve times as long for less; from 0.02 to 0.04 all of this fades, and a draft has no
// samples. Only frames with smoke or fire whose time is known within a factor of three (grid_is_estimated()) are
// corrected so: of others it is not known whether samples would tell anything. Baselines are not.
#pragma once

#include <cstddef>

#include "emitters/surroundings.h"
#include "forecast/costs.h"

namespace brisance {

// Fewer samples tell nothing that is worth their set-up.
constexpr double kFewestCorrections = 4096.0;

// lighting.error that the lights are built for.
float error_of_lights(const Shot& shot, const Plan& plan);
struct FrameOfLights {
    const Medium& medium;
    const Surroundings* surroundings;  // null: none
    const CameraSettings& camera;
    const CountedMedium* counted = nullptr;  // null: the medium is counted where that is needed
};
// The shot with that error, and with what its lattices may add, unless it states them.
Shot shot_of_lights(Shot shot, const Plan& plan, const FrameOfLights& frame);

// Forecast seconds of the samples over those of the picture that they correct: at most, and as they usually are. 0
// where the shot states a number.
double most_of_correction(const Shot& shot, const Plan& plan);
double usual_correction(const Shot& shot, const Plan& plan);

// grid_seconds() of a picture with its usual correction. `shot`: with the error that is asked.
double corrected_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan,
                         const CameraSettings& camera);

// Samples that take so many times the forecast seconds of the picture, of its smoke alone where there is a set: what
// the lights of a set miss is mostly too fine for samples. `shot`: that of the lights.
std::size_t samples_of_share(double share, const Shot& shot, const CountedMedium& counted, const Plan& plan,
                             const PathTracer& tracer, const Camera& camera);

}  // namespace brisance
