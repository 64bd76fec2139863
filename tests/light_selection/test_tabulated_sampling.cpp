// Tabulated densities over pairs of points on two rays: they integrate to one, samples follow them, and their estimates
// have the mean of quadrature and of the closed form, with less noise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "density_fixture.h"
#include "light_selection/tabulated_sampling.h"

namespace brisance {
namespace {

using namespace testing;

TEST(TabulatedSampling, TheMarginalIsADensity) {
    for (const Lines& l : many_lines())
        for (const double g : {0.0, 0.6, 0.9, -0.6})
            expect_density(TabulatedOnLight(l.camera, l.light, g, 0.0), l.light.length, closest(l.light, l.camera),
                           l.name);
}

TEST(TabulatedSampling, TheAngleIsADensityForEveryPhaseFunction) {
    for (const Lines& l : many_lines())
        for (const double g : {0.0, 0.6, 0.9, -0.6, 0.999}) {
            const TabulatedPairs pairs(l.camera, l.light, g);
            const double v = 0.37 * l.light.length, u = 0.37 * l.camera.length;
            expect_density(pairs.on_camera(v), l.camera.length, foot(l.camera, l.light.at(v)), l.name);
            expect_density(pairs.on_light(u), l.light.length, foot(l.light, l.camera.at(u)), l.name);
        }
}

TEST(TabulatedSampling, WhatIsDrawnHasThePdfThatIsTold) {
    for (const Lines& l : many_lines())
        for (const double g : {0.0, 0.9, -0.6, 0.999})
            for (const double radius : {0.0, 0.1 * l.light.length}) {
                const TabulatedPairs pairs(l.camera, l.light, g, radius);
                Rng rng(Stream::Points, 14);
                for (int i = 0; i < 100; ++i) {
                    const std::optional<PairSample> s = pairs.sample(rng);
                    ASSERT_TRUE(s);
                    EXPECT_TRUE(std::isfinite(s->pdf) && s->pdf > 0.0) << l.name;
                    EXPECT_NEAR(pairs.pdf(s->u, s->v) / s->pdf, 1.0, 1e-9) << l.name;
                }
            }
}

TEST(TabulatedSampling, RaysWithoutLengthHaveNoPairs) {
    const Segment ray{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1.0};
    const Segment none{{0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}, 0.0};
    Rng rng(Stream::Points, 15);
    for (const double g : {0.0, 0.3}) {
        EXPECT_FALSE(TabulatedPairs(ray, none, g).sample(rng));
        EXPECT_FALSE(TabulatedPairs(none, ray, g).sample(rng));
        EXPECT_FALSE(TabulatedPairs(none, none, g).sample(rng));
    }
}

TEST(TabulatedSampling, ARayOverItselfStaysFinite) {
    const Segment ray{{1.0, 2.0, 3.0}, unit(1.0, 2.0, -0.3), 2.0};
    for (const double g : {0.0, 0.9, -0.6}) {
        const TabulatedPairs pairs(ray, ray, g);
        Rng rng(Stream::Points, 16);
        for (int i = 0; i < 1000; ++i) {
            const std::optional<PairSample> s = pairs.sample(rng);
            ASSERT_TRUE(s);
            EXPECT_TRUE(std::isfinite(s->pdf) && s->pdf > 0.0);
        }
    }
}

// Two rays of length 2 in a medium of extinction 1, closest in their middles: how far apart, and at which angle.
Lines two_rays(double distance, double degrees) {
    const double a = degrees * kPi64 / 180.0;
    const dvec3 other(std::cos(a), std::sin(a), 0.0);
    return {"two rays", {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 2.0}, {dvec3(0.0, 0.0, distance) - other, other, 2.0}};
}

double integrand(const Lines& l, double g, double u, double v) {
    const dvec3 offset = l.camera.at(u) - l.light.at(v);
    const double w = glm::length(offset);
    return std::exp(-u - v - w) / (w * w) * phase_about(l.light.direction, offset / w, g) *
           phase_about(offset / w, -l.camera.direction, g);
}

// By the midpoint rule: over the camera's ray in the angle seen from v, along the light in asinh of the distance from
// the point in its middle, both of which smooth the peak of 1 / distance^2.
double by_quadrature(const Lines& l, double g, double distance) {
    constexpr int kSteps = 600;
    const double range = std::asinh(0.5 * l.light.length / distance);
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double s = range * (2.0 * (i + 0.5) / kSteps - 1.0);
        const double v = 0.5 * l.light.length + distance * std::sinh(s);
        const double before = -foot(l.camera, l.light.at(v));
        const double height = glm::length(l.light.at(v) - l.camera.at(-before));
        const double begin = std::atan(before / height), end = std::atan((before + l.camera.length) / height);
        double over_camera = 0.0;
        for (int k = 0; k < kSteps; ++k) {
            const double along = height * std::tan(begin + (end - begin) * (k + 0.5) / kSteps);
            over_camera += integrand(l, g, along - before, v) * (height * height + along * along) / height;
        }
        sum += over_camera * (end - begin) / kSteps * distance * std::cosh(s) * 2.0 * range / kSteps;
    }
    return sum;
}

template <class Pairs>
Estimate by_pairs(const Lines& l, double g, std::uint64_t per_batch) {
    const Pairs pairs(l.camera, l.light, g);
    return estimate(1, per_batch, [&](const dvec3&, Rng& rng, double* out) {
        const PairSample s = *pairs.sample(rng);
        out[0] = integrand(l, g, s.u, s.v) / s.pdf;
    });
}

TEST(TabulatedSampling, HasTheMeanOfQuadratureAndOfTheClosedForm) {
    for (const double distance : {0.3, 0.01})
        for (const double degrees : {90.0, 30.0, 0.0, 180.0})
            for (const double g : {0.0, 0.6, 0.9, -0.6}) {
                const Lines l = two_rays(distance, degrees);
                const double truth = by_quadrature(l, g, distance);
                const Estimate tables = by_pairs<TabulatedPairs>(l, g, 100), closed = by_pairs<PairDensity>(l, g, 400);
                EXPECT_NEAR(tables.mean[0], truth, kSigmas * tables.error[0] + 1e-3 * truth)
                    << distance << " apart, " << degrees << " degrees, g " << g;
                EXPECT_NEAR(tables.mean[0], closed.mean[0], kSigmas * std::hypot(tables.error[0], closed.error[0]))
                    << distance << " apart, " << degrees << " degrees, g " << g;
                EXPECT_LT(tables.error[0], 0.02 * truth) << distance << ", " << degrees << " degrees, g " << g;
            }
}

dvec3 random_direction(Rng& rng) {
    const double u = rng.next_double(), v = rng.next_double();
    return uniform_direction(u, v);
}

// Variance of one sample, summed over random pairs of segments in a cube.
template <class Pairs>
double summed_variance(double g) {
    double sum = 0.0;
    for (int pair = 0; pair < 60; ++pair) {
        Rng place(Stream::Points, 200 + pair), rng(Stream::Points, 300 + pair);
        const auto point = [&] {
            const double x = place.next_double(), y = place.next_double(), z = place.next_double();
            return dvec3(x, y, z);
        };
        Lines l{"random", {}, {}};
        l.camera.start = point();
        l.light.start = point();
        l.camera.direction = random_direction(place);
        l.light.direction = random_direction(place);
        l.camera.length = 0.5 + place.next_double();
        l.light.length = 0.1 + 0.4 * place.next_double();
        const Pairs pairs(l.camera, l.light, g);
        constexpr int kSamples = 1000;
        double first = 0.0, second = 0.0;
        for (int i = 0; i < kSamples; ++i) {
            const PairSample s = *pairs.sample(rng);
            const double e = integrand(l, g, s.u, s.v) / s.pdf;
            first += e / kSamples;
            second += e * e / kSamples;
        }
        sum += second - first * first;
    }
    return sum;
}

// They must repay their time.
TEST(TabulatedSampling, HasLessNoise) {
    for (const double g : {0.5, 0.8, 0.95}) {
        const double ratio = summed_variance<TabulatedPairs>(g) / summed_variance<PairDensity>(g);
        std::printf("g %4g: %.3f of the variance\n", g, ratio);
        EXPECT_LT(ratio, 0.25) << g;
    }
}

}  // namespace
}  // namespace brisance
