// Particles of fire and emitters on their way through medium and surfaces: every flight through the medium becomes a
// ray light.
//
// Whose path is whose: light of a ray scatters at v on it, then at u on the camera's ray, or at a point of a surface.
// Its cell is therefore MM or SM whatever happened before v; the first flight of a particle brings paths of two
// scatterings. Light that comes to u straight from fire, emitters or surfaces (MV, MA, MS) is not in any ray light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ray_lights/ray_light.h"
#include "ray_lights/settings.h"
#include "tracing/particles.h"

namespace brisance {

struct RayLightReport {
    std::uint64_t paths = 0, flights = 0;  // particles, and their flights
    std::uint64_t pieces = 0, lights = 0;  // ray lights they were cut into, and those kept
    std::uint64_t not_finite = 0;          // left out
    double emitted = 0.0;                  // by the particles that were drawn, luminance [W]
};

// `bounces`: the most scatterings of a path, the one where the ray's light arrives among them; -1: all.
std::vector<RayLight> trace_ray_lights(const DirectLight& scene, const RayLightSettings& settings, int bounces,
                                       RayLightReport& report);

// Keeps about `count` of the lights, by Russian roulette with the probability that their share of what arrives at the
// receivers asks for; those that stay carry the light of those that go (Georgiev and Slusallek, Simple and Robust
// Iterative Importance Sampling of Virtual Point Lights, Eurographics 2010). A tenth of the probability is by power
// alone, for what no receiver stands for. Nothing to do where there are no more than `count`.
std::vector<RayLight> keep_important(std::vector<RayLight> lights, std::span<const RayLightReceiver> receivers,
                                     std::size_t count, double mean_cosine, std::uint32_t seed);

}  // namespace brisance
