// The correction of a frame by many lights (correction/correct.h): as many samples as the shot states, or as many as it
// takes until the picture is expected to have the error that is asked for (forecast/correction_plan.h).
#pragma once

#include "certificate/believed_error.h"
#include "correction/correct.h"
#include "render/draw.h"
#include "render/render_frame.h"

namespace brisance {

// Whether there may be samples. `asked`: the shot with the error that was asked for.
bool may_be_corrected(const Shot& asked, const Plan& plan);

// Corrects the frame's picture, and notes what that took. The input is that of the picture, with layers of its cells.
Correction correct_frame(RenderedFrame& frame, const DrawInput& input, const Shot& asked, Progress& progress);

// What is expected of a layer's error when the model expects `error` of the lights: what the correction's samples
// measured, by Bayes' theorem (certificate/believed_error.h), and what they left of that.
ExpectedError error_left(ExpectedError error, const Correction& correction);

}  // namespace brisance
