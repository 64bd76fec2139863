// Media that move in known ways.
#pragma once

#include <functional>

#include "fixtures/media.h"

namespace brisance::testing {

// [m per frame] at a position [m].
using Velocity = std::function<vec3(const vec3&)>;

Medium with_velocity(Medium medium, const Velocity& velocity);
Velocity everywhere(const vec3& velocity);

// Extinction exp(-r^2 / 2 s^2) per metre about `centre`, of standard deviation s = 5 nodes, emission in proportion;
// nodes are a tenth of a metre apart.
Medium gaussian(const dvec3& centre, float extinction = 1.0f, float albedo = 0.0f);
constexpr double kSpacing = 0.1, kDeviation = 0.5;  // [m]

double total(const std::vector<float>& values);

}  // namespace brisance::testing
