// Gradient noise and the curl noise made from it.
#pragma once

#include <cstdint>

#include "field.h"

namespace brisance::combustion {

// Uniform in [0, 1), a function of its key alone.
float hashed_uniform(std::uint32_t seed, std::uint32_t key, std::uint32_t purpose);

// About [-1, 1], features of unit size. `period` > 0 makes it repeat after that many units.
float gradient_noise(const vec3& x, std::uint32_t seed, int period = 0);

// Sum of octaves of gradient_noise, each twice as fine and `gain` times as strong as the one before.
float fractal_noise(const vec3& x, std::uint32_t seed, int octaves, float gain = 0.5f);

// One period of a divergence-free field of unit root mean square: the curl of a noise potential [1].
// [1] Bridson, Houriham & Nordenstam, Curl-Noise for Procedural Fluid Flow, SIGGRAPH 2007, eq. (1).
class CurlNoise {
public:
    explicit CurlNoise(std::uint32_t seed);
    // Features of about unit size.
    vec3 operator()(const vec3& x) const;

private:
    Field<vec4> tile_;
};

}  // namespace brisance::combustion
