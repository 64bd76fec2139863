// Directions from a point toward the sphere of a light.
#pragma once

#include "core/rng.h"
#include "emitters/light_tree.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

// Uniform over the solid angle of the sphere; from inside it any direction that the point can be lit from. `numbers`:
// in [0, 1)^2; from any point they reach all directions.
dvec3 direction_toward(const VirtualLight& light, const LitPoint& point, const glm::dvec2& numbers);
dvec3 sample_toward(const VirtualLight& light, const LitPoint& point, Rng& rng);
// Whether a direction leads into the sphere.
bool leads_into(const VirtualLight& light, const LitPoint& point, const dvec3& direction);
// Density [1/sr] of a direction that leads into the sphere.
double pdf_toward(const VirtualLight& light, const LitPoint& point, const dvec3& direction);

}  // namespace brisance
