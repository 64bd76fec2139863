// MA along a ray of the camera: light of lamps, shining surfaces and environments that scatters once on it.
//
// Next-event estimation from places of the ray, shared with rays by the phase function as in the path tracer (balance
// heuristic). Places are where flights along the ray would collide, a stratum of opacity each; where there are a few
// lamps without extent, half of them are drawn by 1 / distance^2 to one of these instead, within its cone, with the
// phase function (joint_sampling.h), and both densities share what they find. Unbiased, and sharp where a beam is
// narrower than a voxel; the medium's nodes, which hold MA otherwise, are free of noise and as blunt as they are apart.
#pragma once

#include "tracking/ray_medium.h"
#include "transport/direct_light.h"

namespace brisance {

// Whether there are lamps that places are drawn toward.
bool aims_at_lamps(const DirectLight& scene);

// [W/(m^2 sr)]. The scene must have emitters; `seen`: the medium on `ray`.
Rgb emitters_along_ray(const DirectLight& scene, const RayMedium& seen, const Ray& ray, int places, Rng& rng);

}  // namespace brisance
