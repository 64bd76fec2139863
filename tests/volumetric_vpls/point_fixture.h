// Point lights in the small media of the tests of ray lights.
#pragma once

#include "fixtures/ray_fixture.h"
#include "volumetric_vpls/volumetric_vpls.h"

namespace brisance::testing {

// `radius`: 1 / sqrt(bound) [m]; 0: unbounded.
VolumetricVplSettings points(double radius, BiasCompensation compensation);

// MM and SM by independent sets of such lights.
Estimate mean_by_points(const Stage& stage, const VolumetricVplSettings& settings, std::uint64_t sets = 1);

LightSettings lamp_beside();

}  // namespace brisance::testing
