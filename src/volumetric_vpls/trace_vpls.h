// Traces particles of fire and emitters through medium and surfaces. Every collision in the medium becomes a point
// light (Keller, Instant Radiosity, SIGGRAPH 1997; in media Raab, Seibert, Keller, Unbiased Global Illumination with
// Participating Media, MCQMC 2006).
//
// Ledger cells: light of a point light scatters there, then at u on the camera ray or at a point of a surface. Its cell
// is therefore MM or SM, whatever happened before. Light that reaches u directly from fire, emitters or surfaces (MV,
// MA, MS) is not in any point light.
#pragma once

#include <vector>

#include "transport/particle_walk.h"
#include "volumetric_vpls/settings.h"
#include "volumetric_vpls/volumetric_vpl.h"

namespace brisance {

struct VolumetricVplReport : FlightReport {
    std::uint64_t collisions = 0, lights = 0;  // collisions, and those kept as lights
};

// `bounces`: the most scatterings of a path, including the one where the light arrives; -1: no limit.
std::vector<VolumetricVpl> trace_vpls(const DirectLight& scene, const VolumetricVplSettings& settings, int bounces,
                                      VolumetricVplReport& report);

}  // namespace brisance
