// What photons show agrees with the path tracer within three standard errors and the bias of the blur, which falls with
// the radius.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "fixtures/ray_fixture.h"
#include "photon_density/estimators.h"
#include "photon_density/photon_density.h"

namespace brisance {
namespace {

using namespace testing;

// That of the family of rays.
const dvec3 kEye(0.5, -3.0, 2.5);

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
            return std::make_unique<PhotonDensity>(stage.scene(), own, stage.bounces(), kEye);
        },
        1);
}

// A tenth of the ball's radius, and the relative bias that is allowed for it.
constexpr double kRadius = 0.1, kBlur = 0.02;

// MM, without SM.
Estimate in_smoke(Estimate e) {
    std::fill(e.mean.begin() + 3, e.mean.end(), 0.0);
    std::fill(e.error.begin() + 3, e.error.end(), 0.0);
    return e;
}

void expect_as_paths(const Stage& stage, const char* what, std::uint64_t path_samples, bool surfaces,
                     int paths = 1500) {
    const auto part = [&](Estimate e) { return surfaces ? e : in_smoke(std::move(e)); };
    const Estimate expected = part(mean_by_paths(stage, path_samples));
    for (const DensityEstimator estimator : kEstimators)
        expect_same_means(part(mean_by_photons(stage, settings(estimator, kRadius, paths))), expected,
                          (std::string(what) + ", " + name_of(estimator)).c_str(), 0.05, kBlur);
}

TEST(DensityAgainstPaths, SmokeOverAFloor) {
    expect_as_paths(Stage(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f)), "ball over a floor", 150, true);
}

TEST(DensityAgainstPaths, ForwardHaze) {
    expect_as_paths(Stage(coloured_ball(8, 1.0f, 0.8f), {}), "haze, g 0.8", kPathsInSmoke, false, 4000);
}

TEST(DensityAgainstPaths, LumpsThatScatterBackward) {
    expect_as_paths(Stage(lumpy_ball(8, 3.0f, -0.6f), {}), "lumps, g -0.6", kPathsInSmoke, false);
}

// Walls all around send the light back into the smoke. On them the discs of few photons reach beyond the edges.
TEST(DensityAgainstPaths, DiffuseBox) {
    Scene scene;
    add_quad(scene, {-1.3f, -1.3f, -1.2f}, {2.6f, 0, 0}, {0, 2.6f, 0}, lambert(0.8f));
    add_quad(scene, {-1.3f, 1.3f, -1.2f}, {2.6f, 0, 0}, {0, 0, 2.5f}, lambert(0.8f));
    add_quad(scene, {-1.3f, -1.3f, -1.2f}, {0, 2.6f, 0}, {0, 0, 2.5f}, lambert(0.5f));
    add_quad(scene, {1.3f, 1.3f, -1.2f}, {0, -2.6f, 0}, {0, 0, 2.5f}, lambert(0.5f));
    expect_as_paths(Stage(coloured_ball(8, 1.5f, 0.3f), std::move(scene)), "box", kPathsInSmoke, false);
}

// Rays through a small fire in the middle of the smoke, from which the blur takes light away.
Ray through_the_middle(Rng& rng) {
    const dvec3 target(0.2 * rng.next_double() - 0.1, 0.2 * rng.next_double() - 0.1, 0.0);
    return {kEye, glm::normalize(target - kEye)};
}

// What one set of photons shows there with two radii: their noise is almost none of the difference.
std::pair<double, double> change_of_radius(const Stage& stage, DensityEstimator estimator, double wide, double narrow) {
    const Estimate e = estimate(1, 1, [&](const dvec3&, Rng& rng, double* out) {
        PhotonDensitySettings s = settings(estimator, wide, 1000);
        s.seed = static_cast<std::uint32_t>(rng.next_double() * 0x1p31);
        const PhotonDensity first(stage.scene(), s, -1, kEye);
        s.radius = narrow;
        const PhotonDensity second(stage.scene(), s, -1, kEye);
        *out = 0.0;
        for (int i = 0; i < 32; ++i) {
            const Ray ray = through_the_middle(rng);
            Rng same = rng;
            *out += (stage.by_lights(first, ray, rng).medium.x - stage.by_lights(second, ray, same).medium.x) / 32.0;
        }
    });
    return {e.mean[0], e.error[0]};
}

// As the radius goes to zero, so does the bias, like its square: halving the radius once more changes about a quarter
// as much. Peaks as narrow as the largest radius change somewhat more.
TEST(DensityAgainstPaths, BiasFallsWithTheRadius) {
    Recipe r = coloured_ball(8, 2.0f, 0.0f);
    r.flame = [](const ivec3& n) { return n.x * n.x + n.y * n.y + n.z * n.z < 5 ? 3.0f : 0.0f; };
    const Stage stage(r, {});
    for (const DensityEstimator estimator : kEstimators) {
        const auto [large, large_error] = change_of_radius(stage, estimator, 0.4, 0.2);
        const auto [small, small_error] = change_of_radius(stage, estimator, 0.2, 0.1);
        std::printf("%s: from 0.4 m to 0.2 m %.4g +- %.2g, from 0.2 m to 0.1 m %.4g +- %.2g\n", name_of(estimator),
                    large, large_error, small, small_error);
        EXPECT_LT(large, -3.0 * large_error);
        EXPECT_LT(small, 3.0 * small_error);
        EXPECT_LT(std::abs(small), 0.5 * std::abs(large) + 3.0 * small_error);
    }
}

TEST(DensityAgainstPaths, BouncesEndWhereTheyAreAskedTo) {
    for (const int bounces : {2, 3})
        expect_as_paths(Stage(coloured_ball(8, 2.0f, 0.0f), {}, {}, bounces),
                        bounces == 2 ? "two bounces" : "three bounces", kPathsInSmoke, false);
    for (const int bounces : {0, 1}) {
        const Stage once(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f), {}, bounces);
        for (const DensityEstimator estimator : kEstimators) {
            const PhotonDensity none(once.scene(), settings(estimator, kAutomaticBlur), bounces, kEye);
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
