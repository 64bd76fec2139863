// Particles on a random walk through medium and surfaces: from the fire and the emitters, which carry power, or from
// the camera, which carry importance.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "transport/particles.h"
#include "transport/roulette.h"

namespace brisance {

// A particle's free flight, up to a collision or a surface.
struct ParticleFlight {
    const RaySegment& segment;           // up to the surface
    std::optional<Collision> collision;  // before the surface
    Rgb power;                           // of the particle at the start of the flight [W]
    std::uint64_t particle;              // its number
    int before;                          // scatterings before this flight
    bool from_medium;                    // the last of them was in the medium
    bool scattered;                      // any of them was by a lobe without a delta

    const Ray& ray() const { return segment.ray; }
    // The surface at the end of the flight; none after a collision, or where the particle leaves the scene.
    const SurfacePoint* landing() const { return !collision && segment.point ? &*segment.point : nullptr; }
    bool escapes() const { return !collision && !segment.point; }
};

struct WalkRules {
    // Importance: particles of light (bsdf.h); Radiance: particles from the camera.
    Transport transport = Transport::Importance;
    // Scatterings before the last flight; -1: no limit.
    int most_before = -1;
    // False: the particle's power is 1 throughout, and only the density of its flights carries information: each
    // scattering survives with the probability of its greatest weight.
    bool carries_colour = true;
};

// Calls visit(const ParticleFlight&) for the particle's flights in turn, until it returns false. Absorption ends the
// walk by Russian roulette, so that the power stays about the same (Jensen, Realistic Image Synthesis Using Photon
// Mapping, 2001, chapter 5).
template <class Visit>
void walk_particle(const DirectLight& scene, const EmittedParticle& particle, std::uint64_t number,
                   const WalkRules& rules, Rng& rng, const Visit& visit) {
    Ray ray = particle.ray;
    Rgb power = particle.power;
    bool from_medium = false, scattered = false;
    for (int before = 0; rules.most_before < 0 || before <= rules.most_before; ++before) {
        const RaySegment segment = scene.segment_along(ray);
        const std::optional<Collision> collision = null_collision_flight(scene.field(), ray, segment.end, rng);
        const ParticleFlight flight{segment, collision, power, number, before, from_medium, scattered};
        if (!visit(flight) || flight.escapes())
            return;
        const PathVertex vertex =
            collision ? scene.in_smoke(ray, *collision) : PathVertex(*segment.point, ray.direction);
        const std::optional<PathVertex::Sample> next = vertex.sample(rng, rules.transport);
        if (!next)
            return;
        const Rgb left =
            power * (collision ? scene.field().albedo(collision->brick, collision->position) : next->weight);
        const bool endless = before >= (collision ? kManyCollisions : kManyScatterings);
        const float survival = std::min(largest(left) / largest(power), endless ? kGoesOn : 1.0f);
        if (!(rng.next() < survival))  // also if it is not a number
            return;
        power = rules.carries_colour ? left / survival : particle.power;
        ray = vertex.leaving(next->wi);
        from_medium = collision.has_value();
        scattered = scattered || !next->delta;
    }
}

struct FlightReport {
    std::uint64_t paths = 0, flights = 0;  // particles, and their flights
    std::uint64_t not_finite = 0;          // particles that were left out
    double emitted = 0.0;                  // by the particles that were drawn, luminance [W]
    void add(const FlightReport& r);
};

// Whether the particle carries any light; counts it.
bool counts(const std::optional<EmittedParticle>& particle, FlightReport& report);

// How many particles are followed, and by which random numbers.
struct ParticleSource {
    Stream stream;
    int paths;
    std::uint32_t seed;
};

// The objects that leave(flight, lights) appends for all flights, in the order of the particles, whatever the number of
// threads. `most_before` as in WalkRules.
template <class Light, class Leave>
std::vector<Light> lights_of_flights(const DirectLight& scene, const ParticleSource& source, int most_before,
                                     const Leave& leave, FlightReport& report) {
    constexpr std::size_t kBlock = 256;
    const auto total = static_cast<std::size_t>(source.paths);
    const Particles particles(scene, ball_around(scene), total);
    struct Part {
        std::vector<Light> lights;
        FlightReport report;
    };
    std::vector<Part> parts((total + kBlock - 1) / kBlock);
    parallel_blocks(total, kBlock, [&](std::size_t begin, std::size_t end) {
        Part& part = parts[begin / kBlock];
        for (std::size_t i = begin; i < end; ++i) {
            Rng rng(source.stream, i, source.seed);
            const std::optional<EmittedParticle> particle = particles.emit(i, rng);
            if (!counts(particle, part.report))
                continue;
            walk_particle(scene, *particle, i, {.most_before = most_before}, rng, [&](const ParticleFlight& flight) {
                ++part.report.flights;
                leave(flight, part.lights);
                return true;
            });
        }
    });
    std::vector<Light> lights;
    for (const Part& part : parts) {
        lights.insert(lights.end(), part.lights.begin(), part.lights.end());
        report.add(part.report);
    }
    return lights;
}

}  // namespace brisance
