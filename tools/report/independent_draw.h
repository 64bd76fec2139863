// Random numbers that differ from those of an ordinary render.
//
// The path tracer names its random numbers by the pixel's place in the picture and the number of the path. A run and a
// reference of one size would share their first paths: the run would look better than it is. A picture one column wider
// on each side shows the same pixels by the same rays, under other places, and so with independent numbers.
#pragma once

#include "metrics/picture.h"
#include "shot/shot.h"

namespace brisance {

// Needs a camera that is given: a framed one would move.
Shot drawn_independently(Shot shot);

// The picture without the columns that drawn_independently adds.
Picture without_margin(const Picture& picture);

}  // namespace brisance
