// Particles of fire and emitters on their way through medium and surfaces: every flight through the medium becomes a
// ray light.
//
// Whose path is whose: light of a ray scatters at v on it, then at u on the camera's ray, or at a point of a surface.
// Its cell is therefore MM or SM whatever happened before v; the first flight of a particle brings paths of two
// scatterings. Light that comes to u straight from fire, emitters or surfaces (MV, MA, MS) is not in any ray light.
#pragma once

#include <cstdint>
#include <vector>

#include "ray_lights/ray_light.h"
#include "ray_lights/settings.h"
#include "transport/particle_walk.h"

namespace brisance {

struct RayLightReport : FlightReport {
    std::uint64_t pieces = 0, lights = 0;  // ray lights that flights were cut into, and those kept
};

// `bounces`: the most scatterings of a path, the one where the ray's light arrives among them; -1: all.
std::vector<RayLight> trace_ray_lights(const DirectLight& scene, const RayLightSettings& settings, int bounces,
                                       RayLightReport& report);

}  // namespace brisance
