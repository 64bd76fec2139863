// Particles that start where they are wanted bring the same power as others, with less noise.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fixtures/sets.h"
#include "fixtures/tracing_fixture.h"
#include "transport/particle_walk.h"

namespace brisance {
namespace {

using namespace testing;

struct Total {
    double sum = 0.0, squares = 0.0;
    void add(double power) {
        sum += power;
        squares += power * power;
    }
    double variance() const { return squares; }  // of the sum, to the share of those that bring anything
};

constexpr int kParticles = 40000;

// Power by which particles count, each by what(particle).
template <class What>
Total total_of(const DirectLight& scene, const BoundingBall& aim, const What& what) {
    const Particles particles(scene, ball_around(scene), kParticles, aim);
    Total total;
    for (std::uint64_t i = 0; i < kParticles; ++i) {
        Rng rng(Stream::Points, i);
        if (const std::optional<EmittedParticle> particle = particles.emit(i, rng))
            total.add(what(*particle, i, rng));
    }
    return total;
}

void expect_same(const Total& a, const Total& b) {
    EXPECT_NEAR(a.sum, b.sum, 4.0 * std::sqrt(a.variance() + b.variance()));
}

// An even sky of radiance 1 and a lamp over a wide floor; all light on a small part of it is known.
TEST(ParticleAims, OfSkyAndLampsBringTheSamePower) {
    const Medium medium = make_medium(scattering_ball(8, 0.1f, Rgb(0.6f)));
    Scene set;
    set.origin = medium.world_of_local(vec3(0.0f));
    constexpr double kFloor = -3.0, kHalf = 40.0, kPart = 2.0;
    add_quad(set, {-kHalf, -kHalf, kFloor}, {2 * kHalf, 0, 0}, {0, 2 * kHalf, 0}, lambert(0.5f));
    LightSettings sky, lamp;
    sky.kind = LightKind::Environment;
    lamp.power = Rgb(2000.0f);
    lamp.position = medium.world_of_local(vec3(0.0f, 0.0f, 10.0f));
    const Surroundings surroundings(std::move(set), {sky, lamp});
    const DirectLight scene(medium, {}, &surroundings);
    const auto landing = [&](bool far) {
        return [&, far](const EmittedParticle& particle, std::uint64_t, Rng&) {
            const RaySegment segment = scene.segment_along(particle.ray);
            if (particle.far != far || !segment.point || particle.ray.direction.z > 0.0)
                return 0.0;
            const dvec3 p = segment.point->position;
            return std::max(std::abs(p.x), std::abs(p.y)) < kPart ? double(luminance(particle.power)) : 0.0;
        };
    };
    const BoundingBall aim{{0.0, 0.0, kFloor}, 6.0};
    const Total plain = total_of(scene, {}, landing(true)), aimed = total_of(scene, aim, landing(true));
    const double sent = std::numbers::pi * 4.0 * kPart * kPart;
    EXPECT_NEAR(plain.sum, sent, 4.0 * std::sqrt(plain.variance()));
    EXPECT_NEAR(aimed.sum, sent, 4.0 * std::sqrt(aimed.variance()));
    EXPECT_LT(aimed.variance(), 0.1 * plain.variance());
    expect_same(total_of(scene, {}, landing(false)), total_of(scene, aim, landing(false)));
    // Of particles that miss the ball none is lost, nor counted twice.
    const auto elsewhere = [&](const EmittedParticle& particle, std::uint64_t, Rng&) {
        const RaySegment segment = scene.segment_along(particle.ray);
        const bool there = segment.point && particle.ray.direction.z < 0.0 && segment.point->position.x > 20.0;
        return there && particle.far ? double(luminance(particle.power)) : 0.0;
    };
    const Total far_off = total_of(scene, aim, elsewhere);
    EXPECT_NEAR(far_off.sum, std::numbers::pi * (kHalf - 20.0) * 2.0 * kHalf, 4.0 * std::sqrt(far_off.variance()));
}

}  // namespace
}  // namespace brisance
