// The open shutter: moments of a frame.
#pragma once

#include <vector>

#include "camera/settings.h"

namespace brisance {

// `count` moments of equal weight, in frames from the frame itself, ascending: the middles of equal shares of the light
// that the shutter lets through. One moment for a shutter of length 0.
std::vector<double> shutter_moments(const ShutterSettings& shutter, int count);

// The first and the last instant at which the shutter is open, in frames from the frame itself.
struct ShutterSpan {
    double opens, closes;
};
ShutterSpan shutter_span(const ShutterSettings& shutter);

}  // namespace brisance
