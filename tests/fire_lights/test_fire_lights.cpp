// The fire as single lights: their energy, and the light of one of them along a ray, in closed form.
#include "fire_lights/fire_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "fire_lights/sampled_fire.h"
#include "fixtures/estimate.h"
#include "fixtures/media.h"
#include "medium/phase.h"

namespace brisance {
namespace {

using namespace testing;

constexpr float kExtinction = 0.1f, kAlbedo = 0.5f, kG = 0.5f, kStrength = 7.0f;
constexpr double kSpacing = 0.1;

// Even thin smoke from -2.5 to 2.5 m. Nodes where `burns` shine by themselves.
Recipe even_smoke(const std::function<bool(const ivec3&)>& burns) {
    Recipe r;
    r.box = cube(-24, 24);
    r.world_from_index = cubic(kSpacing);
    r.density = [](const ivec3&) { return 1.0f; };
    r.flame = [=](const ivec3& n) { return burns(n) ? 1.0f : 0.0f; };
    r.settings = black_smoke();
    r.settings.fire.convention = EmissionConvention::Direct;
    r.settings.fire.strength = kStrength;
    r.settings.smoke.extinction_per_metre = kExtinction;
    r.settings.smoke.albedo = Rgb(kAlbedo);
    r.settings.smoke.mean_cosine = kG;
    return r;
}

bool at_origin(const ivec3& n) {
    return n == ivec3(0);
}

TEST(FireLights, HaveTheEnergyOfTheHierarchys) {
    Recipe r = glowing_ball(5, 3.0f);
    r.world_from_index = transform(some_linear_map(), {1.0, 2.0, 3.0});
    r.flame = [](const ivec3& n) { return n.x < 1 ? noise(n, 3) : 0.0f; };
    const Medium medium = make_medium(r);
    const DirectLight scene(medium, {}, nullptr);
    const FireLights lights(scene);
    ASSERT_GT(lights.size(), 100u);
    const double sum = std::accumulate(lights.intensity().begin(), lights.intensity().end(), 0.0);
    EXPECT_NEAR(sum, total_luminance(voxel_lights(medium)), 1e-5 * sum);
}

TEST(FireLights, LieInTheirBounds) {
    Recipe r = glowing_ball(4, 3.0f);
    r.world_from_index = transform(some_linear_map(), dvec3(0.0));
    const Medium medium = make_medium(r);
    const DirectLight scene(medium, {}, nullptr);
    const FireLights lights(scene);
    const LightTree tree(lights.bounds());
    const double sum = std::accumulate(lights.intensity().begin(), lights.intensity().end(), 0.0);
    EXPECT_NEAR(tree.lights(0).intensity(), sum, 1e-9 * sum);
}

// One node glows: the sum over the lights around it is the integral of its hat function, h^3 times its emission.
double intensity_of_one() {
    return kStrength * kSpacing * kSpacing * kSpacing;
}

// Half a metre or more beside the light, a twentieth of the distance wide.
TEST(SampledFire, OneLightInThinSmokeHasTheIntegralOfItsPoint) {
    const Medium medium = make_medium(even_smoke(at_origin));
    const DirectLight scene(medium, {}, nullptr);
    const dvec3 middle(medium.local_of_node(ivec3(0)));
    const Ray ray{middle + dvec3(-1.5, 0.9, 0.3), {1.0, 0.0, 0.0}};
    constexpr double kEnd = 3.0;
    double expected = 0.0;
    constexpr int kSteps = 100000;
    for (int i = 0; i < kSteps; ++i) {
        const double t = (i + 0.5) / kSteps * kEnd;
        const dvec3 offset = ray.origin + t * ray.direction - middle;
        const double w = glm::length(offset);
        expected += henyey_greenstein(float(glm::dot(offset / w, -ray.direction)), kG) *
                    std::exp(-kExtinction * (t + w)) / (w * w) * kEnd / kSteps;
    }
    expected *= intensity_of_one() * kExtinction * kAlbedo;
    for (const FireLightSampling& row : fire_light_samplings()) {
        FireLightSettings settings;
        settings.points = 16;
        settings.lightcuts_error = 0.0;
        const SampledFire fire(scene, row, settings);
        ASSERT_EQ(fire.lights(), 8u);
        const Estimate found = estimate_to(0.003, 1, [&](const dvec3&, Rng& rng, double* out) {
            RayMedium seen;
            seen.look(scene.field(), ray, kEnd);
            out[0] = fire.along(seen, ray, rng).x;
        });
        // The light is no point: (h / w)^2 / 6 at most.
        EXPECT_NEAR(found.mean[0], expected, 4.0 * found.error[0] + 0.002 * expected) << row.name;
    }
}

// In the middle of a voxel whose corners all glow alike the radiance of one voxel is j times the integral of 1 / w^2
// over the unit cube, 7.6741 h, the closed form of the near field's tables.
TEST(FireLights, HaveTheNearFieldOfTheirVoxel) {
    Recipe r = even_smoke([](const ivec3&) { return true; });
    r.settings.smoke.extinction_per_metre = 1e-6f;
    const Medium medium = make_medium(r);
    const DirectLight scene(medium, {}, nullptr);
    const FireLights lights(scene);
    const dvec3 middle = dvec3(medium.local_of_node(ivec3(0))) + 0.5 * kSpacing;
    const PathVertex vertex(middle, {1.0, 0.0, 0.0}, 0.0f);
    const std::vector<LightBounds> bounds = lights.bounds();
    std::size_t own = bounds.size();
    for (std::size_t i = 0; i < bounds.size(); ++i)
        if (glm::all(glm::lessThan(bounds[i].low, middle)) && glm::all(glm::greaterThan(bounds[i].high, middle)))
            own = i;
    ASSERT_LT(own, bounds.size());
    const Estimate found = estimate_to(
        0.002, 1, [&](const dvec3&, Rng& rng, double* out) { out[0] = lights.estimate(own, 1.0, vertex, rng).x; });
    const double expected = kStrength * 7.6741 * kSpacing / (4.0 * kPi64);
    EXPECT_NEAR(found.mean[0], expected, 4.0 * found.error[0] + 1e-4 * expected);
}

TEST(SampledFire, WithoutFireOrSmokeAreBlack) {
    Recipe dark = even_smoke([](const ivec3&) { return false; });
    const Medium none = make_medium(dark);
    Recipe black = even_smoke(at_origin);
    black.settings.smoke.albedo = Rgb(0.0f);
    const Medium absorbs = make_medium(black);
    for (const Medium* medium : {&none, &absorbs})
        for (const FireLightSampling& row : fire_light_samplings()) {
            const DirectLight scene(*medium, {}, nullptr);
            const SampledFire fire(scene, row, {});
            RayMedium seen;
            Rng rng = fire.rng(0, 0);
            for (const double y : {0.0, 50.0}) {
                const Ray ray{{-9.0, y, 0.02}, {1.0, 0.0, 0.0}};
                seen.look(scene.field(), ray, kNoEnd);
                EXPECT_EQ(fire.along(seen, ray, rng), Rgb(0.0f)) << row.name;
            }
        }
}

}  // namespace
}  // namespace brisance
