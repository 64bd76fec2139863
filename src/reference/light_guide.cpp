#include "reference/light_guide.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/fixed_sums.h"
#include "core/parallel.h"
#include "transport/particle_walk.h"

namespace brisance {

namespace {

constexpr Stream kGuideStream = stream_of("light guide");
constexpr std::size_t kParticles = 1 << 15;
constexpr std::size_t kParticleBlock = 256;
// The part of a cube's glow that is its own; its brick's eight cubes share the rest, so that none of them is left out
// for want of particles.
constexpr double kOwn = 0.75;
// A place's share is an even one until so many particles have arrived there.
constexpr double kPrior = 4.0;
constexpr float kLeastShare = 0.1f, kMostShare = 0.8f;

// The cube in which a ray starts, brick after brick; -1 outside of the smoke.
std::ptrdiff_t cube_at_start(const TrackingField& field, const Ray& ray) {
    std::ptrdiff_t found = -1;
    walk_bricks(field.bricks(), field.enter(ray), [&](const VoxelSegment& brick) {
        return walk_cubes<CubeDirections::kCube>(brick, [&](const VoxelSegment& s) {
            found = static_cast<std::ptrdiff_t>(s.brick * CubeDirections::kCubes + CubeDirections::index_of(s.cube));
            return false;
        });
    });
    return found;
}

// How much of a Lambert surface's density a BSDF has far from its mirror direction, in [0, 1]: what is left is lobes so
// sharp that the BSDF itself finds what they reflect. Independent of the direction that is drawn.
float wide_part(const PathVertex& vertex) {
    const dvec3 &arriving = vertex.arriving(), &n = vertex.lit().normal;
    const double cosine = glm::dot(n, arriving);
    const dvec3 along = arriving - cosine * n, up = cosine < 0.0 ? n : -n;
    const dvec3 back =
        glm::length(along) > 1e-3 ? -glm::normalize(along) : frame_around(n).world_from_local({1.0, 0.0, 0.0});
    const dvec3 aside = std::numbers::sqrt2 / 2.0 * (up + back);
    return static_cast<float>(std::min(1.0, std::numbers::pi * std::numbers::sqrt2 * vertex.at(aside).pdf));
}

}  // namespace

class LightGuide::Learner {
public:
    // `power`: of all particles, luminance [W].
    Learner(const LightGuide& guide, const DirectLight& scene, double power)
        : guide_(guide),
          field_(scene.field()),
          power_(power),
          cubes_(field_.bricks().brick_count() * CubeDirections::kCubes),
          glow_(cubes_, power),
          arriving_(guide.shares_.size(), power) {}

    // `fire`: of the particle's origin.
    void learn(const ParticleFlight& flight, bool fire) {
        const double power = std::min<double>(luminance(flight.power), power_);
        const bool by_smoke = flight.before == 0 ? fire : flight.from_medium;
        if (flight.collision || !(power > 0.0))
            return;
        if (by_smoke)
            if (const std::ptrdiff_t cube = cube_at_start(field_, flight.ray()); cube >= 0)
                glow_.add(static_cast<std::size_t>(cube), dvec3(power, 0.0, 0.0));
        if (const SurfacePoint* landing = flight.landing(); landing && (by_smoke || flight.before > 0))
            arriving_.add(guide_.place_of(landing->position), dvec3(by_smoke ? power : 0.0, power, 0.0));
    }

    CubeDirections glow() const {
        constexpr int kCubes = CubeDirections::kCubes;
        std::vector<std::int32_t> bricks;
        std::vector<double> weights;
        for (std::size_t b = 0; b < cubes_ / kCubes; ++b) {
            double brick = 0.0;
            for (int c = 0; c < kCubes; ++c)
                brick += glow_.read(b * kCubes + c).x;
            if (!(brick > 0.0))
                continue;
            bricks.push_back(static_cast<std::int32_t>(b));
            for (int c = 0; c < kCubes; ++c)
                weights.push_back(kOwn * glow_.read(b * kCubes + c).x + (1.0 - kOwn) * brick / kCubes);
        }
        return {field_, std::move(bricks), weights};
    }

    float share(std::size_t place) const {
        const double prior = kPrior * power_ / kParticles;
        const dvec3 sum = arriving_.read(place);
        return std::clamp(static_cast<float>((sum.x + 0.5 * prior) / (sum.y + prior)), kLeastShare, kMostShare);
    }

private:
    const LightGuide& guide_;
    const TrackingField& field_;
    double power_;
    std::size_t cubes_;
    FixedSums glow_;      // [W], the first component
    FixedSums arriving_;  // [W] from smoke, and from smoke and surfaces
};

LightGuide::LightGuide(const DirectLight& scene) : shares_(kPlaces * kPlaces * kPlaces) {
    const BoundingBall ball = ball_around(scene);
    const double power = emitted_power(scene, ball);
    if (!(power > 0.0) || !std::isfinite(power) || !(ball.radius > 0.0))
        return;
    low_ = ball.centre - ball.radius;
    size_ = 2.0 * ball.radius / kPlaces;
    const Particles particles(scene, ball, kParticles);
    Learner learner(*this, scene, power);
    parallel_blocks(kParticles, kParticleBlock, [&](std::size_t begin, std::size_t end) {
        FlightReport ignored;
        for (std::size_t i = begin; i < end; ++i) {
            Rng rng(kGuideStream, i);
            const std::optional<EmittedParticle> particle = particles.emit(i, rng);
            if (counts(particle, ignored))
                walk_particle(scene, *particle, i, {}, rng, [&](const ParticleFlight& flight) {
                    learner.learn(flight, particles.from_fire(i));
                    return true;
                });
        }
    });
    glow_ = learner.glow();
    for (std::size_t place = 0; place < shares_.size(); ++place)
        shares_[place] = learner.share(place);
}

std::size_t LightGuide::place_of(const dvec3& position) const {
    const ivec3 p = glm::clamp(ivec3((position - low_) / size_), ivec3(0), ivec3(kPlaces - 1));
    return (std::size_t(p.x) * kPlaces + p.y) * kPlaces + p.z;
}

std::optional<PathVertex::Sample> LightGuide::sample(const PathVertex& vertex, Rng& rng) const {
    const float c = share(vertex.position()) * wide_part(vertex);
    PathVertex::Sample sample;
    if (rng.next() < c) {
        sample.wi = glow_.sample(vertex.position(), rng);
    } else {
        const std::optional<PathVertex::Sample> own = vertex.sample(rng);
        if (!own)
            return own;
        sample = *own;
        if (sample.delta) {
            sample.weight /= 1.0f - c;
            return sample;
        }
    }
    const PathVertex::Value scattered = vertex.at(sample.wi);
    if (scattered.value == Rgb(0.0f))
        return std::nullopt;
    const double pdf = c * glow_.pdf(vertex.leaving(sample.wi)) + (1.0 - c) * scattered.pdf;
    sample.weight = scattered.value / static_cast<float>(pdf);
    sample.pdf = scattered.pdf;
    return sample;
}

}  // namespace brisance
