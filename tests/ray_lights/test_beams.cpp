// Virtual beam lights: the energy that their blur conserves, its bias, and the noise that it removes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "fixtures/ray_fixture.h"
#include "light_selection/joint_sampling.h"
#include "light_selection/progressive_radius.h"

namespace brisance {
namespace {

using namespace testing;

const dvec3 kUp(0.0, 0.0, 1.0);

double kernel_at(double distance, double radius) {
    return BallCone(kUp, distance, radius).kernel();
}

// The integral over [0, infinity) of a function that is smooth in the logarithm of its argument [in radii].
template <class Function>
double over_distances(const Function& f) {
    constexpr int kSteps = 40'000;
    const double low = std::log(1e-8), high = std::log(1e8), step = (high - low) / kSteps;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double w = std::exp(low + (i + 0.5) * step);
        sum += f(w) * w * step;
    }
    return sum;
}

TEST(Beams, FarAwayTheyShineAsRaysDo) {
    for (const double radius : {1e-6, 0.3, 4e5})
        for (const double far : {10.0, 100.0, 1e4, 1e9}) {
            const double w = far * radius;
            EXPECT_NEAR(kernel_at(w, radius) * w * w, 1.0, 0.26 / (far * far) + 1e-12) << far;
        }
    EXPECT_DOUBLE_EQ(kernel_at(0.7, 0.0), 1.0 / (0.7 * 0.7));
}

// What the ball lacks inside it has outside: over all space the blur moves energy and makes none.
TEST(Beams, KeepTheEnergy) {
    const double moved = over_distances([](double w) { return kernel_at(w, 1.0) * w * w - 1.0; });
    const double outside = over_distances([](double w) { return std::max(0.0, kernel_at(w, 1.0) * w * w - 1.0); });
    EXPECT_NEAR(moved, 0.0, 1e-3 * outside);
}

// In even smoke, light of a point that scatters alike all around: the bias of what arrives in all the smoke falls like
// r^2 (times a logarithm, from the tail of the kernel).
double bias(double radius) {  // [mean free paths]
    return radius * over_distances([&](double w) {
               return (kernel_at(w * radius, radius) * w * w * radius * radius - 1.0) * std::exp(-w * radius);
           });
}

TEST(Beams, BiasFallsLikeTheSquareOfTheRadius) {
    std::printf("radius in mean free paths  bias\n");
    for (const double r : {0.4, 0.2, 0.1, 0.05, 0.025})
        std::printf("%25g %+.4f\n", r, bias(r));
    for (const double r : {0.2, 0.1, 0.05}) {
        EXPECT_LT(bias(r), 0.0);
        EXPECT_GT(bias(r) / bias(0.5 * r), 3.0) << r;
        EXPECT_LT(bias(r) / bias(0.5 * r), 4.0) << r;
    }
}

TEST(Beams, DirectionsFillTheCone) {
    Rng rng(Stream::Points, 31);
    for (const double distance : {0.5, 1.0, 1.5, 10.0, 1e6}) {
        const dvec3 axis = uniform_direction(rng.next_double(), rng.next_double());
        const BallCone cone(axis, distance, 1.0);
        const double half = std::asin(std::min(1.0, 1.0 / distance));
        const double area = 4.0 * kPi64 * std::pow(std::sin(0.5 * half), 2);
        EXPECT_NEAR(cone.solid_angle() / area, 1.0, 1e-9);
        EXPECT_NEAR(cone.kernel() * kPi64 / area, 1.0, 1e-9);
        double mean = 0.0;
        constexpr int kSamples = 20'000;
        for (int i = 0; i < kSamples; ++i) {
            const dvec3 d = cone.sample(rng);
            EXPECT_NEAR(glm::length(d), 1.0, 1e-12);
            mean += 0.5 * glm::dot(d - axis, d - axis) / kSamples;
        }
        // 1 - cosine is uniform from 0 to its largest.
        const double largest = area / (2.0 * kPi64);
        EXPECT_NEAR(mean / largest, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / kSamples));
        EXPECT_TRUE(cone.holds(axis));
        EXPECT_FALSE(cone.holds(-axis));
    }
}

TEST(Beams, MeansOfPhasesAreThoseOfTheCone) {
    const dvec3 arriving = glm::normalize(dvec3(0.2, 0.1, 1.0)), leaving = glm::normalize(dvec3(0.3, -0.4, 1.0));
    for (const double g : {0.0, 0.5, -0.6, 0.95})
        for (const double distance : {0.5, 2.0, 6.0}) {
            const BallCone cone(kUp, distance, 1.0);
            const Estimate e = estimate(2, 400, [&](const dvec3&, Rng& rng, double* out) {
                out[0] = mean_phases(cone, arriving, leaving, g, rng);
                const dvec3 direction = cone.sample(rng);
                out[1] = phase_about(arriving, direction, g) * phase_about(direction, leaving, g);
            });
            EXPECT_NEAR(e.mean[0], e.mean[1], kSigmas * std::hypot(e.error[0], e.error[1]) + 1e-12 * e.mean[1])
                << g << " from " << distance;
            EXPECT_LE(e.error[0], e.error[1] + 1e-12 * e.mean[1]) << g << " from " << distance;
        }
}

// MM and SM of the path tracer, but for a bias that is about that of even smoke and goes away with the radius.
TEST(Beams, ComeToWhatPathsFindAsTheyShrink) {
    constexpr float kDepth = 3.0f;  // per metre
    const Stage stage(coloured_ball(8, kDepth, 0.3f), floor_below(0.7f));
    RayLightSettings settings;
    settings.paths = 600;
    const Estimate paths = mean_by_paths(stage, 150);
    double last = -1.0;
    for (const double radius : {0.2, 0.1, 0.05}) {
        settings.radius = radius;
        const std::string what = "beams of " + std::to_string(radius);
        const double expected = bias(kDepth * radius);
        const double found = expect_same_light(stage, settings, what.c_str(), paths, 1, 2.0 * std::abs(expected));
        std::printf("radius %g m, %g mean free paths: bias %+.3f, of even smoke %+.3f\n", radius, kDepth * radius,
                    found, expected);
        EXPECT_GT(found, last) << radius;
        last = found;
    }
}

// Of one estimate over its mean, for rays of a family.
template <class Estimator>
double relative_variance(int samples, const Estimator& one) {
    double sum = 0.0, square = 0.0;
    Rng rng(Stream::Points, 33);
    for (int i = 0; i < samples; ++i) {
        const double x = one(rng);
        sum += x / samples;
        square += x * x / samples;
    }
    return square / (sum * sum) - 1.0;
}

// The same particles, and as many samples.
void expect_less_noise(const Stage& stage, RayLightSettings settings, const char* what, double at_most,
                       const std::function<double(const RayLights&, Rng&)>& one) {
    double variance[2];
    for (const double radius : {0.0, kAutomaticRadius}) {
        settings.radius = radius;
        const RayLights lights = stage.lights(settings, 16, 1);
        variance[radius != 0.0] = relative_variance(40'000, [&](Rng& rng) { return one(lights, rng); });
        std::printf("%s, radius %.3g m: relative deviation of a sample %.3g\n", what, lights.radius(),
                    std::sqrt(variance[radius != 0.0]));
    }
    std::printf("%s: variance of rays over that of beams %.3g\n", what, variance[0] / variance[1]);
    EXPECT_LT(variance[1], at_most * variance[0]) << what;
}

TEST(Beams, TakeAwayNoiseOfSharpPhaseFunctions) {
    for (const float g : {0.8f, 0.95f}) {
        const Stage stage(coloured_ball(8, 3.0f, g), {});
        RayLightSettings settings;
        settings.paths = 2000;
        settings.samples = 1;
        expect_less_noise(stage, settings, g < 0.9f ? "g 0.8" : "g 0.95", 0.5, [&](const RayLights& lights, Rng& rng) {
            return stage.by_lights(lights, stage.ray(rng), rng).medium.x;
        });
    }
}

SurfacePoint on_floor(const SurfaceMaterial& material) {
    SurfacePoint p;
    p.position = dvec3(0.0);
    p.geometric_normal = kUp;
    p.frame = frame_around(kUp);
    p.material = material;
    return p;
}

SurfaceMaterial metal(float roughness) {
    SurfaceMaterial m = lambert(0.8f).surface;
    m.metallic = 1.0f;
    m.roughness = roughness;
    return m;
}

// Cones that lie above the floor, that it cuts, and the half space of a point inside the ball.
TEST(Beams, MeansOverSurfacesAreThoseOfTheFoldedCone) {
    const dvec3 viewer = glm::normalize(dvec3(1.0, 0.2, 1.0)), arriving = glm::normalize(dvec3(0.6, 0.1, -1.0));
    for (const float roughness : {0.3f, 1.0f})
        for (const double g : {0.0, 0.8})
            for (const dvec3& light : {dvec3(-1.0, 0.0, 1.0), dvec3(-2.0, -0.3, 0.4), dvec3(-0.3, 0.0, 0.2)}) {
                const SurfacePoint point = on_floor(metal(roughness));
                const Bsdf bsdf(point.material, point.frame);
                const BallCone cone(glm::normalize(light), glm::length(light), 1.0);
                const Estimate e = estimate(2, 100, [&](const dvec3&, Rng& rng, double* out) {
                    out[0] = mean_reflected(cone, arriving, g, point, bsdf, viewer, rng).x;
                    dvec3 to = cone.sample(rng);
                    to.z = std::abs(to.z);
                    out[1] = bsdf.evaluate(viewer, to).x * phase_about(arriving, -to, g);
                });
                EXPECT_NEAR(e.mean[0], e.mean[1], kSigmas * std::hypot(e.error[0], e.error[1]))
                    << roughness << ", " << g << ", " << light.z;
                EXPECT_LT(e.error[0], e.error[1]) << roughness << ", " << g << ", " << light.z;
            }
}

// A polished floor under smoke, seen so that it mirrors the smoke.
TEST(Beams, TakeAwayNoiseOfGlossySurfaces) {
    for (const float roughness : {0.05f, 0.15f}) {
        const Stage stage(coloured_ball(8, 1.0f, 0.0f), {});
        RayLightSettings settings;
        settings.paths = 2000;
        settings.samples = 1;
        const SurfaceMaterial material = metal(roughness);
        expect_less_noise(stage, settings, roughness < 0.1f ? "roughness 0.05" : "roughness 0.15", 0.8,
                          [&](const RayLights& lights, Rng& rng) {
                              SurfacePoint point = on_floor(material);
                              point.position = {rng.next_double() - 0.5, rng.next_double() - 2.5, -1.3};
                              const dvec3 viewer = glm::normalize(dvec3(0.0, -1.0, 0.65));
                              const Bsdf bsdf(point.material, point.frame);
                              return double(lights.at_surface(point, bsdf, viewer, rng).x);
                          });
    }
}

// Of one light's estimate at a point of the floor; the tree chooses the light.
double spread_on_floor(float mean_cosine, const SurfaceMaterial& material, double radius) {
    const Stage stage(coloured_ball(8, 1.0f, mean_cosine), {});
    RayLightSettings settings;
    settings.paths = 2000;
    settings.samples = 1;
    settings.radius = radius;
    const RayLights lights = stage.lights(settings, 16, 1);
    const double variance = relative_variance(100'000, [&](Rng& rng) {
        SurfacePoint point = on_floor(material);
        point.position = {rng.next_double() - 0.5, rng.next_double() - 2.5, -1.3};
        const dvec3 viewer = glm::normalize(dvec3(0.0, -1.0, 0.65));
        return double(lights.at_surface(point, Bsdf(point.material, point.frame), viewer, rng).x);
    });
    std::printf("radius %g m, g %g, roughness %g: relative variance %.4g\n", radius, mean_cosine, material.roughness,
                variance);
    return variance;
}

// However sharp a lobe or a phase function is: what a ray shows at a surface grows with its peak, what a beam shows
// ends at the mean over its cone.
TEST(Beams, HaveABoundedVarianceAtSurfaces) {
    constexpr double kRadius = 0.1;
    EXPECT_GT(spread_on_floor(0.0f, metal(0.05f), 0.0), 10.0 * spread_on_floor(0.0f, metal(0.15f), 0.0));
    const double glossy = spread_on_floor(0.0f, metal(0.05f), kRadius);
    for (const float sharper : {0.02f, 0.0101f})
        EXPECT_LT(spread_on_floor(0.0f, metal(sharper), kRadius), 1.5 * glossy) << sharper;
    const SurfaceMaterial plain = lambert(0.8f).surface;
    EXPECT_GT(spread_on_floor(0.99f, plain, 0.0), 10.0 * spread_on_floor(0.9f, plain, 0.0));
    const double peaked = spread_on_floor(0.99f, plain, kRadius);
    for (const float sharper : {0.999f, 0.9999f})
        EXPECT_LT(spread_on_floor(sharper, plain, kRadius), 2.0 * peaked) << sharper;
}

// A floor takes half of what a point above it radiates, also where it cuts the ball.
TEST(Beams, AFloorTakesWhatShinesOnIt) {
    for (const double height : {0.05, 0.5, 1.0, 3.0}) {
        const SurfacePoint point = on_floor(lambert(1.0f).surface);
        const Bsdf bsdf(point.material, point.frame);
        const Estimate e = estimate(1, 400, [&](const dvec3& u, Rng& rng, double* out) {
            // A point on the floor, by the density h / (2 (h^2 + s^2)^(3/2)) of 2 pi s ds.
            const double h = std::max(height, 0.5), z = std::max(1e-9, 1.0 - u.x);
            const double s = h * std::sqrt(1.0 / (z * z) - 1.0), density = h / std::pow(h * h + s * s, 1.5);
            const BallCone cone(glm::normalize(dvec3(s, 0.0, height)), std::hypot(s, height), 1.0);
            const Rgb radiance = mean_reflected(cone, kUp, 0.0, point, bsdf, kUp, rng);
            out[0] = 4.0 * kPi64 * radiance.x * kPi64 * cone.kernel() / density;  // irradiance of one watt per sr
        });
        EXPECT_NEAR(e.mean[0], 1.0, kSigmas * e.error[0]) << height;
        EXPECT_LT(e.error[0], 0.01);
    }
}

TEST(Beams, RadiiFollowTheRule) {
    for (const double alpha : {0.1, 0.7, 0.99}) {
        EXPECT_DOUBLE_EQ(radius_shrunk(0, alpha), 1.0);
        for (int i = 1; i < 50; ++i)
            EXPECT_NEAR(std::pow(radius_shrunk(i, alpha), 2),
                        std::pow(radius_shrunk(i - 1, alpha), 2) * (i + alpha) / (i + 1.0), 1e-12);
        // Like n^((alpha - 1) / 2) in the end.
        EXPECT_NEAR(radius_shrunk(4000, alpha) / radius_shrunk(1000, alpha), std::pow(4.0, 0.5 * (alpha - 1.0)), 1e-3);
    }
}

TEST(Beams, PassesHaveSeedsOfTheirOwn) {
    RayLightSettings s;
    s.seed = 5;
    s.radius = 0.3;
    EXPECT_EQ(settings_of_pass(s, 0, 0.2).seed, 5u);
    EXPECT_EQ(settings_of_pass(s, 0, 0.2).radius, 0.3);
    EXPECT_NE(settings_of_pass(s, 1, 0.2).seed, settings_of_pass(s, 2, 0.2).seed);
    RayLightSettings next = s;
    next.seed = 6;
    EXPECT_NE(settings_of_pass(s, 1, 0.2).seed, settings_of_pass(next, 0, 0.2).seed);
    EXPECT_DOUBLE_EQ(settings_of_pass(s, 3, 0.2).radius, 0.2 * radius_shrunk(3, s.radius_reduction));
    EXPECT_EQ(settings_of_pass(s, 3, 0.0).radius, 0.0);
}

TEST(Beams, TheAutomaticRadiusIsAPartOfHowFarLightsAreApart) {
    const Stage stage(coloured_ball(8, 2.0f, 0.0f), {});
    RayLightSettings s;
    s.radius = kAutomaticRadius;
    s.paths = 400;
    const double few = stage.lights(s, 4, 1).radius();
    s.paths = 6400;
    const double many = stage.lights(s, 4, 1).radius();
    EXPECT_GT(few, 0.01);
    EXPECT_LT(few, 1.0);
    EXPECT_NEAR(few / many, 4.0, 0.4);
}

}  // namespace
}  // namespace brisance
