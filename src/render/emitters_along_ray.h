// MA along a ray of the camera: light of lamps, shining surfaces and environments that scatters once on it.
//
// Next-event estimation from places where flights along the ray would collide, a stratum of opacity each, shared with
// rays by the phase function as in the path tracer (balance heuristic). Unbiased, and sharp where a beam is narrower
// than a voxel; the medium's nodes, which hold MA otherwise, are free of noise and as blunt as they are apart. A lamp
// inside the smoke is noisy where it is near the ray.
#pragma once

#include "ray_lights/seen_medium.h"
#include "tracing/direct_light.h"

namespace brisance {

// [W/(m^2 sr)]. The scene must have emitters; `seen`: the medium on `ray`.
Rgb emitters_along_ray(const DirectLight& scene, const SeenMedium& seen, const Ray& ray, int places, Rng& rng);

}  // namespace brisance
