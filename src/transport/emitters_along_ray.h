// The ledger's cell MA along a ray of the camera: light of lamps, emissive surfaces and environments that scatters once
// on it.
//
// Points on the ray gather direct light as a path's vertices do (direct_light.h): next-event estimation, and rays that
// sample the phase function, by the balance heuristic. The points are stratified ends of free flights; with a few lamps
// without extent, half of them are sampled by 1 / distance^2 to one of these within its cone and by the phase function
// (light_selection/joint_sampling.h), and the balance heuristic weights both densities. Unbiased, and sharp where a
// beam is narrower than a voxel. The medium's nodes, which hold MA otherwise, have little noise, but blur over their
// spacing. Where their light is known, it guides the points: it finds what neither of the other two does, smoke close
// to an emissive surface, beams through windows and gaps in smoke. It changes the noise, and never the mean.
#pragma once

#include "core/step_density.h"
#include "tracking/ray_medium.h"
#include "transport/direct_light.h"

namespace brisance {

// Whether there are lamps by which points are sampled.
bool aims_at_lamps(const DirectLight& scene);

// Of a vertex in smoke, what comes from emitters on a ray that samples the phase function: the other of two techniques
// than points on emitters (DirectLight::from_sample()), weighted against that [W/(m^2 sr)]. There must be surroundings.
Rgb emitters_by_phase(const DirectLight& scene, const PathVertex& vertex, Rng& rng);

// [W/(m^2 sr)]. The scene must have emitters; `seen`: the medium on `ray`; `guide`: about where on the ray their light
// scatters, by the distance from its origin [m], or null.
Rgb emitters_along_ray(const DirectLight& scene, const RayMedium& seen, const Ray& ray, int points, Rng& rng,
                       const StepDensity* guide = nullptr);

}  // namespace brisance
