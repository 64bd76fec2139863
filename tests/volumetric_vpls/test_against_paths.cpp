// Point lights have the mean of the path tracer where they should: unbounded, and bounded with compensation. Three
// standard errors of both together: one number in 370 fails by chance, and seeds are fixed.
#include <gtest/gtest.h>

#include <cstdio>

#include "point_fixture.h"

namespace brisance {
namespace {

using namespace testing;

constexpr auto kNone = BiasCompensation::None, kExact = BiasCompensation::Exact, kLocal = BiasCompensation::Local;

// Unbounded, a few points almost touch a few rays: their standard error falls slowly, and is only just one.
Estimate expect_as_paths(const Stage& stage, const char* what, std::uint64_t path_samples = kPathsOverFloor,
                         double radius = 0.4, double sharp = 0.05) {
    Estimate paths = mean_by_paths(stage, path_samples);
    const std::string name(what);
    expect_same_means(mean_by_points(stage, points(0.0, kNone)), paths, (name + ", unbounded").c_str(), sharp);
    expect_same_means(mean_by_points(stage, points(radius, kExact)), paths, (name + ", exact").c_str(), sharp);
    return paths;
}

TEST(PointsAgainstPaths, Ball) {
    expect_as_paths(Stage(coloured_ball(8, 1.5f, 0.0f), {}), "ball", kPathsInSmoke);
}

TEST(PointsAgainstPaths, LumpyBallOverAFloor) {
    expect_as_paths(Stage(lumpy_ball(8, 3.0f, 0.0f), floor_below(0.7f)), "lumps");
}

TEST(PointsAgainstPaths, ForwardScatteringOverAFloor) {
    expect_as_paths(Stage(lumpy_ball(8, 3.0f, 0.6f), floor_below(0.7f)), "lumps, g 0.6");
}

TEST(PointsAgainstPaths, BackwardScattering) {
    expect_as_paths(Stage(coloured_ball(8, 2.0f, -0.3f), {}), "ball, g -0.3", kPathsInSmoke);
}

TEST(PointsAgainstPaths, ALampOutsideOverAFloor) {
    Recipe dark = lumpy_ball(8, 3.0f, 0.3f);
    dark.flame = {};
    const Stage stage(dark, floor_below(0.7f), {lamp_beside()});
    const Estimate paths = expect_as_paths(stage, "lamp");
    VolumetricVplSettings thinned = points(0.4, kExact);
    thinned.count = 200;
    expect_same_means(mean_by_points(stage, thinned), paths, "lamp, most lights left out");
}

// Light goes from vertex to vertex within the bound's radius many times: all of the ball is nearer than that.
TEST(PointsAgainstPaths, ABoundWiderThanTheSmoke) {
    expect_as_paths(Stage(coloured_ball(8, 4.0f, 0.0f), floor_below(0.7f), {lamp_beside()}), "wide bound",
                    kPathsOverFloor, 3.0, 0.15);
}

// Light from floor and mirror is compensated as well: what is left out arrives at the nearer vertex from everywhere. By
// fire alone: paths cannot find a point lamp in a mirror.
TEST(PointsAgainstPaths, AMirrorAbove) {
    SceneMaterial mirror = lambert(0.9f);
    mirror.surface.metallic = 1.0f;
    mirror.surface.roughness = 0.0f;
    Scene scene;
    add_quad(scene, {-4, -4, -1.2f}, {8, 0, 0}, {0, 8, 0}, lambert(0.7f));
    add_quad(scene, {-4, -4, 2.8f}, {8, 0, 0}, {0, 8, 0}, mirror);  // above the rays
    const Stage stage(coloured_ball(8, 2.0f, 0.0f), std::move(scene));
    expect_same_means(mean_by_points(stage, points(0.5, kExact)), mean_by_paths(stage, kPathsOverFloor),
                      "mirror, exact");
}

TEST(PointsAgainstPaths, BouncesEndWhereTheyAreAskedTo) {
    for (const int bounces : {2, 3})
        expect_as_paths(Stage(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f), {lamp_beside()}, bounces),
                        bounces == 2 ? "two bounces" : "three bounces");
    const Stage once(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f), {lamp_beside()}, 1);
    const VolumetricVpls none(once.scene(), points(0.5, kExact), once.bounces(), {});
    EXPECT_TRUE(none.lights().empty());
    Rng rng(Stream::Points, 3);
    for (int i = 0; i < 100; ++i) {
        const Twice seen = once.by_lights(none, once.ray(rng), rng);
        EXPECT_EQ(seen.medium, Rgb(0.0f));
        EXPECT_EQ(seen.surface, Rgb(0.0f));
    }
}

TEST(PointsAgainstPaths, TheBoundDarkensAndTheGuessComesNear) {
    std::printf("%-14s %8s %9s %9s %9s\n", "medium", "radius", "bounded", "local", "error");
    const auto compare = [](const char* what, const Stage& stage, const Estimate& paths, double radius,
                            double tolerance) {
        const Estimate bounded = mean_by_points(stage, points(radius, kNone));
        const Estimate local = mean_by_points(stage, points(radius, kLocal));
        const double truth = paths.mean[0], error = std::hypot(local.error[0], paths.error[0]);
        std::printf("%-14s %8.2g %+8.1f%% %+8.1f%% %8.1f%%\n", what, radius, 100.0 * (bounded.mean[0] / truth - 1.0),
                    100.0 * (local.mean[0] / truth - 1.0), 100.0 * error / truth);
        EXPECT_LT(bounded.mean[0], truth - 4.0 * std::hypot(bounded.error[0], paths.error[0])) << what;
        EXPECT_NEAR(local.mean[0], truth, tolerance * truth + 3.0 * error) << what;
    };
    const Stage even(coloured_ball(8, 2.0f, 0.0f), {}), forward(coloured_ball(8, 2.0f, 0.6f), {}),
        lumps(lumpy_ball(8, 3.0f, 0.0f), {});
    const Estimate paths = mean_by_paths(even, kPathsInSmoke);
    compare("even", even, paths, 0.15, 0.02);
    compare("even", even, paths, 0.3, 0.05);
    compare("even, g 0.6", forward, mean_by_paths(forward, kPathsInSmoke), 0.3, 0.05);
    compare("lumps", lumps, mean_by_paths(lumps, kPathsInSmoke), 0.3, 0.1);
}

}  // namespace
}  // namespace brisance
