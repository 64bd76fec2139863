// Deposits of camera paths: the surfaces from which light that the camera sees may have come.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "transport/direct_light.h"
#include "virtual_lights/placement/deposit.h"

namespace brisance {

// A camera as the module needs it.
struct PixelCamera {
    int width = 0, height = 0;                   // [pixels]
    std::function<Ray(double x, double y)> ray;  // local; x, y in pixels from the upper left corner
    // Of the whole picture, as far as known, that are lit by what lies on surfaces.
    double samples = std::numeric_limits<double>::infinity();
};

// No path can be sent through its picture.
bool without_pixels(const PixelCamera& camera);

// The first surface that camera paths meet after they were scattered, by a surface that is no mirror or by smoke; and,
// where that is glossy, the next. Their density follows how much of the light from there the camera may see. Paths are
// numbered and draw their random numbers by that number; `paths` of them are divided among the cameras, one by one, and
// those of each are spread over its picture.
std::vector<Deposit> light_candidates(const DirectLight& scene, std::span<const PixelCamera> cameras, std::size_t paths,
                                      std::uint32_t seed);

}  // namespace brisance
