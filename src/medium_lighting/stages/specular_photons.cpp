#include "medium_lighting/stages/specular_photons.h"

#include <algorithm>
#include <cmath>

#include "core/fixed_sums.h"
#include "core/parallel.h"
#include "gathering/sh.h"
#include "medium/lattice/track_lengths.h"
#include "medium/phase.h"
#include "transport/particle_walk.h"
#include "transport/roulette.h"

namespace brisance {

namespace {

constexpr std::size_t kParticlesAtOnce = 1024;
// Of the light that arrives where virtual lights were made.
constexpr double kUnsharedLeft = 0.01;

}  // namespace

// Deposits along tracks through the medium.
class SpecularPhotons::Tracks {
public:
    Tracks(const Medium& medium, const LatticeRequest& request, double power)
        : medium_(medium),
          request_(request),
          track_lengths_(medium),
          kinds_(1 + (request.eye ? 1 : 0) + (request.moments ? kShMoments : 0)),
          sums_(kinds_ * medium.lattice.node_count(), power * medium.spacing) {}

    void add(const Ray& ray, double end, const Rgb& power) {
        const auto basis = sh_basis(vec3(ray.direction));
        track_lengths_.along(ray, end, [&](std::int64_t node, float length) {
            if ((*request_.needed)[node])
                add_to(node, power * length, vec3(ray.direction), basis);
        });
    }

    Gathered fluence() const {
        const std::size_t nodes = medium_.lattice.node_count();
        Gathered out;
        out.resize(nodes, request_.eye.has_value(), request_.moments);
        const auto read = [&](std::vector<float>& values, std::size_t first, std::size_t count) {
            for (std::size_t k = 0; k < count; ++k)
                for (std::size_t i = 0; i < nodes; ++i) {
                    const dvec3 sum = sums_.read(i * kinds_ + first + k) / double(medium_.voxel_volume);
                    for (int c = 0; c < 3; ++c)
                        values[(3 * k + c) * nodes + i] = float(sum[c]);
                }
        };
        read(out.fluence, 0, 1);
        if (request_.eye)
            read(out.scattered, 1, 1);
        if (request_.moments)
            read(out.moments, kinds_ - kShMoments, kShMoments);
        return out;
    }

private:
    void add_to(std::int64_t node, const Rgb& track, const vec3& direction,
                const std::array<float, kShMoments>& basis) {
        std::size_t sum = std::size_t(node) * kinds_;
        const auto put = [&](float factor) { sums_.add(sum++, dvec3(track) * double(factor)); };
        put(1.0f);
        if (request_.eye) {
            const vec3 p = medium_.local_of_node(medium_.lattice.node(std::size_t(node)));
            put(henyey_greenstein(glm::dot(direction, direction_toward(*request_.eye, p)), request_.mean_cosine));
        }
        for (int m = 0; request_.moments && m < kShMoments; ++m)
            put(basis[m]);
    }

    const Medium& medium_;
    const LatticeRequest& request_;
    TrackLengths track_lengths_;
    std::size_t kinds_;  // of sums at each node: fluence, toward the camera, moments
    FixedSums sums_;     // [W m]
};

SpecularPhotons::SpecularPhotons(const DirectLight& scene, const VirtualLights* lights,
                                 const VirtualLightSettings& settings, float share)
    : scene_(scene), lights_(lights), seed_(settings.seed), share_(share) {
    if (!scene.lights_surfaces())
        return;
    if (!lights || share > 0.0f || scene.surroundings()->scene().is_glossy() ||
        lights->report().photons.unshared_fraction() > kUnsharedLeft)
        particles_ =
            static_cast<std::size_t>(settings.photons == kAutomaticPhotons ? kMostAutomaticPhotons : settings.photons);
}

// Light that the surface at the end of a flight sends on and no virtual light holds. Roulette keeps the powers about
// equal.
void SpecularPhotons::cast(const RaySegment& segment, const Rgb& power, Rng& rng, Tracks& tracks) const {
    const SurfacePoint& point = *segment.point;
    const bool held = lights_ && lights_->hold_base(*segment.hit, point) && !(share_ > 0.0f && rng.next() < share_);
    if (held && !needs_energy_tables(point.material))
        return;
    const PathVertex vertex(point, Bsdf(point.material, point.frame, held ? Lobes::Specular : Lobes::All),
                            segment.ray.direction);
    const std::optional<PathVertex::Sample> next = vertex.sample(rng, Transport::Importance);
    if (!next)
        return;
    const Rgb sent = power * next->weight;
    const float part = std::min(1.0f, largest(sent) / largest(power));
    if (!(rng.next() < part))
        return;
    const Ray ray = vertex.leaving(next->wi);
    const std::optional<SurfaceHit> hit = scene_.surroundings()->intersector().first_hit(ray);
    tracks.add(ray, hit ? hit->distance : kNoEnd, sent / part);
}

void SpecularPhotons::follow(std::uint64_t index, const Particles& particles, Tracks& tracks) const {
    Rng rng(Stream::SpecularPhotons, index, seed_), cast_rng(Stream::SpecularPhotonRoulette, index, seed_);
    FlightReport report;
    const std::optional<EmittedParticle> particle = particles.emit(index, rng);
    if (counts(particle, report))
        walk_particle(scene_, *particle, index, {}, rng, [&](const ParticleFlight& flight) {
            if (flight.landing())
                cast(flight.segment, flight.power, cast_rng, tracks);
            return true;
        });
}

Gathered SpecularPhotons::on(const Medium& medium, const LatticeRequest& request) const {
    const BoundingBall ball = ball_around(scene_);
    const Particles particles(scene_, ball, particles_);
    Tracks tracks(medium, request, emitted_power(scene_, ball));
    parallel_blocks(particles_, kParticlesAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            follow(i, particles, tracks);
    });
    return tracks.fluence();
}

}  // namespace brisance
