// What photons show agrees with the path tracer within three standard errors and the bias of the blur, which falls with
// the radius.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "fixtures/ray_fixture.h"
#include "photon_density/photon_density.h"

namespace brisance {
namespace {

using namespace testing;

constexpr DensityEstimator kAll[] = {DensityEstimator::PointPoint, DensityEstimator::PointBeam,
                                     DensityEstimator::BeamBeam};

std::string name_of(DensityEstimator estimator) {
    return estimator == DensityEstimator::PointPoint  ? "points in balls"
           : estimator == DensityEstimator::PointBeam ? "points in discs"
                                                      : "beams";
}

PhotonDensitySettings settings(DensityEstimator estimator, double radius, int paths = 1500) {
    PhotonDensitySettings s;
    s.estimator = estimator;
    s.paths = paths;
    s.radius = radius;
    s.neighbours = 16;
    return s;
}

Estimate mean_by_photons(const Stage& stage, const PhotonDensitySettings& wanted) {
    return mean_by_lights(
        stage,
        [&](std::uint32_t seed) {
            PhotonDensitySettings own = wanted;
            own.seed = seed;
            return std::make_unique<PhotonDensity>(stage.scene(), own, stage.bounces());
        },
        1);
}

// `blur`: relative bias that is allowed, of a radius that is a small part of the ball's.
void expect_as_paths(const Stage& stage, const char* what, double radius, double blur, std::uint64_t path_samples) {
    const Estimate paths = mean_by_paths(stage, path_samples);
    for (const DensityEstimator estimator : kAll)
        expect_same_means(mean_by_photons(stage, settings(estimator, radius)), paths,
                          (std::string(what) + ", " + name_of(estimator)).c_str(), 0.05, blur);
}

TEST(DensityAgainstPaths, SmokeOverAFloor) {
    expect_as_paths(Stage(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f)), "ball over a floor", 0.1, 0.02, 150);
}

TEST(DensityAgainstPaths, ForwardHaze) {
    expect_as_paths(Stage(coloured_ball(8, 1.0f, 0.8f), {}), "haze, g 0.8", 0.1, 0.02, kPathsInSmoke);
}

TEST(DensityAgainstPaths, LumpsThatScatterBackward) {
    expect_as_paths(Stage(lumpy_ball(8, 3.0f, -0.6f), {}), "lumps, g -0.6", 0.1, 0.02, kPathsInSmoke);
}

// Walls all around send the light back into the smoke.
TEST(DensityAgainstPaths, DiffuseBox) {
    Scene scene;
    add_quad(scene, {-1.3f, -1.3f, -1.2f}, {2.6f, 0, 0}, {0, 2.6f, 0}, lambert(0.8f));
    add_quad(scene, {-1.3f, 1.3f, -1.2f}, {2.6f, 0, 0}, {0, 0, 2.5f}, lambert(0.8f));
    add_quad(scene, {-1.3f, -1.3f, -1.2f}, {0, 2.6f, 0}, {0, 0, 2.5f}, lambert(0.5f));
    add_quad(scene, {1.3f, 1.3f, -1.2f}, {0, -2.6f, 0}, {0, 0, 2.5f}, lambert(0.5f));
    expect_as_paths(Stage(coloured_ball(8, 1.5f, 0.3f), std::move(scene)), "box", 0.1, 0.03, 150);
}

// As the radius goes to zero, so does the bias: like its square. The same particles at every radius, so that their
// noise is no part of the differences.
TEST(DensityAgainstPaths, BiasFallsWithTheRadius) {
    const Stage stage(coloured_ball(8, 2.0f, 0.0f), {});
    for (const DensityEstimator estimator : kAll) {
        const auto difference = [&](double radius, double other) {
            const Estimate e = estimate(1, 1, [&](const dvec3&, Rng& rng, double* out) {
                PhotonDensitySettings s = settings(estimator, radius, 800);
                s.seed = static_cast<std::uint32_t>(rng.next_double() * 0x1p32);
                const PhotonDensity wide(stage.scene(), s, -1);
                s.radius = other;
                const PhotonDensity narrow(stage.scene(), s, -1);
                *out = 0.0;
                for (int i = 0; i < 64; ++i) {
                    const Ray ray = stage.ray(rng);
                    Rng other_rng = rng;
                    const double a = stage.by_lights(wide, ray, rng).medium.x;
                    *out += (a - stage.by_lights(narrow, ray, other_rng).medium.x) / 64.0;
                }
            });
            return std::pair(e.mean[0], e.error[0]);
        };
        const auto [large, large_error] = difference(0.4, 0.2);
        const auto [small, small_error] = difference(0.2, 0.1);
        std::printf("%s: bias from 0.4 m to 0.2 m %.4g +- %.2g, from 0.2 m to 0.1 m %.4g +- %.2g\n",
                    name_of(estimator).c_str(), large, large_error, small, small_error);
        EXPECT_LT(large, -3.0 * large_error) << "light is lost at the ball's skin and from its bright middle";
        EXPECT_LT(std::abs(small), 0.5 * std::abs(large) + 3.0 * small_error);
    }
}

TEST(DensityAgainstPaths, BouncesEndWhereTheyAreAskedTo) {
    for (const int bounces : {2, 3})
        expect_as_paths(Stage(coloured_ball(8, 2.0f, 0.0f), {}, {}, bounces),
                        bounces == 2 ? "two bounces" : "three bounces", 0.1, 0.02, kPathsInSmoke);
    for (const int bounces : {0, 1}) {
        const Stage once(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f), {}, bounces);
        for (const DensityEstimator estimator : kAll) {
            const PhotonDensity none(once.scene(), settings(estimator, kAutomaticBlur), bounces);
            EXPECT_EQ(none.report().stored + none.report().surface_photons, 0u);
            Rng rng(Stream::Points, 3);
            const Twice seen = once.by_lights(none, once.ray(rng), rng);
            EXPECT_EQ(seen.medium, Rgb(0.0f));
            EXPECT_EQ(seen.surface, Rgb(0.0f));
        }
    }
}

}  // namespace
}  // namespace brisance
