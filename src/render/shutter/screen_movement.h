// How far things move in the picture while the shutter is open.
#pragma once

#include <array>

#include "render/shutter/open_shutter.h"

namespace brisance {

// The longest way on the screen of what can be seen, in pixels: of the smoke, of surfaces, and of what is far behind
// them. `instants`: when the shutter opens, in its middle, and when it closes, of one medium that `medium` is at the
// frame itself.
double largest_movement(const Medium& medium, const std::array<Instant, 3>& instants);

}  // namespace brisance
