// One ray through the medium: radiance by ledger cell.
#pragma once

#include "camera_rays/one_sided_voxels.h"
#include "camera_rays/ray_sum.h"
#include "camera_rays/source_field.h"
#include "core/step_density.h"

namespace brisance {

// Integrates one ray against the field's own interpolation. Each voxel's segment is cut into `parts`. Extinction and
// source are constant on every part and are evaluated at Gauss points, so that the optical depth of a voxel is exact
// for two parts; each part is integrated in closed form with phi1. Voxels that the surface at the end cuts show the
// light of its near side (one_sided_voxels.h).
RaySum integrate(const SourceField& field, const Ray& ray, int parts, const RayEnd& end = {});

// About where on the ray the light of emitters scatters, as the field's nodes know it, by the distance from its origin
// [m]. Empty where they hold none.
void guide_by_emitters(const SourceField& field, const Ray& ray, double end, StepDensity& guide);

}  // namespace brisance
