// The mean escape probability against closed forms, and on other lattices.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/parallel.h"
#include "fixtures/media.h"
#include "forecast/mean_escape.h"

namespace brisance {
namespace {

using namespace testing;

constexpr double kError = 0.01;     // as stated in mean_escape.h
constexpr double kOfVoxels = 0.01;  // relative: the rim of a ball of voxels

Recipe ball_of(int nodes, float extinction) {
    Recipe r;
    r.box = cube(-nodes - 1, nodes + 1);
    r.world_from_index = cubic(1.0 / nodes);
    r.density = [=](const ivec3& n) { return ball(n, dvec3(0.0), nodes); };
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = Rgb(0.8f, 0.5f, 0.2f);
    return r;
}

// Of a homogeneous ball of this optical radius (Case, de Hoffmann, Placzek, Introduction to the Theory of Neutron
// Diffusion I, 1953).
double escape_from_ball(double t) {
    return 3.0 / (8.0 * t * t * t) * (2.0 * t * t - 1.0 + (1.0 + 2.0 * t) * std::exp(-2.0 * t));
}

TEST(MeanEscape, OfABallIsTheClosedForm) {
    for (const double depth : {0.05, 0.3, 1.0, 3.0, 10.0}) {
        const double escape = mean_escape(make_medium(ball_of(20, float(depth)))), truth = escape_from_ball(depth);
        std::printf("optical radius %g: %.4f, closed form %.4f\n", depth, escape, truth);
        EXPECT_NEAR(escape, truth, kError + kOfVoxels * truth) << depth;
    }
}

// Some of it hardly escapes, and some at once: light starts where it scatters, not where extinction is.
TEST(MeanEscape, CountsWhatScatters) {
    Recipe r = ball_of(8, 0.0f);
    EXPECT_EQ(mean_escape(make_medium(r)), 1.0);
    r = ball_of(8, 30.0f);
    r.settings.smoke.albedo = Rgb(0.0f);
    EXPECT_EQ(mean_escape(make_medium(r)), 1.0);
    r.settings.smoke.albedo = Rgb(0.9f);
    Recipe haze = ball_of(8, 0.01f);
    haze.settings.smoke.albedo = Rgb(0.9f);
    EXPECT_LT(mean_escape(make_medium(r)), 0.1);
    EXPECT_GT(mean_escape(make_medium(haze)), 0.95);
}

// Uneven smoke, with zeros around it.
float uneven(const ivec3& n) {
    return ball(n, dvec3(1.0, -2.0, 0.5), 7.0) * (0.2f + noise(n / 2, 1));
}

Medium lattice_of(const ivec3& low, const ivec3& high, int subdivided = 1) {
    Recipe r;
    r.box = {low * subdivided, high * subdivided};
    r.world_from_index = cubic(0.125 / subdivided);
    r.density = [=](const ivec3& n) {
        const dvec3 p = dvec3(n) / double(subdivided);
        const dvec3 base = glm::floor(p), part = p - base;
        double sum = 0.0;
        for (int k = 0; k < 8; ++k) {
            const ivec3 corner(k & 1, k >> 1 & 1, k >> 2);
            const dvec3 w = glm::mix(dvec3(1.0) - part, part, dvec3(corner));
            sum += w.x * w.y * w.z * uneven(ivec3(base) + corner);
        }
        return static_cast<float>(sum);
    };
    r.settings.smoke.extinction_per_metre = 3.0f;
    r.settings.smoke.albedo = Rgb(0.9f);
    return make_medium(r);
}

TEST(MeanEscape, IsTheSameWithEmptySpaceAndOnFinerVoxels) {
    const double tight = mean_escape(lattice_of(ivec3(-8, -10, -8), ivec3(9, 6, 9)));
    const double padded = mean_escape(lattice_of(ivec3(-40, -11, -30), ivec3(20, 50, 31)));
    const double finer = mean_escape(lattice_of(ivec3(-8, -10, -8), ivec3(9, 6, 9), 2));
    std::printf("tight %.4f, padded %.4f, voxels of half the edge %.4f\n", tight, padded, finer);
    EXPECT_GT(tight, 0.2);
    EXPECT_LT(tight, 0.8);
    EXPECT_NEAR(padded, tight, kError);
    EXPECT_NEAR(finer, tight, kError);
}

TEST(MeanEscape, ChangesLittleWithTheDensityAndNotWithThreads) {
    double before = 1.0;
    for (int k = 0; k < 12; ++k) {
        const Medium medium = make_medium(ball_of(8, std::pow(1.05f, float(k))));
        const double escape = mean_escape(medium);
        EXPECT_LT(escape, before);
        if (k > 0) {
            EXPECT_GT(escape, before - 0.03);  // 5 % of the density change the logarithm by as much at most
        }
        before = escape;
        const ThreadLimit limit(1);
        EXPECT_EQ(mean_escape(medium), escape);
    }
}

}  // namespace
}  // namespace brisance
