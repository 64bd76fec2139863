#include "render/cast_light.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"
#include "gathering/sh.h"
#include "medium/cell_walk.h"
#include "medium/phase.h"
#include "render/march.h"
#include "tracing/particle_flights.h"

namespace brisance {

namespace {

constexpr std::size_t kParticlesAtOnce = 1024;
// Parts of a way through a cell, each of which counts for the node nearest to it.
constexpr int kParts = 2;
// Sums hold 2^16 times the power emitted along a voxel, in steps of 2^-46 of it.
constexpr double kSteps = 0x1p46;
// Of the light that arrives where virtual lights were made.
constexpr double kUnsharedLeft = 0.01;

bool is_glossy(const Scene& scene) {
    return std::ranges::any_of(scene.materials, [](const SceneMaterial& m) { return needs_energy_tables(m.surface); });
}

}  // namespace

// Light laid down along ways through the medium.
class CastLight::Ways {
public:
    Ways(const Medium& medium, const LatticeRequest& request, double power)
        : medium_(medium),
          request_(request),
          cells_(cell_lattice(medium)),
          index_from_local_(glm::inverse(dmat3(medium.local_from_index))),
          unit_(std::max(power * medium.spacing, 1e-300) / kSteps),
          channels_(3 * (1 + (request.toward_camera ? 1 : 0) + (request.moments ? kShMoments : 0))),
          sums_(channels_ * medium.lattice.node_count()) {}

    void add(const Ray& ray, double end, const Rgb& power) {
        float depth = 0.0f;
        const auto basis = sh_basis(vec3(ray.direction));
        const auto in_cell = [&](const CellSegment& s) {
            const double length = (s.end - s.begin) / kParts;
            for (int part = 0; part < kParts; ++part) {
                const dvec3 place = s.origin + s.direction * (s.begin + (part + 0.5) * length);
                const std::int64_t node =
                    medium_.lattice.find_node(cells_.first_node(s.brick) + ivec3(glm::round(place)));
                if (node < 0)
                    continue;
                const float tau = medium_.extinction[node] * float(length);
                if ((*request_.needed)[node])
                    add_to(node, power * (std::exp(-depth) * float(length) * phi1(tau)), vec3(ray.direction), basis);
                depth += tau;
            }
            return depth < kOpaqueDepth;
        };
        walk_bricks(cells_, lattice_ray(cells_, index_from_local_, medium_.reference_node, ray, end),
                    [&](const CellSegment& brick) { return walk_cubes<1>(brick, in_cell); });
    }

    Gathered fluence() const {
        const std::size_t nodes = medium_.lattice.node_count();
        Gathered out;
        out.resize(nodes, request_.toward_camera != nullptr, request_.moments);
        const double scale = unit_ / medium_.voxel_volume;
        const auto read = [&](std::vector<float>& values, std::size_t first, std::size_t count) {
            for (std::size_t c = 0; c < count; ++c)
                for (std::size_t i = 0; i < nodes; ++i)
                    values[c * nodes + i] = float(double(sums_[i * channels_ + first + c]) * scale);
        };
        read(out.fluence, 0, 3);
        if (request_.toward_camera)
            read(out.scattered, 3, 3);
        if (request_.moments)
            read(out.moments, channels_ - 3 * kShMoments, 3 * kShMoments);
        return out;
    }

private:
    void add_to(std::int64_t node, const Rgb& track, const vec3& direction,
                const std::array<float, kShMoments>& basis) {
        std::int64_t* sum = sums_.data() + node * std::int64_t(channels_);
        const auto put = [&](float factor) {
            for (int c = 0; c < 3; ++c, ++sum)
                std::atomic_ref<std::int64_t>(*sum).fetch_add(std::llround(double(track[c]) * factor / unit_),
                                                              std::memory_order_relaxed);
        };
        put(1.0f);
        if (request_.toward_camera)
            put(henyey_greenstein(glm::dot(direction, (*request_.toward_camera)[node]), request_.mean_cosine));
        for (int m = 0; request_.moments && m < kShMoments; ++m)
            put(basis[m]);
    }

    const Medium& medium_;
    const LatticeRequest& request_;
    BrickLattice cells_;
    dmat3 index_from_local_;
    double unit_;  // [W m]
    std::size_t channels_;
    std::vector<std::int64_t> sums_;  // per node
};

CastLight::CastLight(const DirectLight& scene, const VirtualLights* lights, const VirtualLightSettings& settings)
    : scene_(scene), lights_(lights), seed_(settings.seed) {
    const Surroundings* const set = scene.surroundings();
    if (!set || !set->has_surfaces() || !(scene.has_emitters() || !scene.fire().empty()))
        return;
    if (!lights || is_glossy(set->scene()) || lights->report().photons.unshared_fraction() > kUnsharedLeft)
        particles_ = static_cast<std::size_t>(settings.photons);
}

// What the surface at the end of a particle's flight sends on and no light holds. Roulette: powers stay about equal.
void CastLight::cast(const RaySegment& segment, const Rgb& power, Rng& rng, Ways& ways) const {
    const SurfacePoint& point = *segment.point;
    const bool held = lights_ && lights_->hold_base(*segment.hit, point);
    if (held && !needs_energy_tables(point.material))
        return;
    const Scatterer place(point, Bsdf(point.material, point.frame, held ? Lobes::Specular : Lobes::All),
                          segment.ray.direction);
    const std::optional<Scatterer::Sample> next = place.sample_particle(rng);
    if (!next)
        return;
    const Rgb sent = power * next->weight;
    const float part = std::min(1.0f, std::max({sent.x, sent.y, sent.z}) / std::max({power.x, power.y, power.z}));
    if (!(rng.next() < part))
        return;
    const Ray ray = place.leaving(next->wi);
    ways.add(ray, scene_.segment_along(ray).end, sent / part);
}

void CastLight::follow(std::uint64_t index, const Particles& particles, Ways& ways) const {
    Rng rng(Stream::CastLight, index, seed_), cast_rng(Stream::CastLightRoulette, index, seed_);
    FlightReport report;
    const std::optional<EmittedParticle> particle = particles.emit(index, rng);
    if (counts(particle, report))
        follow_particle(scene_, *particle, -1, rng, [&](const ParticleFlight& flight) {
            if (!flight.collision && flight.segment->point)
                cast(*flight.segment, flight.power, cast_rng, ways);
        });
}

Gathered CastLight::on(const Medium& medium, const LatticeRequest& request) const {
    const BoundingBall ball = ball_around(scene_);
    const Particles particles(scene_, ball, particles_);
    Ways ways(medium, request, emitted_power(scene_, ball));
    parallel_blocks(particles_, kParticlesAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            follow(i, particles, ways);
    });
    return ways.fluence();
}

}  // namespace brisance
