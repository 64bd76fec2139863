// The change of one frame that its neighbours do not have: what flickers, without a reference.
//
//   ||I_n - (warp(I_(n-1)) + warp(I_(n+1))) / 2|| / ||I_n||
//
// over the pixels whose points were seen in both neighbours. What changes steadily from frame to frame has none, and
// neither has what the cameras' motion explains. Smoke that moves, and fire that flares up, have some: it is to be
// compared with that of other frames, or of the same frames rendered otherwise.
#pragma once

#include "metrics/motion.h"

namespace brisance {

struct Neighbour {
    const Picture& picture;
    const Motion& motion;  // from the frame's pixels into the neighbour
};

struct PassingChange {
    double change = 0.0;  // infinite where the frame is black and its neighbours are not
    double seen = 0.0;    // share of the pixels that count
};

// Pixels that are not finite do not count. Throws Error BadData for pictures or motions of different sizes.
PassingChange passing_change(const Picture& frame, const Neighbour& before, const Neighbour& after);

}  // namespace brisance
