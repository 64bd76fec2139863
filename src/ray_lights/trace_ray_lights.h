// Traces particles of fire and emitters through medium and surfaces. Every flight through the medium becomes a ray
// light.
//
// Ledger cells: light of a ray light scatters at v on it, then at u on the camera ray or at a point of a surface. Its
// cell is therefore MM or SM, whatever happened before v; the first flight of a particle yields paths of two
// scatterings. Light that reaches u directly from fire, emitters or surfaces (MV, MA, MS) is not in any ray light.
#pragma once

#include <cstdint>
#include <vector>

#include "ray_lights/ray_light.h"
#include "ray_lights/settings.h"
#include "transport/particle_walk.h"

namespace brisance {

struct RayLightReport : FlightReport {
    std::uint64_t pieces = 0, lights = 0;  // pieces that flights were cut into, and those kept
};

// `bounces`: the most scatterings of a path, including the one where the light arrives; -1: no limit.
std::vector<RayLight> trace_ray_lights(const DirectLight& scene, const RayLightSettings& settings, int bounces,
                                       RayLightReport& report);

}  // namespace brisance
