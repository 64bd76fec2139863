// One ray through the medium: radiance by ledger cell.
#pragma once

#include <limits>

#include "camera_rays/ray_sum.h"
#include "camera_rays/source_field.h"
#include "core/step_density.h"

namespace brisance {

// Integrates one ray against the field's own interpolation. Each voxel's segment is cut into `parts`. Extinction and
// source are constant on every part and are evaluated at Gauss points, so that the optical depth of a voxel is exact
// for two parts; each part is integrated in closed form with phi1. `end`: distance of the surface that ends the ray
// [m].
RaySum integrate(const SourceField& field, const Ray& ray, int parts,
                 double end = std::numeric_limits<double>::infinity());

// About where on the ray the light of emitters scatters, as the field's nodes know it, by the distance from its origin
// [m]. Empty where they hold none.
void guide_by_emitters(const SourceField& field, const Ray& ray, double end, StepDensity& guide);

}  // namespace brisance
