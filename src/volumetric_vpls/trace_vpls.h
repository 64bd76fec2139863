// Particles of fire and emitters on their way through medium and surfaces: every collision in the medium becomes a
// point light (Keller, Instant Radiosity, SIGGRAPH 1997; in media Raab, Seibert, Keller, Unbiased Global Illumination
// with Participating Media, MCQMC 2006).
//
// Whose path is whose: light of a point scatters there, then at u on the camera's ray, or at a point of a surface. Its
// cell is therefore MM or SM whatever happened before. Light that comes to u straight from fire, emitters or surfaces
// (MV, MA, MS) is not in any point.
#pragma once

#include <vector>

#include "transport/particle_walk.h"
#include "volumetric_vpls/settings.h"
#include "volumetric_vpls/volumetric_vpl.h"

namespace brisance {

struct VolumetricVplReport : FlightReport {
    std::uint64_t collisions = 0, lights = 0;  // where light scatters, and those kept as lights
};

// `bounces`: the most scatterings of a path, the one where the point's light arrives among them; -1: all.
std::vector<VolumetricVpl> trace_vpls(const DirectLight& scene, const VolumetricVplSettings& settings, int bounces,
                                      VolumetricVplReport& report);

}  // namespace brisance
