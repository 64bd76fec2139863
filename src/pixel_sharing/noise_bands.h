// Tells noise from light on surfaces, and takes it away.
//
// Pixels share over a part of the distance to the surfaces around (shared_bounce.h). In a corner that is about a pixel,
// and few samples are left noisy, while along the edge of the corner the light hardly changes. How far it is alike is
// therefore learned from the samples. They are two halves with independent noise. Blurs of 1, 2, 4, ... pixels, which
// cross no edges (H. Dammertz et al., Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination Filtering,
// HPG 2010), divide the light into bands. In each band the product of both halves has the mean of the light's own
// square, and the square of their mean that of light and noise together. Their quotient, both averaged over a
// neighbourhood some times as wide as the band, is the gain that leaves the least square error, Wiener's: where
// a band is noise it vanishes, and where it is light it stays. As samples grow, all gains go to 1.
//
// Blurs follow surfaces on which light is alike: of one normal and plane, at a like distance from others. Bands that
// are wrong all the same show it, and stay.
#pragma once

#include <vector>

#include "pixel_sharing/patches.h"

namespace brisance {

// Of each kind of light on each patch. The errors are those that the gains expect: the noise that they keep, and the
// light that they take away.
struct CalmLight {
    std::vector<Rgb> lights;
    std::vector<float> square_errors;  // sum over the channels
};
CalmLight without_noise(const PatchMap& map, HalvedLight light);

}  // namespace brisance
