// Light from infinity: a latitude-longitude picture, or a constant radiance.
#pragma once

#include <optional>
#include <vector>

#include "scene/settings.h"
#include "scene/texture.h"

namespace brisance {

// The picture's centre looks along the world's x; to its right lies -y where z is up, and z where y is up. Its top is
// `up`. Directions are sampled in proportion to the picture's luminance and, with a small probability, uniformly.
class Environment {
public:
    // Without a picture the radiance is `light.power` everywhere. Keeps a copy of neither.
    Environment(const LightSettings& light, const Texture* picture);

    Rgb radiance(const dvec3& direction) const;  // [W/(m^2 sr)]
    // A unit vector, from two numbers in [0, 1).
    dvec3 sample(double u, double v) const;
    double pdf(const dvec3& direction) const;  // [1/sr]

    // By the picture's coordinates, from 0 to 1: across, a whole turn, and from its top down.
    dvec3 direction_of(double u, double v) const;
    const Texture* picture() const { return picture_; }  // or null

private:
    vec2 picture_of(const dvec3& direction) const;

    const Texture* picture_;
    Rgb factor_;
    dmat3 picture_from_world_{1.0};
    // Cumulative over rows, and within each row; both end at 1.
    std::vector<double> rows_, columns_;
};

}  // namespace brisance
