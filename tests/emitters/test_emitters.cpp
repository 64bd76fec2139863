// Emitters other than fire: the light that arrives at a point, by sampling lights, by sampling directions, and by
// closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "emitters/surroundings.h"
#include "fixtures/estimate.h"
#include "fixtures/sets.h"

namespace brisance {
namespace {

using namespace testing;

LightSettings lamp(LightKind kind, const dvec3& position, const dvec3& direction = {0, 0, -1}) {
    LightSettings light;
    light.kind = kind;
    light.position = position;
    light.direction = direction;
    light.power = Rgb(3.0f, 2.0f, 1.0f);
    return light;
}

// Irradiance on a surface at `p` facing up, red.
Estimate irradiance(const Surroundings& set, const dvec3& p, double relative) {
    const LitPoint point{p, {0, 0, 1}, LitPoint::Kind::Surface};
    return estimate_to(relative, 1, [&](const dvec3&, Rng& rng, double* out) {
        const auto s = set.emitters().sample(point, rng);
        const bool seen =
            s && s->direction.z > 0.0 && !set.intersector().occluded({p, s->direction}, s->distance * (1 - 1e-6));
        out[0] = seen ? s->weight.x * s->direction.z : 0.0;
    });
}

// Light of a lamp falls off with the square of the distance.
TEST(Emitters, PointLightsFollowTheInverseSquare) {
    const Surroundings set(Scene{}, {lamp(LightKind::Point, {0, 0, 2})});
    const Estimate e = irradiance(set, {1, 0, 0}, 1e-3);
    EXPECT_NEAR(e.mean[0], 3.0 * 2.0 / std::pow(5.0, 1.5), 1e-6);
}

TEST(Emitters, SpotsShineInTheirConeOnly) {
    LightSettings light = lamp(LightKind::Spot, {0, 0, 1});
    light.inner_degrees = 20.0;
    light.outer_degrees = 40.0;
    const Surroundings set(Scene{}, {light});
    const auto at = [&](double degrees) {
        const double t = std::tan(degrees * kPi64 / 180.0);
        const Estimate e = irradiance(set, {t, 0, 0}, 1e-3);
        return e.mean[0] * std::pow(1.0 + t * t, 1.5);
    };
    EXPECT_NEAR(at(0.0), 3.0, 1e-6);
    EXPECT_NEAR(at(19.0), 3.0, 1e-6);
    EXPECT_GT(at(30.0), 0.1);
    EXPECT_LT(at(30.0), 2.9);
    EXPECT_EQ(at(41.0), 0.0);
}

// A sun's power is the irradiance on what faces it, whatever its size in the sky.
TEST(Emitters, SunsGiveTheirIrradianceWhateverTheirSize) {
    for (const double angle : {0.0, 0.5, 10.0, 90.0}) {
        LightSettings sun = lamp(LightKind::Sun, {}, {0, 0, -2});
        sun.angle_degrees = angle;
        const Surroundings set(Scene{}, {sun});
        const Estimate e = irradiance(set, {5, 5, 5}, 1e-3);
        EXPECT_NEAR(e.mean[0], 3.0, kSigmas * e.error[0] + 1e-5) << angle << " degrees";
        const Rgb seen = set.emitters().background({0, 0, 1});
        EXPECT_EQ(seen.x > 0.0f, angle > 0.0) << "what lights the set is seen in mirrors";
        EXPECT_EQ(set.emitters().background({1, 0, 0}), Rgb(0.0f));
    }
}

// The ceiling of a Lambert emitter: form factor of a parallel square above (Howell, A Catalog of Radiation Heat
// Transfer Configuration Factors, B-4), four quarters.
TEST(Emitters, QuadsHaveTheirFormFactor) {
    const double a = 1.5, h = 2.0, x = a / h;
    const double quarter = x / std::sqrt(1 + x * x) * std::atan(x / std::sqrt(1 + x * x)) / kPi64;
    const double truth = 7.0 * kPi64 * 4.0 * quarter;
    Scene scene;
    add_quad(scene, {-1.5f, 1.5f, 2}, {3, 0, 0}, {0, -3, 0}, emitting(Rgb(7.0f)));
    const Surroundings set(scene, {});
    const Estimate e = irradiance(set, {0, 0, 0}, 2e-3);
    EXPECT_NEAR(e.mean[0], truth, kSigmas * e.error[0]);
    const Estimate behind = irradiance(set, {0, 0, 3}, 1e-2);
    EXPECT_EQ(behind.mean[0], 0.0) << "its back is black";
}

// The same light by two sampling techniques: points on emitters, and directions that may hit them. Both densities must
// be right.
TEST(Emitters, DensitiesOfHitsAreThoseOfSampling) {
    Scene scene;
    add_ball(scene, {0, 0, 3}, 1.0f, 8, emitting(Rgb(2.0f)));
    add_quad(scene, {-4, -1, 1}, {0, 2, 0}, {0, 0, 2}, emitting(Rgb(1.0f), true));
    add_quad(scene, {-1, -1, 6}, {2, 0, 0}, {0, 2, 0}, emitting(Rgb(50.0f)));  // hidden by the ball
    LightSettings sky = lamp(LightKind::Environment, {});
    sky.power = Rgb(0.1f);
    const Surroundings set(scene, {sky});
    const LitPoint point{dvec3(0.2, 0.1, 0.0), {0, 0, 1}, LitPoint::Kind::Medium};
    const Estimate by_lights = estimate_to(3e-3, 1, [&](const dvec3&, Rng& rng, double* out) {
        const auto s = set.emitters().sample(point, rng);
        const bool seen = s && !set.intersector().occluded({point.position, s->direction}, s->distance * (1 - 1e-5));
        out[0] = seen ? s->weight.x : 0.0;
    });
    const Estimate by_directions = estimate_to(3e-3, 3, [&](const dvec3& u, Rng&, double* out) {
        const dvec3 d = uniform_direction(u.x, u.y);
        const auto hit = set.intersector().first_hit({point.position, d});
        const double density = 1.0 / (4.0 * kPi64);
        Rgb seen = set.emitters().background(d);
        double pdf = set.emitters().pdf_of_background(d);
        if (hit) {
            seen = surface_point(set.scene(), *hit, -d).emission;
            pdf = seen == Rgb(0.0f) ? 0.0 : set.emitters().pdf_of_hit(point, *hit, d, hit->distance);
        }
        out[0] = seen.x / density;
        out[1] = seen.x > 0.0f ? seen.x * pdf / (pdf + density) / density : 0.0;
        out[2] = pdf / density;
    });
    EXPECT_NEAR(by_lights.mean[0], by_directions.mean[0],
                kSigmas * std::hypot(by_lights.error[0], by_directions.error[0]));
    // Under the balance heuristic both together give the same.
    const Estimate balanced = estimate_to(3e-3, 1, [&](const dvec3&, Rng& rng, double* out) {
        const auto s = set.emitters().sample(point, rng);
        const bool seen = s && !set.intersector().occluded({point.position, s->direction}, s->distance * (1 - 1e-5));
        out[0] = seen ? s->weight.x * s->pdf / (s->pdf + 1.0 / (4.0 * kPi64)) : 0.0;
    });
    // What the sum lacks: directions weigh by their own density over both.
    const Estimate rest = estimate_to(3e-3, 1, [&](const dvec3& u, Rng&, double* out) {
        const dvec3 d = uniform_direction(u.x, u.y);
        const auto hit = set.intersector().first_hit({point.position, d});
        const double density = 1.0 / (4.0 * kPi64);
        const Rgb seen = hit ? surface_point(set.scene(), *hit, -d).emission : set.emitters().background(d);
        const double pdf =
            hit ? set.emitters().pdf_of_hit(point, *hit, d, hit->distance) : set.emitters().pdf_of_background(d);
        out[0] = seen.x / (density + pdf);
    });
    EXPECT_NEAR(balanced.mean[0] + rest.mean[0], by_directions.mean[0],
                kSigmas * std::hypot(balanced.error[0], rest.error[0], by_directions.error[0]));
}

// Particles carry the power that lights have: 4 pi I, pi L A, pi times the disc for a sky.
// Sampled lights and sampled directions, weighted by the balance heuristic, are all the light there is: also where a
// sun's disc stands before the sky.
TEST(Emitters, WeightsOfLightsThatOverlapSumToOne) {
    LightSettings sun = lamp(LightKind::Sun, {}, {0, 0, -1}), sky = lamp(LightKind::Environment, {});
    sun.angle_degrees = 90.0;
    sky.power = Rgb(0.8f);
    const Surroundings set(Scene{}, {sun, sky});
    const LitPoint point{{5, 5, 5}, {0, 0, 1}, LitPoint::Kind::Surface};
    const Estimate e = estimate_to(1e-3, 1, [&](const dvec3& numbers, Rng& rng, double* out) {
        out[0] = 0.0;
        if (const auto s = set.emitters().sample(point, rng); s && s->direction.z > 0.0)
            out[0] += s->weight.x * s->direction.z * s->pdf / (s->pdf + s->direction.z / kPi64);
        const double z = std::sqrt(1.0 - numbers.x), across = std::sqrt(numbers.x), turn = 2.0 * kPi64 * numbers.y;
        const dvec3 d(across * std::cos(turn), across * std::sin(turn), z);
        const double pdf = z / kPi64;
        out[0] += set.emitters().background(d).x * kPi64 * pdf / (pdf + set.emitters().pdf_of_background(d));
    });
    const double truth = 3.0 + kPi64 * 0.8;
    EXPECT_NEAR(e.mean[0], truth, kSigmas * e.error[0]);
    EXPECT_LT(e.error[0], 2e-3 * truth);
}

TEST(Emitters, ParticlesCarryThePower) {
    Scene scene;
    add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 3, 0}, emitting(Rgb(5.0f)));
    add_quad(scene, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, emitting(Rgb(1.0f), true));
    LightSettings spot = lamp(LightKind::Spot, {1, 1, 1});
    spot.inner_degrees = spot.outer_degrees = 60.0;
    LightSettings sky = lamp(LightKind::Environment, {});
    LightSettings sun = lamp(LightKind::Sun, {});
    sun.angle_degrees = 5.0;
    const Surroundings set(scene, {lamp(LightKind::Point, {1, 1, 1}), spot, sky, sun});
    const double radius = 4.0, disc = kPi64 * radius * radius;
    const double truth =
        4 * kPi64 * 3 + 2 * kPi64 * 0.5 * 3 + kPi64 * 5 * 6 + 2 * kPi64 * 1 + 4 * kPi64 * 3 * disc + 3 * disc;
    const Estimate e = estimate_to(2e-3, 1, [&](const dvec3&, Rng& rng, double* out) {
        const auto particle = set.emitters().emit(dvec3(0.0), radius, rng);
        out[0] = particle ? particle->power.x : 0.0;
    });
    EXPECT_NEAR(e.mean[0], truth, kSigmas * e.error[0] + 2e-3 * truth);
}

// A lamp hung in one to three slanted walls: light leaves it to both sides of each, and arrives from there, whatever
// way single precision rounds. Of rays within a thousandth of a wall's direction some meet it.
TEST(Emitters, LampsInThePlaneOfASurfaceKeepTheirLight) {
    const dvec3 position(0.37, 1.13, 2.71);
    const vec3 edges[4] = {{3.1f, 1.7f, 0.3f}, {-1.1f, 2.3f, 0.7f}, {0.2f, -0.3f, 1.9f}, {3.1f, 1.7f, 0.3f}};
    constexpr int kRays = 4000;
    for (int walls = 1; walls <= 3; ++walls) {
        Scene scene;
        for (int i = 0; i < walls; ++i)
            add_quad(scene, vec3(position) - 0.41f * edges[i] - 0.37f * edges[i + 1], edges[i], edges[i + 1],
                     lambert(0.5f));
        const Surroundings set(scene, {lamp(LightKind::Point, position)});
        Rng rng(Stream::Points, 7);
        int leaving = 0, arriving = 0;
        for (int i = 0; i < kRays; ++i) {
            const auto particle = set.emitters().emit(dvec3(0.0), 5.0, rng);
            ASSERT_TRUE(particle);
            leaving += set.intersector().occluded(particle->ray, 1e-3);
            const dvec3 from = position + 1e-3 * uniform_direction(rng.next_double(), rng.next_double());
            const auto s = set.emitters().sample({from, dvec3(0.0), LitPoint::Kind::Medium}, rng);
            ASSERT_TRUE(s);
            const dvec3 way = from - s->end;
            arriving += set.intersector().occluded({s->end, glm::normalize(way)}, 0.5 * glm::length(way));
        }
        EXPECT_LT(leaving, kRays / 200) << walls;
        EXPECT_LT(arriving, kRays / 200) << walls;
    }
    const Surroundings alone(Scene{}, {lamp(LightKind::Point, position)});
    Rng rng(Stream::Points, 7);
    EXPECT_EQ(alone.emitters().emit(dvec3(0.0), 5.0, rng)->ray.origin, position);
}

TEST(Emitters, DarkLightsAreNoLights) {
    LightSettings off = lamp(LightKind::Point, {1, 2, 3});
    off.power = Rgb(0.0f);
    const Surroundings set(Scene{}, {off});
    EXPECT_TRUE(set.emitters().empty());
    Rng rng(Stream::Points, 1);
    EXPECT_FALSE(set.emitters().sample({}, rng));
    EXPECT_FALSE(set.emitters().emit({}, 1.0, rng));
}

// A constant sky is even everywhere. Of a bright spot in it only the part up to some times the mean is; a sun with a
// disc is not, and one without lies in no background.
TEST(Emitters, BrightSpotsOfTheSkyAreNotEven) {
    LightSettings sky = lamp(LightKind::Environment, {});
    const Surroundings constant(Scene{}, {sky});
    EXPECT_TRUE(constant.emitters().has_even_background());
    EXPECT_EQ(constant.emitters().even_share(glm::normalize(dvec3(0.2, 0.5, 0.7))), 1.0f);

    LightSettings sun = lamp(LightKind::Sun, {});
    sun.angle_degrees = 1.0;
    const Surroundings only_sun(Scene{}, {sun});
    EXPECT_FALSE(only_sun.emitters().has_even_background());
    EXPECT_EQ(only_sun.emitters().even_share({0, 0, 1}), 0.0f);

    const Surroundings both(Scene{}, {sky, sun});
    const float mean = luminance(sky.power);
    EXPECT_EQ(both.emitters().even_share({1, 0, 0}), 1.0f);
    const float there = luminance(both.emitters().background({0, 0, 1})), share = both.emitters().even_share({0, 0, 1});
    EXPECT_GT(there, 100.0f * mean);
    EXPECT_LT(share * there, 8.0f * mean);
    EXPECT_GT(share * there, mean);
}

}  // namespace
}  // namespace brisance
