// The change of one frame that its neighbours do not have: what flickers, without a reference.
//
//   ||I_n - (I' + I'') / 2|| / sqrt((||I'||^2 + ||I_n||^2 + ||I''||^2) / 3),  I' = warp(I_(n-1)), I'' = warp(I_(n+1))
//
// over all pixels; where a point was not seen in a neighbour, the neighbour's pixel at the same place counts, so that a
// frame that shows something else stands out. What changes steadily from frame to frame has none, and neither has what
// the cameras' motion explains. Smoke that moves, and fire that flares up, have some: it is to be
// compared with that of other frames, or of the same frames rendered otherwise.
#pragma once

#include "metrics/motion.h"

namespace brisance {

struct Neighbour {
    const Picture& picture;
    const Motion& motion;  // from the frame's pixels into the neighbour
};

struct PassingChange {
    double change = 0.0;  // 0 where all are black; at most the root of 3 otherwise
    double seen = 0.0;    // share of the pixels whose points were seen in both neighbours
};

// Pixels that are not finite do not count. Throws Error BadData for pictures or motions of different sizes.
PassingChange passing_change(const Picture& frame, const Neighbour& before, const Neighbour& after);

}  // namespace brisance
