// What particles deposit along their tracks and where they land agrees with the path tracer within three
// standard errors and the blur of a voxel and of a disc. Rays do not come from the eye.
#include <gtest/gtest.h>

#include "core/parallel.h"
#include "fixtures/ray_fixture.h"
#include "volumetric_photons/volumetric_photons.h"

namespace brisance {
namespace {

using namespace testing;

// Of a ball 8 voxels in radius, and of discs on the floor below it.
constexpr double kBlur = 0.02;

VolumetricPhotonSettings settings(std::uint32_t seed) {
    VolumetricPhotonSettings s;
    s.paths = 6000;
    s.neighbours = 32;
    s.seed = seed;
    return s;
}

Estimate mean_by_particles(const Stage& stage) {
    return mean_by_lights(
        stage,
        [&](std::uint32_t seed) {
            return std::make_unique<VolumetricPhotons>(stage.scene(), settings(seed), stage.bounces(), dvec3(100.0),
                                                       true);
        },
        1);
}

void expect_as_paths(const Stage& stage, const char* what, std::uint64_t path_samples = kPathsOverFloor) {
    expect_same_means(mean_by_particles(stage), mean_by_paths(stage, path_samples), what, 0.05, kBlur);
}

TEST(ParticlesAgainstPaths, Ball) {
    expect_as_paths(Stage(coloured_ball(8, 1.5f, 0.0f), {}), "ball", kPathsInSmoke);
}

TEST(ParticlesAgainstPaths, ForwardScatteringOverAFloor) {
    expect_as_paths(Stage(lumpy_ball(8, 3.0f, 0.6f), floor_below(0.7f)), "lumps, g 0.6");
}

TEST(ParticlesAgainstPaths, BackwardScattering) {
    expect_as_paths(Stage(coloured_ball(8, 2.0f, -0.7f), {}), "ball, g -0.7", kPathsInSmoke);
}

TEST(ParticlesAgainstPaths, BouncesEndWhereTheyAreAskedTo) {
    for (const int bounces : {2, 3})
        expect_as_paths(Stage(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f), {}, bounces),
                        bounces == 2 ? "two bounces" : "three bounces");
    const Stage once(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f), {}, 1);
    const VolumetricPhotons none(once.scene(), settings(1), once.bounces(), dvec3(100.0), true);
    EXPECT_EQ(none.report().surface_photons, 0u);
    Rng rng(Stream::Points, 3);
    for (int i = 0; i < 100; ++i) {
        const Twice seen = once.by_lights(none, once.ray(rng), rng);
        EXPECT_EQ(seen.medium, Rgb(0.0f));
        EXPECT_EQ(seen.surface, Rgb(0.0f));
    }
}

}  // namespace
}  // namespace brisance
