// All ways to choose among the lights of the fire have the path tracer's single scattering, cuts as far as they may not
// err.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fire_lights/fire_on_rays.h"
#include "fixtures/ray_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// Single scattering by paths and by a sampling, along the rays of a stage.
struct SingleScattering {
    explicit SingleScattering(const Recipe& recipe, Scene set = {}) : stage(recipe, std::move(set), {}, 1) {}

    Estimate by_paths(double relative) const {
        const PathTracer tracer(stage.scene().field().medium(), {}, 1, stage.scene().surroundings());
        return estimate_to(relative, 3, [&](const dvec3& u, Rng& rng, double* out) {
            PathSum sum{};
            PathStatistics statistics;
            tracer.trace(stage.ray(rng), u.z, rng, sum, statistics);
            for (int c = 0; c < 3; ++c)
                out[c] = sum.cells.at(Cell::MV)[c];
        });
    }

    Estimate by_lights(const std::string& sampling, const FireLightSettings& settings, double relative) const {
        const FireOnRays fire(stage.scene(), *find_fire_light_sampling(sampling), settings);
        return estimate_to(relative, 3, [&](const dvec3&, Rng& rng, double* out) {
            const Rgb light = along(fire, stage.ray(rng), rng);
            for (int c = 0; c < 3; ++c)
                out[c] = light[c];
        });
    }

    Rgb along(const FireOnRays& fire, const Ray& ray, Rng& rng) const {
        thread_local RayMedium seen;
        seen.look(stage.scene().field(), ray, stage.scene().segment_along(ray).end);
        return fire.along(seen, ray, rng);
    }

    Stage stage;
};

// With a few hundred voxels that burn, so that all of them can be asked.
Recipe small_fire(float mean_cosine) {
    Recipe r = lumpy_ball(6, 3.0f, mean_cosine);
    const NodeScalar whole = r.flame;
    r.flame = [whole](const ivec3& n) { return n.y < 1 && n.z < 2 ? whole(n) : 0.0f; };
    return r;
}

void expect_same(const Estimate& lights, const Estimate& paths, const std::string& what) {
    for (int c = 0; c < 3; ++c) {
        const double error = std::hypot(lights.error[c], paths.error[c]);
        EXPECT_NEAR(lights.mean[c], paths.mean[c], 4.0 * error) << what << ", channel " << c;
        EXPECT_LT(error, 0.04 * paths.mean[c]) << what << ": not sampled enough";
    }
    std::printf("%s: paths %.5g +- %.2g %%, lights %.5g +- %.2g %%\n", what.c_str(), paths.mean[0],
                100.0 * paths.error[0] / paths.mean[0], lights.mean[0], 100.0 * lights.error[0] / lights.mean[0]);
}

void expect_all_as_paths(const Recipe& recipe, const Scene& set, const std::string& what) {
    const SingleScattering scene(recipe, set);
    const Estimate paths = scene.by_paths(0.01);
    for (const FireLightSampling& row : fire_light_samplings()) {
        FireLightSettings s;
        s.lightcuts_error = 0.0;
        s.lightcuts_most = 1000000;
        const bool asks_all = std::string(row.name) == "all" || std::string(row.name).ends_with("lightcuts");
        s.points = asks_all ? 1 : 4;
        expect_same(scene.by_lights(row.name, s, 0.02), paths, what + ", " + row.name);
    }
}

TEST(FireSamplings, HaveTheMeanOfPaths) {
    expect_all_as_paths(small_fire(0.0f), {}, "g 0");
}

TEST(FireSamplings, HaveTheMeanOfPathsWhereSmokeScattersForward) {
    expect_all_as_paths(small_fire(0.6f), {}, "g 0.6");
}

// A wall through the smoke parts the fire from half of it.
TEST(FireSamplings, SeeWalls) {
    Scene wall;
    add_quad(wall, {0.1f, -4, -4}, {0, 8, 0}, {0, 0, 8}, lambert(0.5f));
    expect_all_as_paths(small_fire(0.0f), wall, "wall");
}

// Neither the number of points nor of lights changes what is expected.
TEST(FireSamplings, HaveMeansThatDoNotDependOnCounts) {
    const SingleScattering scene(small_fire(0.3f));
    for (const char* const sampling : {"intensity", "light_tree", "stochastic_lightcuts"}) {
        FireLightSettings one, many;
        one.points = one.samples = one.stochastic_cut_size = 1;
        many.points = 7;
        many.samples = 5;
        many.stochastic_cut_size = 23;
        const Estimate a = scene.by_lights(sampling, one, 0.03), b = scene.by_lights(sampling, many, 0.015);
        expect_same(a, b, sampling);
        EXPECT_LT(b.error[0] * std::sqrt(double(b.samples)), a.error[0] * std::sqrt(double(a.samples))) << sampling;
    }
}

// Root of the mean squared difference from all lights at the same points, over their root mean square.
double error_of_cut(const SingleScattering& scene, const std::string& sampling, double error, int most) {
    FireLightSettings exact, cut;
    exact.points = cut.points = 4;
    cut.lightcuts_error = error;
    cut.lightcuts_most = most;
    exact.lightcuts_error = 0.0;
    exact.lightcuts_most = 1000000;
    const FireOnRays all(scene.stage.scene(), *find_fire_light_sampling("lightcuts"), exact);
    const FireOnRays some(scene.stage.scene(), *find_fire_light_sampling(sampling), cut);
    const Estimate found = estimate(2, 1, [&](const dvec3&, Rng& rng, double* out) {
        const Ray ray = scene.stage.ray(rng);
        Rng same = rng, again = rng;  // the same points: they are drawn first
        const double truth = luminance(scene.along(all, ray, same)), is = luminance(scene.along(some, ray, again));
        out[0] = (is - truth) * (is - truth);
        out[1] = truth * truth;
    });
    return std::sqrt(found.mean[0] / found.mean[1]);
}

// A cut of all lights differs from all lights by the random points in the voxels alone.
TEST(FireCuts, ErrLessWhereTheyMayErrLess) {
    const SingleScattering scene(small_fire(0.3f));
    for (const char* const sampling : {"lightcuts", "multidimensional_lightcuts"}) {
        const double floor = error_of_cut(scene, sampling, 0.0, 1000000);
        const double coarse = error_of_cut(scene, sampling, 0.5, 1000000),
                     middle = error_of_cut(scene, sampling, 0.05, 1000000),
                     fine = error_of_cut(scene, sampling, 0.005, 1000000);
        std::printf("%s: errors %.3g, %.3g, %.3g; of the points alone %.3g\n", sampling, coarse, middle, fine, floor);
        EXPECT_LT(fine, middle);
        EXPECT_LT(middle, coarse);
        EXPECT_LT(middle, 0.1);
        EXPECT_LT(fine, 1.5 * floor + 0.01);
    }
}

// One node stands for the whole fire.
TEST(FireCuts, OfOneNodeAreOneLight) {
    const SingleScattering scene(small_fire(0.3f));
    for (const char* const sampling : {"lightcuts", "multidimensional_lightcuts", "stochastic_lightcuts"}) {
        FireLightSettings s;
        s.lightcuts_most = s.stochastic_cut_size = 1;
        const Estimate found = scene.by_lights(sampling, s, 0.05);
        EXPECT_GT(found.mean[0], 0.0) << sampling;
        EXPECT_TRUE(std::isfinite(found.mean[0])) << sampling;
    }
}

// Representatives are drawn anew with every seed: the mean over seeds of the coarsest cut is that of all lights.
TEST(FireCuts, HaveTheRightMeanOverSeeds) {
    const SingleScattering scene(small_fire(0.3f));
    const Estimate paths = scene.by_paths(0.01);
    for (const char* const sampling : {"lightcuts", "multidimensional_lightcuts"}) {
        const Estimate found = estimate_to(
            0.03, 3,
            [&](const dvec3&, Rng& rng, double* out) {
                FireLightSettings s;
                s.points = 4;
                s.lightcuts_most = 1;
                s.seed = static_cast<std::uint32_t>(rng.next_double() * 0x1p31);
                const FireOnRays fire(scene.stage.scene(), *find_fire_light_sampling(sampling), s);
                constexpr int kRays = 16;
                std::fill(out, out + 3, 0.0);
                for (int i = 0; i < kRays; ++i) {
                    const Rgb light = scene.along(fire, scene.stage.ray(rng), rng);
                    for (int c = 0; c < 3; ++c)
                        out[c] += light[c] / double(kRays);
                }
            },
            20000);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.mean[c], paths.mean[c], 4.0 * std::hypot(found.error[c], paths.error[c])) << sampling;
        std::printf("%s of one node: %.4g +- %.2g %%, paths %.4g\n", sampling, found.mean[0],
                    100.0 * found.error[0] / found.mean[0], paths.mean[0]);
    }
}

}  // namespace
}  // namespace brisance
