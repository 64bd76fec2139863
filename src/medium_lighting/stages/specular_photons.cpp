#include "medium_lighting/stages/specular_photons.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/fixed_sums.h"
#include "core/parallel.h"
#include "medium/lattice/track_lengths.h"
#include "medium/phase.h"
#include "medium/sh.h"
#include "transport/particle_walk.h"
#include "transport/roulette.h"

namespace brisance {

namespace {

constexpr std::size_t kParticlesAtOnce = 1024;
// Of the light that arrives at surfaces, what may be left out.
constexpr double kUnsharedLeft = 0.01;
// Of the particles of light that is theirs alone, at least: a place of the smoke may be lit by them alone.
constexpr double kLeastParticles = 0.25;
// Of the power that arrived, what a track carries that has survived roulette.
constexpr float kPowerOfTrack = 1.0f / 1024.0f;
// Particles from infinity start toward a ball around the smoke whose radius is so many times the smoke's.
constexpr double kAround = 2.0;
// A set of them has at least so many, of fire and of emitters.
constexpr std::size_t kLeastOfSet = 1024;
// The first round is this part of all particles, or a least set.
constexpr std::size_t kFirstRound = 16;
// Of the numbers of streams: more than particles of a set.
constexpr int kBitsOfSet = 40;

// Points of the smoke, in proportion to what a cube of it takes of the light that crosses it.
CubeDirections points_of_smoke(const TrackingField& field) {
    constexpr int kCubes = CubeDirections::kCubes;
    constexpr double kVoxels = double(BrickLattice::kNodes) / kCubes;  // of a cube
    std::vector<std::int32_t> bricks(field.bricks().brick_count());
    std::iota(bricks.begin(), bricks.end(), 0);
    std::vector<double> weights(bricks.size() * kCubes);
    const double side = std::cbrt(cube_volume(field.medium()));
    parallel_for(bricks.size(), [&](std::size_t b) {
        double* const of_brick = &weights[b * kCubes];
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const ivec3 voxel = BrickLattice::node_in_brick(n);
            of_brick[CubeDirections::index_of(voxel / CubeDirections::kCube)] +=
                field.extinction(b, vec3(voxel) + 0.5f);
        }
        for (int cube = 0; cube < kCubes; ++cube)
            of_brick[cube] = -std::expm1(-of_brick[cube] / kVoxels * side);
    });
    return {field, std::move(bricks), weights};
}

// Around the smoke and what is near it.
BoundingBall ball_around_smoke(const TrackingField& field) {
    if (field.bricks().empty())
        return {};
    const Medium& medium = field.medium();
    dvec3 low(1e300), high(-1e300);
    for (std::size_t b = 0; b < field.bricks().brick_count(); ++b) {
        const dvec3 middle(medium.local_of_node(field.bricks().first_node(b) + BrickLattice::kSize / 2));
        low = glm::min(low, middle);
        high = glm::max(high, middle);
    }
    return {0.5 * (low + high), kAround * 0.5 * glm::length(high - low)};
}

// About how much of the light that surfaces send on is particles'.
double part_by_particles(const DirectLight& scene, const VirtualLights* lights, float share) {
    if (!lights || share > 0.0f || scene.surroundings()->scene().is_glossy())
        return 1.0;
    return lights->report().photons.unshared_fraction();
}

}  // namespace

// Deposits along tracks through the medium.
class SpecularPhotons::Tracks {
public:
    // `power`: of all particles of a round [W].
    Tracks(const Medium& medium, const LatticeRequest& request, double power)
        : medium_(medium),
          request_(request),
          track_lengths_(medium),
          kinds_(1 + (request.eye ? 1 : 0) + (request.moments ? kShMoments : 0)),
          sums_(kinds_ * medium.lattice.node_count(), power * medium.spacing) {}

    // Particles of the next round carry all power, and count by their number.
    void begin_round(std::size_t particles) {
        if (of_first_round_ == 0)
            of_first_round_ = particles;
        weight_ = double(particles) / double(of_first_round_);
        weights_ += weight_;
    }

    void add(const Ray& ray, double end, const Rgb& power) {
        const auto basis = sh_basis(vec3(ray.direction));
        track_lengths_.along(ray, end, [&](std::int64_t node, float length) {
            if ((*request_.needed)[node])
                add_to(node, power * (float(weight_) * length), vec3(ray.direction), basis);
        });
    }

    Gathered fluence() const {
        const std::size_t nodes = medium_.lattice.node_count();
        Gathered out;
        out.resize(nodes, request_.eye.has_value(), request_.moments);
        const auto read = [&](std::vector<float>& values, std::size_t first, std::size_t count) {
            for (std::size_t k = 0; k < count; ++k)
                for (std::size_t i = 0; i < nodes; ++i) {
                    const dvec3 sum = mean(i * kinds_ + first + k);
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

    std::vector<float> luminance_of_fluence() const {
        std::vector<float> out(medium_.lattice.node_count());
        parallel_for(
            out.size(), [&](std::size_t i) { out[i] = luminance(Rgb(mean(i * kinds_))); }, kParticlesAtOnce);
        return out;
    }

private:
    dvec3 mean(std::size_t sum) const { return sums_.read(sum) / (weights_ * double(medium_.voxel_volume)); }

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
    std::size_t kinds_;                    // of sums at each node: fluence, toward the camera, moments
    FixedSums sums_;                       // [W m]
    std::size_t of_first_round_ = 0;       // particles
    double weight_ = 1.0, weights_ = 0.0;  // of the round, and of all
};

SpecularPhotons::SpecularPhotons(const DirectLight& scene, const VirtualLights* lights,
                                 const VirtualLightSettings& settings, float share, double samples)
    : scene_(scene), lights_(lights), seed_(settings.seed), share_(share) {
    if (!scene.lights_surfaces())
        return;
    open_ = settings.photons == kAutomaticPhotons;
    // Of so many fewer, the noise is the same part of all light.
    if (const double part = part_by_particles(scene, lights, share); part > kUnsharedLeft)
        particles_ = open_ ? std::size_t(std::ceil(std::max(part, kLeastParticles) * most_automatic_photons(samples)))
                           : std::size_t(settings.photons);
    if (empty())
        return;
    ball_ = ball_around(scene);
    smoke_ = points_of_smoke(scene.field());
    around_smoke_ = ball_around_smoke(scene.field());
}

std::size_t SpecularPhotons::particles(float share) const {
    const std::size_t least = std::min(particles_, kLeastOfSet);
    return std::max(least, std::size_t(std::ceil(double(share) * double(particles_))));
}

// Roulette keeps the powers of tracks about equal, and far below those of particles, of which few send light to smoke.
void SpecularPhotons::send(const Ray& ray, const Rgb& sent, const Rgb& arrived, Rng& rng, Tracks& tracks) const {
    const float part = std::min(1.0f, largest(sent) / (kPowerOfTrack * largest(arrived)));
    if (!(rng.next() < part))
        return;
    const std::optional<SurfaceHit> hit = scene_.surroundings()->intersector().first_hit(ray);
    tracks.add(ray, hit ? hit->distance : kNoEnd, sent / part);
}

// Light that the surface at the end of a flight sends on and no virtual light holds: along a direction of its BSDF, and
// along one toward the smoke.
void SpecularPhotons::cast(const RaySegment& segment, const Rgb& power, Rng& rng, Tracks& tracks) const {
    const SurfacePoint& point = *segment.point;
    const bool held = lights_ && lights_->hold_base(*segment.hit, point) && !(share_ > 0.0f && rng.next() < share_);
    if (held && !needs_energy_tables(point.material))
        return;
    const PathVertex vertex(point, Bsdf(point.material, point.frame, held ? Lobes::Specular : Lobes::All),
                            segment.ray.direction);
    const bool aims = !smoke_.empty() && !vertex.only_delta();
    if (const std::optional<PathVertex::Sample> next = vertex.sample(rng, Transport::Importance)) {
        const Ray ray = vertex.leaving(next->wi);
        const double other = aims && !next->delta ? smoke_.pdf(ray) : 0.0;
        send(ray, power * next->weight * float(next->pdf / (next->pdf + other)), power, rng, tracks);
    }
    if (!aims)
        return;
    const Ray ray = vertex.leaving(smoke_.sample(vertex.position(), rng));
    const PathVertex::Value value = vertex.at(ray.direction, Transport::Importance);
    if (!(largest(value.value) > 0.0f))
        return;
    if (const double density = value.pdf + smoke_.pdf(ray); density > 0.0)
        send(ray, power * value.value / float(density), power, rng, tracks);
}

void SpecularPhotons::follow(std::uint64_t index, std::uint64_t stream, const Particles& particles,
                             Tracks& tracks) const {
    Rng rng(Stream::SpecularPhotons, stream, seed_), cast_rng(Stream::SpecularPhotonRoulette, stream, seed_);
    FlightReport report;
    const std::optional<EmittedParticle> particle = particles.emit(index, rng);
    if (counts(particle, report))
        walk_particle(scene_, *particle, stream, {}, rng, [&](const ParticleFlight& flight) {
            if (flight.landing())
                cast(flight.segment, flight.power, cast_rng, tracks);
            return true;
        });
}

void SpecularPhotons::trace(std::size_t count, std::uint64_t first_stream, Tracks& tracks) const {
    const Particles particles(scene_, ball_, count, around_smoke_);
    tracks.begin_round(count);
    parallel_blocks(count, kParticlesAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            follow(i, first_stream + i, particles, tracks);
    });
}

SpecularPhotons::Cast SpecularPhotons::on(const Medium& medium, const LatticeRequest& request, float share, int set,
                                          const Enough& enough) const {
    const std::size_t all = particles(share);
    const std::uint64_t first_stream = std::uint64_t(set) << kBitsOfSet;
    Tracks tracks(medium, request, emitted_power(scene_, ball_));
    std::size_t traced = 0;
    const auto trace_up_to = [&](std::size_t count) {
        trace(count - traced, first_stream + traced, tracks);
        traced = count;
    };
    if (enough && open_) {
        const std::size_t first = std::max(all / kFirstRound, std::min(all, kLeastOfSet));
        trace_up_to(first);
        for (Found found{tracks.luminance_of_fluence(), {}}; 2 * traced + first <= all;) {
            trace_up_to(2 * traced);
            found.by_half = std::exchange(found.by_all, tracks.luminance_of_fluence());
            if (enough(found))
                return {tracks.fluence(), traced};
        }
    }
    if (traced < all)
        trace_up_to(all);
    return {tracks.fluence(), traced};
}

}  // namespace brisance
