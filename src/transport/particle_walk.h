// Particles of fire and emitters on their way through medium and surfaces, and the lights that their flights leave.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "transport/particles.h"

namespace brisance {

struct ParticleFlight {
    Ray ray;
    double end;                          // where a surface is [m]
    std::optional<Collision> collision;  // before it
    Rgb power;                           // that sets out [W]
    std::uint64_t particle;              // its number
    int before;                          // scatterings before this flight
    bool from_smoke;                     // the last of them was in the medium
    const RaySegment* segment;           // to that surface
};

struct FlightReport {
    std::uint64_t paths = 0, flights = 0;  // particles, and their flights
    std::uint64_t not_finite = 0;          // particles that were left out
    double emitted = 0.0;                  // by the particles that were drawn, luminance [W]
    void add(const FlightReport& r);
};

// The flights of one particle, of that number, up to the one with `most_before` scatterings before it; -1: all. What is
// absorbed ends the path by roulette: powers stay about equal.
void follow_particle(const DirectLight& scene, const EmittedParticle& particle, std::uint64_t number, int most_before,
                     Rng& rng, const std::function<void(const ParticleFlight&)>& visit);

// Whether the particle carries any light; counts it.
bool counts(const std::optional<EmittedParticle>& particle, FlightReport& report);

// How many particles are followed, and by which random numbers.
struct ParticleSource {
    Stream stream;
    int paths;
    std::uint32_t seed;
};

// What leave(flight, left) leaves of all flights: lights, or whatever else, in the order of the particles whatever the
// number of threads.
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
            follow_particle(scene, *particle, i, most_before, rng, [&](const ParticleFlight& flight) {
                ++part.report.flights;
                leave(flight, part.lights);
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
