// Lights of all kinds chosen together along rays through smoke: each cell keeps the mean that it has by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "transport/emitters_along_ray.h"
#include "unified_lights/lit_set.h"

namespace brisance {
namespace {

using namespace testing;

constexpr CellSet kOfSmoke = {Cell::MS, Cell::MV, Cell::MA};
constexpr const char* kNames[] = {"MS", "MV", "MA"};

// The smoke on a ray of the stage's family.
struct SeenSmoke {
    SeenSmoke(const DirectLight& scene, const Ray& r) : ray(r) {
        seen.look(scene.field(), r, scene.segment_along(r).end);
    }
    Ray ray;
    RayMedium seen;
};

// Luminance by separate choices, at one end of a free flight: MS by all virtual lights, MV by a tree of the fire alone
// (which has the mean of paths, FireSamplings), and MA by the rays of lamps.
Estimate apart_in_smoke(const LitSet& set, double relative) {
    const DirectLight& scene = set.stage.scene();
    FireLightSettings of_fire;
    of_fire.points = 1;
    const SampledFire fire(scene, *find_fire_light_sampling("stochastic_lightcuts"), of_fire);
    return estimate_to(relative, 3, [&](const dvec3& u, Rng& rng, double* out) {
        const SeenSmoke smoke(scene, set.stage.ray(u.y, u.z));
        std::vector<GatherPoint> points;
        if (!smoke.seen.empty())
            add_flight_ends(scene, smoke.seen, smoke.ray, 1, u.x, points);
        out[0] = 0.0;
        for (const GatherPoint& p : points)
            out[0] += luminance(p.weight * set.lights->shade(p.vertex, rng));
        out[1] = luminance(fire.along(smoke.seen, smoke.ray, rng));
        out[2] = luminance(emitters_along_ray(scene, smoke.seen, smoke.ray, 1, rng));
    });
}

Estimate together_in_smoke(const LitSet& set, const UnifiedLights& unified, double relative) {
    return estimate_to(relative, 3, [&](const dvec3& u, Rng& rng, double* out) {
        const SeenSmoke smoke(set.stage.scene(), set.stage.ray(u.y, u.z));
        const LightBySender light = unified.along(smoke.seen, smoke.ray, rng);
        out[0] = luminance(light.surfaces);
        out[1] = luminance(light.fire);
        out[2] = luminance(light.emitters);
    });
}

void expect_cells(const LitSet& set, const Estimate& apart, const std::string& sampling,
                  const UnifiedLightSettings& settings) {
    const Estimate together = together_in_smoke(set, set.unified(sampling, settings, kOfSmoke), 0.03);
    for (int c = 0; c < 3; ++c) {
        const double error = std::hypot(apart.error[c], together.error[c]);
        std::printf("%s, %s: apart %.4g, together %.4g, standard error %.2g\n", sampling.c_str(), kNames[c],
                    apart.mean[c], together.mean[c], error);
        EXPECT_LT(error, 0.04 * apart.mean[c]) << sampling << ", " << kNames[c] << ": not sampled enough";
        EXPECT_NEAR(together.mean[c], apart.mean[c], 4.0 * error) << sampling << ", " << kNames[c];
    }
}

// Beside a fire, a lamp, a sun, a sky and lights of the floor, cuts as far as they may not err.
TEST(UnifiedSmoke, HasTheMeansOfItsCells) {
    const LitSet set(small_fire(8.0f), floor_and_wall(0.0f), lamp_sun_and_sky(), 20);
    const Estimate apart = apart_in_smoke(set, 0.015);
    for (const UnifiedLightSampling& row : unified_light_samplings()) {
        UnifiedLightSettings s;
        s.lightcuts_error = 0.0;
        s.lightcuts_most = 100000;
        s.samples = 4;
        const bool asks_all = row.asks_every_light || std::string(row.name).ends_with("lightcuts");
        s.points = asks_all ? 2 : 4;
        expect_cells(set, apart, row.name, s);
    }
    UnifiedLightSettings one;
    one.stochastic_cut_size = one.points = 1;
    expect_cells(set, apart, "stochastic_lightcuts", one);
}

// Relative variance of the sum along rays, of twelve lights at each point beside a bright fire: a cut of all
// kinds, and one of four for each kind.
TEST(UnifiedSmoke, SharesSamplesOutByWhatShines) {
    const LitSet set(small_fire(30.0f), floor_and_wall(0.0f), lamp_sun_and_sky(), 20);
    UnifiedLightSettings of_all, of_each;
    of_all.points = of_each.points = 1;
    of_all.stochastic_cut_size = 12;
    of_each.stochastic_cut_size = 4;
    const UnifiedLights all = set.unified("stochastic_lightcuts", of_all, kOfSmoke),
                        surfaces = set.unified("stochastic_lightcuts", of_each, {Cell::MS}),
                        fire = set.unified("stochastic_lightcuts", of_each, {Cell::MV}),
                        emitters = set.unified("stochastic_lightcuts", of_each, {Cell::MA});
    Rng rays(Stream::Points, 5);
    SeenSmoke smoke(set.stage.scene(), set.stage.ray(rays));
    while (smoke.seen.empty() || smoke.seen.opacity() < 0.3)
        smoke = SeenSmoke(set.stage.scene(), set.stage.ray(rays));
    const auto variance = [&](const std::vector<const UnifiedLights*>& parts) {
        return relative_variance(4000, [&](std::uint64_t i) {
            double light = 0.0;
            std::uint32_t number = 0;
            for (const UnifiedLights* part : parts) {
                Rng rng = part->ray_rng(number++, i);
                light += luminance(part->along(smoke.seen, smoke.ray, rng));
            }
            return light;
        });
    };
    const double together = variance({&all}), apart = variance({&surfaces, &fire, &emitters});
    std::printf("relative variance together %.3g, apart %.3g\n", together, apart);
    EXPECT_LT(together, 0.75 * apart);
}

// With the lights of one kind alone, that cell has its mean, and the others are black.
TEST(UnifiedSmoke, HasTheMeanOfOneKindAlone) {
    const LitSet set(small_fire(1.0f), floor_and_wall(0.0f), lamp_sun_and_sky(), 20);
    const Estimate apart = apart_in_smoke(set, 0.02);
    for (int kind = 0; kind < 3; ++kind) {
        const CellSet alone = {kind == 0 ? Cell::MS : kind == 1 ? Cell::MV : Cell::MA};
        const UnifiedLights unified = set.unified("stochastic_lightcuts", {}, alone);
        const Estimate found = estimate_to(0.02, 1, [&](const dvec3& u, Rng& rng, double* out) {
            const SeenSmoke smoke(set.stage.scene(), set.stage.ray(u.y, u.z));
            const LightBySender light = unified.along(smoke.seen, smoke.ray, rng);
            const Rgb of[] = {light.surfaces, light.fire, light.emitters};
            for (int other = 0; other < 3; ++other)
                ASSERT_TRUE(other == kind || of[other] == Rgb(0.0f)) << kNames[other] << " beside " << kNames[kind];
            out[0] = luminance(of[kind]);
        });
        EXPECT_NEAR(found.mean[0], apart.mean[kind], 4.0 * std::hypot(found.error[0], apart.error[kind]))
            << kNames[kind];
    }
}

// A cube of even smoke without fire, and a lamp beside it.
struct LampBesideSmoke {
    LampBesideSmoke() : set(even_smoke(), Scene(), {lamp()}, 0) {}

    static Recipe even_smoke() {
        Recipe r = lumpy_ball(6, 1.0f, 0.3f);
        r.settings.fire.model = FireModel::None;
        r.density = [](const ivec3&) { return 1.0f; };
        return r;
    }
    static LightSettings lamp() {
        LightSettings lamp;
        lamp.position = {0.4, -2.5, 0.3};
        lamp.power = Rgb(2.0f);
        return lamp;
    }
    LitSet set;
};

// MA of one lamp is a quadrature along the ray: no choice among lights is left, and many points leave no noise.
TEST(UnifiedSmoke, IsLitByOneLampAsByQuadrature) {
    const LampBesideSmoke beside;
    const DirectLight& scene = beside.set.stage.scene();
    const SeenSmoke smoke(scene, {{0.1, 0.2, 4.0}, {0.0, 0.0, -1.0}});
    ASSERT_FALSE(smoke.seen.empty());
    const LightSettings lamp = LampBesideSmoke::lamp();
    constexpr int kSteps = 2000;
    const double length = smoke.seen.segment().length, g = scene.field().mean_cosine();
    double expected = 0.0;
    Rng any(Stream::Points, 3);
    for (int i = 0; i < kSteps; ++i) {
        const double t = (i + 0.5) / kSteps * length;
        const dvec3 p = smoke.ray.origin + (smoke.seen.begin() + t) * smoke.ray.direction, to = lamp.position - p;
        const double distance2 = glm::dot(to, to), distance = std::sqrt(distance2);
        const double cosine = glm::dot(smoke.ray.direction, to) / distance;
        const double phase = (1.0 - g * g) / (4.0 * kPi64 * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
        const double lit =
            lamp.power.x * phase / distance2 * scene.lines().transmittance({p, to / distance}, distance, any);
        expected += smoke.seen.transmittance(t) * smoke.seen.coefficients(t).scattering.x * lit * length / kSteps;
    }
    ASSERT_GT(expected, 0.0);
    for (const UnifiedLightSampling& row : unified_light_samplings()) {
        UnifiedLightSettings s;
        s.points = 500;
        s.lightcuts_error = 0.0;
        s.lightcuts_most = 100000;
        const UnifiedLights unified = beside.set.unified(row.name, s, kOfSmoke);
        Rng rng = unified.ray_rng(0, 0);
        const LightBySender light = unified.along(smoke.seen, smoke.ray, rng);
        EXPECT_NEAR(light.emitters.x, expected, 0.005 * expected) << row.name;
        EXPECT_EQ(light.fire, Rgb(0.0f));
        EXPECT_EQ(light.surfaces, Rgb(0.0f));
    }
}

TEST(UnifiedSmoke, WithoutLightsIsBlack) {
    const LitSet set(small_fire(1.0f), floor_and_wall(0.0f), lamp_sun_and_sky(), 0);
    Rng rays(Stream::Points, 4);
    const SeenSmoke smoke(set.stage.scene(), set.stage.ray(rays));
    for (const UnifiedLightSampling& row : unified_light_samplings()) {
        const UnifiedLights none = set.unified(row.name, {}, {});
        Rng rng = none.ray_rng(0, 0);
        EXPECT_EQ(luminance(none.along(smoke.seen, smoke.ray, rng)), 0.0f) << row.name;
    }
}

}  // namespace
}  // namespace brisance
