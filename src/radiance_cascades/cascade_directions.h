// Directions of radiance cascades: texels of an octahedral map of equal areas, each divided into four for the next
// cascade.
#pragma once

#include <array>
#include <vector>

#include "core/vec.h"
#include "medium/sh.h"

namespace brisance {

// The unit direction of a point of the square [-1, 1]^2; equal areas of the square are equal solid angles.
// Clarberg, Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD, JGT 13(3), 2008.
vec3 equal_area_direction(double u, double v);

class CascadeDirections {
public:
    using Basis = std::array<float, kShMoments>;

    // `divided`: for each cascade above the first, whether it has four directions for each of the cascade below;
    // otherwise it has the same.
    CascadeDirections(int side, const std::vector<bool>& divided);

    // Unit directions toward the light; those that divide direction d are 4 d ... 4 d + 3.
    const std::vector<vec3>& of(int cascade) const { return directions_[cascade]; }
    int count(int cascade) const { return static_cast<int>(directions_[cascade].size()); }
    // Children of each direction in the next cascade: 4 or 1.
    int children(int cascade) const { return count(cascade + 1) / count(cascade); }

    // Means over a texel of the finest cascade of the spherical harmonics (sh.h), of the direction of travel.
    const Basis& mean_basis(int direction) const { return mean_[direction]; }
    // The same, such that radiance whose means are mean_basis has moment 1: texels blur the higher degrees.
    const Basis& moment_basis(int direction) const { return moment_[direction]; }

private:
    std::vector<std::vector<vec3>> directions_;
    std::vector<Basis> mean_, moment_;
};

}  // namespace brisance
