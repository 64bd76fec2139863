// The path tracer and the brute-force estimator, in the same worlds, must find the same radiance.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "brute_force.h"
#include "fixtures/estimate.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "reference/path_tracer.h"

namespace brisance::independent {
namespace {

using testing::Recipe;

// Means must agree within four standard errors of their difference, in each of three colours of eleven views in all:
// were both right, one choice of seeds in five hundred would fail by chance, and seeds are fixed. Four standard errors
// must be less than 2 % of the mean, so that an error of 2 % shows.
constexpr double kMostSigmas = 4.0;
constexpr double kMostError = 0.0045;

// A world as the path tracer takes it.
class Traced {
public:
    Traced(Medium medium, const World& world)
        : medium_(std::move(medium)),
          origin_(medium_.world_of_local(vec3(0.0f))),
          surroundings_(scene(world), lamps(world)),
          tracer_(medium_, {}, -1, world.quads.empty() && world.lamps.empty() ? nullptr : &surroundings_) {}

    // Mean radiance of a view, to a relative standard error.
    testing::Estimate measure(const View& view, double relative) const {
        return testing::estimate_to(relative, 3, [&](const dvec3& u, Rng& rng, double* out) {
            const Line line = view.line(u.x, u.y);
            PathSum sum{};
            PathStatistics statistics;
            tracer_.trace({line.origin - origin_, line.direction}, u.z, rng, sum, statistics);
            dvec3 all(0.0);
            for (const Rgb& order : sum)
                all += dvec3(order);
            for (int c = 0; c < 3; ++c)
                out[c] = all[c];
        });
    }

private:
    Scene scene(const World& world) const {
        Scene scene;
        scene.origin = origin_;
        for (const Quad& q : world.quads) {
            SceneMaterial material = testing::lambert(0.0f);
            material.surface.base_colour = Rgb(q.reflectance);
            material.emission = Rgb(q.emission);
            testing::add_quad(scene, vec3(q.corner - origin_), vec3(q.u), vec3(q.v), material);
        }
        return scene;
    }

    static std::vector<LightSettings> lamps(const World& world) {
        std::vector<LightSettings> lights;
        for (const Lamp& lamp : world.lamps) {
            LightSettings light;
            light.kind = lamp.spot ? LightKind::Spot : LightKind::Point;
            light.position = lamp.position;
            light.direction = lamp.axis;
            light.power = Rgb(lamp.intensity);
            light.inner_degrees = lamp.inner_degrees;
            light.outer_degrees = lamp.outer_degrees;
            lights.push_back(light);
        }
        return lights;
    }

    Medium medium_;
    dvec3 origin_;  // of local space, world [m]
    Surroundings surroundings_;
    PathTracer tracer_;
};

struct NamedView {
    const char* name;
    View view;
    std::uint64_t paths;  // of the brute-force estimator
};

void expect_same(const Medium& medium, World world, const std::vector<NamedView>& views) {
    world.smoke = SmokeBox(medium);
    const Traced traced(medium, world);
    std::uint64_t seed = 0;
    for (const NamedView& v : views) {
        const Mean plain = measure(world, v.view, v.paths, ++seed);
        const testing::Estimate paths = traced.measure(v.view, 0.0031);
        for (int c = 0; c < 3; ++c) {
            const double error = std::hypot(plain.error[c], paths.error[c]);
            const double off = paths.mean[c] - plain.value[c];
            std::printf("%s, colour %d: %.6f, traced %+.2f %%, %+.2f standard errors of %.2f %%\n", v.name, c,
                        plain.value[c], 100.0 * off / plain.value[c], off / error, 100.0 * error / plain.value[c]);
            EXPECT_LE(std::abs(off), kMostSigmas * error) << v.name << ", colour " << c;
            EXPECT_LE(error, kMostError * plain.value[c]) << v.name << ", colour " << c << ": not sampled enough";
        }
    }
}

// From `eye` to a square of that width around `target`, seen face on.
View looking(const dvec3& eye, const dvec3& target, double width) {
    const dvec3 forward = glm::normalize(target - eye);
    const dvec3 x = glm::normalize(glm::cross(forward, dvec3(0.1, 0.2, 1.0))), y = glm::cross(x, forward);
    return {eye, target - 0.5 * width * (x + y), width * x, width * y};
}

// Noisy smoke in a ball of `radius` nodes around node 0 of a cubic lattice, `spacing` metres apart.
Recipe noisy_ball(int radius, double spacing, const dvec3& centre, float extinction, const Rgb& albedo, float g) {
    Recipe r;
    r.box = testing::cube(-radius - 1, radius + 1);
    r.world_from_index = testing::cubic(spacing, centre);
    r.density = [=](const ivec3& n) {
        return testing::ball(n, dvec3(0.0), radius) * (0.2f + 0.8f * testing::noise(n, 1));
    };
    r.settings = testing::black_smoke();
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = albedo;
    r.settings.smoke.mean_cosine = g;
    return r;
}

// Voxels are sheared, albedo varies from node to node, and the fire absorbs as it emits.
TEST(AgainstBruteForce, HeterogeneousIsotropicSmokeWithFire) {
    const dvec3 centre(3.1, -2.3, 5.2);
    Recipe r = noisy_ball(7, 1.0, centre, 1.6f, Rgb(1.0f), 0.0f);
    r.world_from_index = testing::transform(testing::some_linear_map(), centre);
    r.flame = [](const ivec3& n) {
        return testing::ball(n, dvec3(-2.5, 1.0, 1.0), 4.0) * (0.5f + 0.5f * testing::noise(n, 2));
    };
    r.colour = [](const ivec3& n) {
        return Rgb(0.6f, 0.5f, 0.4f) + 0.4f * Rgb(testing::noise(n, 3), testing::noise(n, 4), testing::noise(n, 5));
    };
    r.settings.fire.colour = Rgb(3.0f, 2.0f, 1.0f);
    const dvec3 fire = centre + testing::some_linear_map() * dvec3(-2.5, 1.0, 1.0);
    const dvec3 beside = centre + testing::some_linear_map() * dvec3(3.0, -1.0, -1.0);
    expect_same(testing::make_medium(r), {},
                {{"fire", looking(centre + dvec3(-4, 1, 2), fire, 0.6), 120'000},
                 {"smoke beside it", looking(centre + dvec3(3, -4, 1), beside, 0.6), 2'800'000},
                 {"from behind", looking(centre + dvec3(4, 1, -1), centre, 1.5), 700'000}});
}

// The fire shines whatever the smoke absorbs, also where there is none.
TEST(AgainstBruteForce, HeterogeneousForwardScatteringSmoke) {
    const dvec3 centre(-1.2, 0.4, 0.7);
    Recipe r = noisy_ball(8, 0.15, centre, 2.5f, Rgb(0.95f, 0.85f, 0.7f), 0.6f);
    r.flame = [](const ivec3& n) { return testing::ball(n, dvec3(5.0, 0.0, 4.0), 4.5); };
    r.settings.fire.convention = EmissionConvention::Direct;
    r.settings.fire.colour = Rgb(2.0f, 1.0f, 0.5f);
    const dvec3 fire = centre + 0.15 * dvec3(5.0, 0.0, 4.0);
    const dvec3 shade = centre - 0.15 * dvec3(3.0, 0.0, 2.0);
    expect_same(testing::make_medium(r), {},
                {{"against the light", looking(shade - 2.0 * (fire - shade), shade, 0.5), 550'000},
                 {"with the light", looking(fire + dvec3(1.5, 1.5, 1.5), shade, 0.5), 200'000}});
}

// A floor and a wall under an emitting panel, with burning smoke between them.
TEST(AgainstBruteForce, SurfacesWithSmokeBetween) {
    const dvec3 centre(0.0, 0.0, 0.9);
    Recipe r = noisy_ball(7, 0.1, centre, 2.0f, Rgb(0.8f, 0.7f, 0.6f), 0.3f);
    r.flame = [](const ivec3& n) { return testing::ball(n, dvec3(0.0, 1.0, -2.0), 3.0); };
    r.settings.fire.colour = Rgb(4.0f, 2.0f, 1.0f);
    World world;
    world.quads = {{{-1.5, -1.5, 0.0}, {3, 0, 0}, {0, 3, 0}, {0.7, 0.6, 0.5}, {0, 0, 0}},
                   {{-1.5, 1.5, 0.0}, {3, 0, 0}, {0, 0, 2.5}, {0.3, 0.6, 0.7}, {0, 0, 0}},
                   {{-1.2, -1.0, 2.3}, {0, 2, 0}, {2.4, 0, 0}, {0.2, 0.2, 0.2}, {1.0, 1.5, 2.0}}};
    const dvec3 eye(0.4, -4.0, 1.4);
    expect_same(testing::make_medium(r), world,
                {{"floor", looking(eye, {0.2, -0.6, 0.0}, 0.5), 900'000},
                 {"smoke", looking(eye, {-0.1, 0.0, 1.1}, 0.5), 600'000}});
}

// A point lamp in a hollow of the smoke (without the hollow, inverse squares would have no variance), above a floor.
TEST(AgainstBruteForce, ALampInSmokeOverAFloor) {
    Recipe r = noisy_ball(8, 0.1, {0.0, 0.0, 1.0}, 2.5f, Rgb(0.9f, 0.8f, 0.6f), 0.4f);
    const dvec3 hollow(2.0, -1.0, 1.0);
    r.density = [=, smoke = r.density](const ivec3& n) { return smoke(n) * (1.0f - testing::ball(n, hollow, 3.0)); };
    World world;
    world.quads = {{{-2.0, -2.0, 0.0}, {4, 0, 0}, {0, 4, 0}, {0.5, 0.6, 0.7}, {0, 0, 0}}};
    world.lamps.push_back({dvec3(0.2, -0.1, 1.1), {4.0, 4.0, 6.0}});
    const dvec3 eye(0.3, -3.5, 2.0);
    expect_same(testing::make_medium(r), world,
                {{"floor", looking(eye, {0.5, -0.7, 0.0}, 0.4), 800'000},
                 {"smoke", looking(eye, {-0.3, 0.1, 1.2}, 0.4), 300'000}});
}

// A spot shines through smoke onto the floor.
TEST(AgainstBruteForce, ASpotThroughSmoke) {
    const Recipe r = noisy_ball(6, 0.1, {0.0, 0.0, 0.9}, 2.0f, Rgb(0.7f, 0.8f, 0.9f), -0.3f);
    World world;
    world.quads = {{{-2.0, -2.0, 0.0}, {4, 0, 0}, {0, 4, 0}, {0.6, 0.5, 0.4}, {0, 0, 0}}};
    world.lamps.push_back(
        {{-0.9, 0.3, 2.4}, {9.0, 8.0, 6.0}, true, glm::normalize(dvec3(0.9, -0.3, -1.5)), 12.0, 24.0});
    const dvec3 eye(0.5, -3.0, 1.5);
    expect_same(testing::make_medium(r), world,
                {{"floor", looking(eye, {0.7, -0.4, 0.0}, 0.5), 240'000},
                 {"smoke", looking(eye, {0.0, 0.0, 0.9}, 0.4), 300'000}});
}

}  // namespace
}  // namespace brisance::independent
