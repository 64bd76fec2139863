// All ways to choose among the lights of the fire have the path tracer's single scattering, cuts as far as they may not
// err.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fire_lights/sampled_fire.h"
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
            tracer.trace(stage.ray(u.x, u.y), u.z, rng, sum, statistics);
            for (int c = 0; c < 3; ++c)
                out[c] = sum.cells.at(Cell::MV)[c];
        });
    }

    Estimate by_lights(const std::string& sampling, const FireLightSettings& settings, double relative) const {
        const SampledFire fire(stage.scene(), *find_fire_light_sampling(sampling), settings);
        return estimate_to(relative, 3, [&](const dvec3& u, Rng& rng, double* out) {
            const Rgb light = along(fire, stage.ray(u.x, u.y), rng);
            for (int c = 0; c < 3; ++c)
                out[c] = light[c];
        });
    }

    Rgb along(const SampledFire& fire, const Ray& ray, Rng& rng) const {
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

// A floor of which a camera close above sees a part, by paths and by a sampling.
struct LitFloor {
    LitFloor(const Recipe& recipe, const Scene& set, double height, double half)
        : scene(recipe, set), height(height), half(half) {}

    Ray ray(const dvec3& u) const {
        return {{half * (2.0 * u.x - 1.0), half * (2.0 * u.y - 1.0), height + 0.01}, {0.0, 0.0, -1.0}};
    }
    Estimate by_paths(double relative) const {
        const PathTracer tracer(scene.stage.scene().field().medium(), {}, 1, scene.stage.scene().surroundings());
        return estimate_to(relative, 3, [&](const dvec3& u, Rng& rng, double* out) {
            PathSum sum{};
            PathStatistics statistics;
            tracer.trace(ray(u), u.z, rng, sum, statistics);
            for (int c = 0; c < 3; ++c)
                out[c] = sum.cells.at(Cell::SV)[c];
        });
    }
    Estimate by_lights(const std::string& sampling, const FireLightSettings& settings, double relative) const {
        const SampledFire fire(scene.stage.scene(), *find_fire_light_sampling(sampling), settings);
        return estimate_to(relative, 3, [&](const dvec3& u, Rng& rng, double* out) {
            const Rgb light = seen(fire, ray(u), rng);
            for (int c = 0; c < 3; ++c)
                out[c] = light[c];
        });
    }
    Rgb seen(const SampledFire& fire, const Ray& ray, Rng& rng) const {
        const DirectLight& direct = scene.stage.scene();
        const RaySegment segment = direct.segment_along(ray);
        return fire.on_surface(PathVertex(*segment.point, ray.direction), rng) *
               float(direct.lines().transmittance(ray, segment.end, rng));
    }

    SingleScattering scene;
    double height, half;
};

Scene floor_at(float height) {
    Scene set;
    add_quad(set, {-6, -6, height}, {12, 0, 0}, {0, 12, 0}, lambert(0.6f));
    return set;
}

void expect_floor_as_paths(const Recipe& recipe, const Scene& set, double height, double half, const char* what) {
    const LitFloor floor(recipe, set, height, half);
    const Estimate paths = floor.by_paths(0.01);
    for (const FireLightSampling& row : fire_light_samplings()) {
        FireLightSettings s;
        s.lightcuts_error = 0.0;
        s.lightcuts_most = 1000000;
        s.samples = 4;
        expect_same(floor.by_lights(row.name, s, 0.015), paths, std::string(what) + ", " + row.name);
    }
}

// A plate beside the fire leaves half of the floor in its shadow and penumbra.
TEST(FireOnSurfaces, HasTheMeanOfPathsUnderAPlate) {
    Scene set = floor_at(-1.6f);
    add_quad(set, {0.0f, -3, -1.2f}, {3, 0, 0}, {0, 6, 0}, lambert(0.0f));
    expect_floor_as_paths(small_fire(0.4f), set, -1.6, 1.5, "floor under a plate");
    const LitFloor covered(small_fire(0.4f), set, -1.6, 1.5), open(small_fire(0.4f), floor_at(-1.6f), -1.6, 1.5);
    const double hidden = covered.by_paths(0.02).mean[0] / open.by_paths(0.02).mean[0];
    std::printf("the plate leaves %.3g of the light\n", hidden);
    EXPECT_LT(hidden, 0.8);
}

// Voxels that burn touch the floor, and smoke lies on it.
TEST(FireOnSurfaces, HasTheMeanOfPathsWhereItTouchesThem) {
    expect_floor_as_paths(small_fire(0.0f), floor_at(-0.21f), -0.21, 0.8, "floor in the fire");
}

// A floor beside the fire, root mean square over draws of the representatives.
TEST(FireOnSurfaces, CutsErrLessWhereTheyMayErrLess) {
    constexpr int kSeeds = 16;
    const LitFloor floor(small_fire(0.0f), floor_at(-1.6f), -1.6, 1.5);
    const auto lit = [&](const char* sampling, double error, std::uint32_t seed, int times) {
        FireLightSettings s;
        s.lightcuts_error = error;
        s.lightcuts_most = 1000000;
        s.seed = seed;
        const SampledFire fire(floor.scene.stage.scene(), *find_fire_light_sampling(sampling), s);
        double sum = 0.0;
        for (int i = 0; i < times; ++i) {
            Rng rng = fire.surface_rng(0, static_cast<std::uint64_t>(i));
            sum += luminance(floor.seen(fire, floor.ray({0.3, 0.4, 0.0}), rng)) / times;
        }
        return sum;
    };
    const double truth = lit("all", 0.0, 0, 256);
    for (const char* const sampling : {"lightcuts", "multidimensional_lightcuts"}) {
        const auto error_of = [&](double error) {
            double square = 0.0;
            for (std::uint32_t seed = 0; seed < kSeeds; ++seed)
                square += std::pow(lit(sampling, error, seed, 32) / truth - 1.0, 2) / kSeeds;
            return std::sqrt(square);
        };
        const double coarse = error_of(0.5), middle = error_of(0.02), fine = error_of(0.0);
        std::printf("%s on a floor: errors %.3g, %.3g, %.3g\n", sampling, coarse, middle, fine);
        EXPECT_LT(middle, 0.5 * coarse) << sampling;
        EXPECT_LT(middle, 0.1) << sampling;
        EXPECT_LT(fine, 0.03) << sampling;
    }
}

// Points on a line through the half of the ball that does not burn, some voxels away from the fire: little noise but
// that of the cut.
std::vector<GatherPoint> points_beside_the_fire() {
    std::vector<GatherPoint> points;
    for (int i = 0; i < 9; ++i)
        points.push_back({PathVertex({-0.5, -0.6 + 0.15 * i, 0.2}, {0.0, 1.0, 0.0}, 0.3f), Rgb(1.0f), 1.0});
    return points;
}

// What a cut gathers at these points.
double gathered(const FireLights& lights, const char* sampling, double error, std::uint32_t seed, int times) {
    FireLightSettings s;
    s.lightcuts_error = error;
    s.lightcuts_most = 1000000;
    s.seed = seed;
    const auto gatherer = find_fire_light_sampling(sampling)->make(lights, s);
    const std::vector<GatherPoint> points = points_beside_the_fire();
    double sum = 0.0;
    for (int i = 0; i < times; ++i) {
        Rng rng(Stream::Points, seed, static_cast<std::uint64_t>(i));
        sum += luminance(gatherer->at(points, rng)) / times;
    }
    return sum;
}

TEST(FireCuts, ErrLessWhereTheyMayErrLess) {
    constexpr int kSeeds = 16;
    const SingleScattering scene(small_fire(0.3f));
    const FireLights lights(scene.stage.scene());
    for (const char* const sampling : {"lightcuts", "multidimensional_lightcuts"}) {
        const double truth = gathered(lights, "all", 0.0, 0, 64);
        const auto error_of = [&](double error) {
            double square = 0.0;
            for (std::uint32_t seed = 0; seed < kSeeds; ++seed)
                square += std::pow(gathered(lights, sampling, error, seed, 4) / truth - 1.0, 2) / kSeeds;
            return std::sqrt(square);
        };
        const double coarse = error_of(0.5), middle = error_of(0.02), fine = error_of(0.0);
        std::printf("%s: errors %.3g, %.3g, %.3g\n", sampling, coarse, middle, fine);
        EXPECT_LT(middle, 0.5 * coarse) << sampling;
        EXPECT_LT(middle, 0.1) << sampling;
        EXPECT_LT(fine, 0.02) << sampling;
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
            0.05, 3,
            [&](const dvec3&, Rng& rng, double* out) {
                FireLightSettings s;
                s.points = 4;
                s.lightcuts_most = 1;
                s.seed = static_cast<std::uint32_t>(rng.next_double() * 0x1p31);
                const SampledFire fire(scene.stage.scene(), *find_fire_light_sampling(sampling), s);
                constexpr int kAcross = 4;
                std::fill(out, out + 3, 0.0);
                for (int i = 0; i < kAcross * kAcross; ++i) {
                    const glm::dvec2 at = point_in_cell(i, kAcross, rng);
                    const Rgb light = scene.along(fire, scene.stage.ray(at.x, at.y), rng);
                    for (int c = 0; c < 3; ++c)
                        out[c] += light[c] / double(kAcross * kAcross);
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
