// The error that a finished frame is believed to have (certificate/believed_error.h).
//
// Of a traced picture it is the standard error that its two halves show. Of a picture by many lights, an error model
// (expected_errors.h) and a survey of few unbiased samples say it together. The survey may cost certify.belief of the
// frame's forecast time. That is of counts, so that a frame is believed to have the same error on any machine. Where it
// does not suffice to set up the path tracer, the model stands alone. Where a picture
// was corrected, the samples of the correction take the place of the survey (correct_frame.h).
#pragma once

#include "certificate/believed_error.h"
#include "certificate/certify.h"
#include "correction/correct.h"
#include "render/draw.h"
#include "render/render_frame.h"

namespace brisance {

// Says it, and warns where it is above the error that the shot `asked` for.
Belief believe(const RenderedFrame& frame, const DrawInput& input, const Shot& asked, const Correction& correction,
               StageCost& cost, Progress& progress);

// The scene that samples of the picture are unbiased of.
CertifiedScene certified_scene(const DrawInput& input);

}  // namespace brisance
