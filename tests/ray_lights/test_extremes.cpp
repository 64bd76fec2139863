// Ray lights in limiting cases: no length, one line, sharp phase functions, endless smoke, smoke around
// everything. All is finite, and right where there is something to compare with.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fixtures/ray_fixture.h"
#include "light_selection/tabulated_sampling.h"

namespace brisance {
namespace {

using namespace testing;

bool finite(const Rgb& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

RayLightSettings of_paths(int paths = 600) {
    RayLightSettings s;
    s.paths = paths;
    s.count = 100'000;
    s.samples = 4;
    return s;
}

LightSettings lamp(const dvec3& position, float power) {
    LightSettings l;
    l.kind = LightKind::Point;
    l.position = position;
    l.power = Rgb(power);
    return l;
}

// Every light, thin and thick, along rays: finite, and not below zero.
void expect_finite(const Stage& stage, RayLightSettings settings, const std::vector<Ray>& rays, const char* what) {
    for (const double radius : {0.0, 0.1, kAutomaticRadius}) {
        settings.radius = radius;
        const RayLights lights = stage.lights(settings, 8, 3);
        Rng rng(Stream::Points, 41);
        for (const Ray& ray : rays)
            for (const bool all : {false, true}) {
                const Twice seen = stage.by_lights(lights, ray, rng, all);
                EXPECT_TRUE(finite(seen.medium) && finite(seen.surface)) << what << ", radius " << radius;
                EXPECT_GE(seen.medium.x, 0.0f) << what << ", radius " << radius;
                EXPECT_GE(seen.surface.x, 0.0f) << what << ", radius " << radius;
            }
    }
}

std::vector<Ray> some_rays(const Stage& stage, int count) {
    Rng rng(Stream::Points, 42);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i)
        rays.push_back(stage.ray(rng));
    return rays;
}

TEST(Extremes, RaysWithoutALength) {
    const Segment ray{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1.0}, none{{0.2, 0.3, 0.0}, {0.0, 1.0, 0.0}, 0.0};
    Rng rng(Stream::Points, 43);
    for (const double radius : {0.0, 0.2}) {
        EXPECT_FALSE(PairDensity(ray, none, 0.5, radius).sample(rng));
        EXPECT_FALSE(PairDensity(none, ray, 0.5, radius).sample(rng));
    }
    std::vector<RayLight> lights(3);
    for (RayLight& light : lights) {
        light.segment = none;
        light.scattered = 1.0;
    }
    const MediumLightTree tree(boxes_of(lights), 0.9);
    for (const LightReceiver& receiver :
         {LightReceiver::along(ray), LightReceiver::along({none.start, {0.0, 0.0, 1.0}, 1.0}),
          LightReceiver::at(none.start, {0.0, 0.0, 1.0})}) {
        const auto choice = tree.choose(receiver, 0.5);
        ASSERT_TRUE(choice);
        EXPECT_NEAR(choice->probability, 1.0 / 3.0, 0.2);
    }
    // Nothing arrives along no ray.
    EXPECT_FALSE(tree.choose(LightReceiver::along(none), 0.5));
}

// A ray that ends where it begins, one that just touches the smoke, one that passes it by, and one that begins in it.
TEST(Extremes, RaysThatHardlySeeTheSmoke) {
    const Stage stage(coloured_ball(8, 2.0f, 0.5f), floor_below(0.7f));
    const RayLights lights = stage.lights(of_paths(60), 8, 3);
    RayMedium seen;
    Rng rng(Stream::Points, 44);
    for (const double end : {0.0, 1e-300, 1e-12, 1.0}) {
        seen.look(stage.scene().field(), {{0.1, 0.1, 0.1}, {0.0, 0.0, 1.0}}, end);
        EXPECT_TRUE(finite(lights.along_ray(seen, rng))) << end;
        EXPECT_TRUE(finite(lights.along_ray_from_all(seen, rng))) << end;
    }
    std::vector<Ray> rays = {{{-3.0, 1.0, 0.0}, {1.0, 0.0, 0.0}},
                             {{-3.0, 1.1249999, 0.0}, {1.0, 0.0, 0.0}},
                             {{-3.0, 9.0, 0.0}, {1.0, 0.0, 0.0}},
                             {{0.0, 0.0, 0.0}, glm::normalize(dvec3(1.0, 2.0, -3.0))}};
    expect_finite(stage, of_paths(60), rays, "rays at the edge");
}

// The double integral of kernel and both phase functions over two parallel segments with the same direction, or with
// opposite directions. The integrand depends on the shift along the lines alone.
struct Parallel {
    double height, length, g, radius;
    bool opposite;

    Segment camera() const { return {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, length}; }
    Segment light() const {
        const dvec3 start(opposite ? length : 0.0, height, 0.0);
        return {start, {opposite ? -1.0 : 1.0, 0.0, 0.0}, length};
    }
    double kernel(double shift) const { return BallCone({1.0, 0.0, 0.0}, std::hypot(shift, height), radius).kernel(); }
    double by_quadrature() const {
        constexpr int kSteps = 400'000;
        // Steps in the logarithm of the shift, to either side.
        const double low = std::log(1e-9 * length), step = (std::log(length) - low) / kSteps;
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const double s = std::exp(low + (i + 0.5) * step);
            for (const double shift : {s, -s}) {
                const dvec3 direction = glm::normalize(dvec3(shift, -height, 0.0));
                const double phases =
                    phase_about(light().direction, direction, g) * phase_about(direction, -camera().direction, g);
                sum += (length - s) * phases * kernel(shift) * s * step;
            }
        }
        return sum;
    }
    template <class Pairs>
    Estimate by_pairs() const {
        const Pairs pairs(camera(), light(), g, radius);
        return estimate(1, 400, [&](const dvec3&, Rng& rng, double* out) {
            const PairSample p = *pairs.sample(rng);
            const dvec3 offset = camera().at(p.u) - light().at(p.v);
            const double w = glm::length(offset);
            const BallCone cone(offset / w, w, radius);
            out[0] = mean_phases(cone, light().direction, -camera().direction, g, rng) * cone.kernel() / p.pdf;
        });
    }
    void expect_same() const {
        const double truth = by_quadrature();
        for (const Estimate& pairs : {by_pairs<PairDensity>(), by_pairs<TabulatedPairs>()}) {
            EXPECT_NEAR(pairs.mean[0], truth, kSigmas * pairs.error[0] + 1e-5 * truth)
                << height << " apart, g " << g << ", radius " << radius << (opposite ? ", opposite" : "");
            EXPECT_LT(pairs.error[0], 0.05 * truth) << height << " apart, g " << g << (opposite ? ", opposite" : "");
        }
    }
};

TEST(Extremes, ParallelRaysMeetTheirIntegral) {
    for (const bool opposite : {false, true})
        for (const double height : {1.0, 0.01, 1e-4})
            for (const double g : {0.0, 0.7, -0.7, 0.999, -0.999})
                Parallel{height, 1.0, g, 0.0, opposite}.expect_same();
    // A blur over directions has no such integral but where they count alike.
    for (const double height : {1.0, 0.01})
        for (const double radius : {0.001, 0.1, 3.0})
            Parallel{height, 1.0, 0.0, radius, false}.expect_same();
}

// Of thin lights on the camera's own ray the integral is infinite, and no sample is; with a radius it is as it should.
TEST(Extremes, TheCameraLooksAlongALight) {
    for (const bool opposite : {false, true}) {
        for (const double radius : {0.001, 0.1})
            Parallel{0.0, 1.0, 0.0, radius, opposite}.expect_same();
        for (const double g : {0.0, 0.9, -0.999})
            for (const double radius : {0.0, 0.1}) {
                const Parallel same{0.0, 1.0, g, radius, opposite};
                const PairDensity pairs(same.camera(), same.light(), g, radius);
                Rng rng(Stream::Points, 45);
                for (int i = 0; i < 10'000; ++i) {
                    const auto p = pairs.sample(rng);
                    ASSERT_TRUE(p && p->pdf > 0.0 && std::isfinite(p->pdf)) << g << ", radius " << radius;
                }
            }
    }
    const Stage stage(coloured_ball(8, 2.0f, 0.6f), {});
    for (const double radius : {0.0, 0.1}) {
        RayLightSettings settings = of_paths(40);
        settings.radius = radius;
        const RayLights lights = stage.lights(settings, 8, 3);
        Rng rng(Stream::Points, 46);
        for (const RayLight& light : lights.lights())
            for (const double sign : {1.0, -1.0}) {
                const Ray ray{light.segment.at(-sign * 3.0), sign * light.segment.direction};
                EXPECT_TRUE(finite(stage.by_lights(lights, ray, rng).medium));
            }
    }
}

// Rays that cross, or meet end to end, have an integral over both that is finite.
TEST(Extremes, CrossingRays) {
    const Segment camera{{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 2.0};
    for (const dvec3& start : {dvec3(0.3, -0.5, 0.0), dvec3(0.3, 0.0, 0.0), dvec3(1.0, 0.0, 0.0)})
        for (const double g : {0.0, 0.9, -0.999}) {
            const Segment light{start, {0.0, 1.0, 0.0}, 1.0};
            const auto mean = [&](double radius) {
                const PairDensity pairs(camera, light, g, radius);
                return estimate(1, 100, [&](const dvec3&, Rng& rng, double* out) {
                    const PairSample p = *pairs.sample(rng);
                    const dvec3 offset = camera.at(p.u) - light.at(p.v);
                    const double w = std::max(glm::length(offset), 1e-300);
                    const BallCone cone(offset / w, w, radius);
                    out[0] = mean_phases(cone, light.direction, -camera.direction, g, rng) * cone.kernel() / p.pdf;
                });
            };
            for (const double radius : {0.0, 0.05}) {
                const Estimate e = mean(radius);
                EXPECT_TRUE(std::isfinite(e.mean[0]) && std::isfinite(e.error[0])) << g << ", radius " << radius;
                EXPECT_GT(e.mean[0], 0.0);
            }
        }
}

TEST(Extremes, AMillionOpticalDepths) {
    for (const float depth : {1e3f, 1e6f}) {
        const Stage stage(coloured_ball(4, depth, 0.5f), floor_below(0.7f), {lamp({1.5, 0.7, 1.1}, 30.0f)});
        expect_finite(stage, of_paths(40), some_rays(stage, 6), "dense smoke");
    }
    const Stage dense(coloured_ball(4, 20.0f, 0.0f), {}, {lamp({1.5, 0.7, 1.1}, 30.0f)});
    RayLightSettings many = of_paths();
    many.samples = 8;
    expect_same_light(dense, many, "optical depth 40", mean_by_paths(dense, 50), 2);
}

TEST(Extremes, AlmostStraightScattering) {
    for (const float g : {0.999f, -0.999f}) {
        const Stage stage(coloured_ball(8, 2.0f, g), floor_below(0.7f), {lamp({1.5, 0.7, 1.1}, 30.0f)});
        expect_finite(stage, of_paths(20), some_rays(stage, 30), "sharp");
    }
}

Recipe no_fire(Recipe recipe) {
    recipe.flame = {};
    return recipe;
}

TEST(Extremes, ALampOutsideTheSmoke) {
    const Stage stage(no_fire(lumpy_ball(8, 3.0f, 0.0f)), floor_below(0.7f), {lamp({3.0, 2.0, 4.0}, 300.0f)});
    expect_same_light(stage, of_paths(2000), "lamp outside", mean_by_paths(stage, kPathsOverFloor));
}

// Haze in which camera, lamp and walls stand.
Recipe haze(float extinction, float mean_cosine) {
    Recipe r;
    r.box = media::cube(-12, 12);
    r.world_from_index = media::cubic(0.5);
    r.density = [=](const ivec3&) { return extinction; };
    r.settings = black_smoke();
    r.settings.smoke.albedo = Rgb(0.9f);
    r.settings.smoke.mean_cosine = mean_cosine;
    return r;
}

TEST(Extremes, SmokeAroundCameraLampAndWalls) {
    Scene room;
    add_box(room, {-4, -4, -1.2f}, {4, 4, 3.5f}, lambert(0.5f), true);
    const Stage stage(haze(0.15f, 0.3f), std::move(room), {lamp({1.5, 0.7, 1.1}, 30.0f)});
    expect_same_light(stage, of_paths(300), "room of haze", mean_by_paths(stage, 100));
}

TEST(Extremes, NoSmokeHasNoLights) {
    const Stage stage(no_fire(coloured_ball(4, 0.0f, 0.0f)), floor_below(0.7f), {lamp({1.5, 0.7, 1.1}, 30.0f)});
    for (const double radius : {0.0, kAutomaticRadius}) {
        RayLightSettings settings = of_paths(100);
        settings.radius = radius;
        const RayLights lights = stage.lights(settings, 8, 3);
        EXPECT_TRUE(lights.lights().empty());
        EXPECT_EQ(lights.radius(), 0.0);
    }
    expect_finite(stage, of_paths(100), some_rays(stage, 10), "no smoke");
}

}  // namespace
}  // namespace brisance
