// Random walks of particles: what ends them.
#include <gtest/gtest.h>

#include "fixtures/tracing_fixture.h"
#include "transport/particle_walk.h"

namespace brisance {
namespace {

using namespace testing;

// Smoke that absorbs nothing lets every particle out, with the power it came with: none is ended for having scattered
// often, and none is brighter for those that were. From a radius of 10 mean free paths one in 10^7 takes more
// collisions than kManyCollisions, and one in 15 more than kManyScatterings and 14, which few survive between surfaces.
TEST(ParticleWalk, LeavesThickSmokeThatAbsorbsNothingWithItsPower) {
    Recipe recipe = scattering_ball(8, 10.0f, Rgb(1.0f));
    recipe.settings.fire.convention = EmissionConvention::Direct;
    const Medium medium = make_medium(recipe);
    const DirectLight scene(medium, {}, nullptr);
    constexpr int kParticles = 2000;
    const Particles particles(scene, ball_around(scene), kParticles);
    int out = 0, most = 0;
    for (std::uint64_t i = 0; i < kParticles; ++i) {
        Rng rng(Stream::Points, i);
        const std::optional<EmittedParticle> particle = particles.emit(i, rng);
        ASSERT_TRUE(particle);
        walk_particle(scene, *particle, i, {}, rng, [&](const ParticleFlight& flight) {
            most = std::max(most, flight.before);
            out += flight.escapes();
            EXPECT_NEAR(largest(flight.power) / largest(particle->power), 1.0f, 1e-4f) << flight.before;
            return true;
        });
    }
    EXPECT_EQ(out, kParticles);
    EXPECT_GT(most, kManyScatterings + 14);
    EXPECT_LT(most, kManyCollisions);
}

}  // namespace
}  // namespace brisance
