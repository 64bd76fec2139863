// Point lights in the small media of the tests of ray lights.
#pragma once

#include "medium_points/medium_points.h"
#include "ray_fixture.h"

namespace brisance::testing {

// `radius`: 1 / sqrt(bound) [m]; 0: unbounded.
PointLightSettings points(double radius, BiasCompensation compensation);

// MM and SM by independent sets of such lights.
Estimate mean_by_points(const Stage& stage, const PointLightSettings& settings, std::uint64_t sets = 1);

LightSettings lamp_beside();

}  // namespace brisance::testing
