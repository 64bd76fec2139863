// Transforms linear radiance to display values.
#pragma once

#include "core/vec.h"
#include "film/settings.h"

namespace brisance {

// Exposed linear Rec. 709 to display-encoded sRGB in [0, 1]. Negative and non-finite input counts as black, +infinity
// as white.
//
// Srgb: the piecewise sRGB curve [1], clipped at 1.
// Filmic: a tone curve per channel after mixing in a share of the channels' luminance Y:
//   c_i = (1 - k) x_i + k Y(x),   k = 0.1
//   t_i = (a c_i^2 + b c_i) / (a c_i^2 + d c_i + e)   [2], a fit of the ACES reference tone scale
// then the sRGB curve. The share lets a saturated highlight (fire: red a hundred times its blue) meet the curve's
// shoulder with all channels, so that it runs to white instead of stopping at flat yellow. What the share takes from
// the colour of mid-tones, the curve's toe gives back. Smooth for all positive x: gradients show no crease. [1] IEC
// 61966-2-1. [2] K. Narkowicz, ACES Filmic Tone Mapping Curve, 2016, scaled to reach 1 only at infinity.
vec3 apply_view(const Rgb& exposed, ViewTransform view);

}  // namespace brisance
