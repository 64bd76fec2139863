// Passes, radii, keys, and independence of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/parallel.h"
#include "fixtures/ray_fixture.h"
#include "light_selection/progressive_radius.h"
#include "photon_density/estimators.h"
#include "photon_density/method.h"
#include "photon_density/photon_density.h"

namespace brisance {
namespace {

using namespace testing;

TEST(Passes, ShrinkTheBlurByItsDimensions) {
    for (const DensityEstimator estimator : kEstimators) {
        PhotonDensitySettings s;
        s.estimator = estimator;
        s.alpha = 0.7;
        const int k = blurred_dimensions(estimator);
        for (int i = 0; i < 20; ++i) {
            const double now = i == 0 ? 0.2 : settings_of_pass(s, i, 0.2).radius;
            EXPECT_NEAR(std::pow(settings_of_pass(s, i + 1, 0.2).radius / now, k), (i + 1.7) / (i + 2.0), 1e-12);
        }
        s.alpha = kFastestAlpha;
        EXPECT_NEAR(std::pow(settings_of_pass(s, 1, 0.2).radius / 0.2, k), (1.0 + 4.0 / (4.0 + k)) / 2.0, 1e-12);
        s.alpha = 1.0;
        EXPECT_DOUBLE_EQ(settings_of_pass(s, 50, 0.2).radius, 0.2);
        EXPECT_EQ(settings_of_pass(s, 50, 0.2).neighbours, s.neighbours);
    }
}

TEST(Passes, HaveSeedsOfTheirOwnAndSmallerDiscs) {
    PhotonDensitySettings s;
    s.seed = 5;
    s.neighbours = 100;
    EXPECT_EQ(settings_of_pass(s, 0, 0.2).seed, 5u);
    EXPECT_NE(settings_of_pass(s, 1, 0.2).seed, settings_of_pass(s, 2, 0.2).seed);
    EXPECT_EQ(settings_of_pass(s, 1, 0.2).neighbours, 83);
    EXPECT_EQ(settings_of_pass(s, 100'000, 0.2).neighbours, 4);
    s.neighbours = 2;
    EXPECT_EQ(settings_of_pass(s, 9, 0.2).neighbours, 2);
}

// One pass of many particles, or many passes of few: with the same radius the same mean.
TEST(Passes, MeanDoesNotDependOnTheirNumber) {
    const Stage stage(coloured_ball(8, 1.5f, 0.5f), {});
    for (const DensityEstimator estimator : kEstimators) {
        const Estimate e = estimate(2, 1, [&](const dvec3&, Rng& rng, double* out) {
            PhotonDensitySettings s;
            s.estimator = estimator;
            s.alpha = 1.0;
            out[0] = out[1] = 0.0;
            for (const int passes : {1, 8}) {
                s.seed = static_cast<std::uint32_t>(rng.next_double() * 0x1p31);
                s.paths = 1600 / passes;
                s.radius = 0.15;
                for (int pass = 0; pass < passes; ++pass) {
                    const PhotonDensity photons(stage.scene(), settings_of_pass(s, pass, 0.15), -1,
                                                dvec3(0.5, -3.0, 2.5));
                    for (int i = 0; i < 64 / passes; ++i)
                        out[passes > 1] += stage.by_lights(photons, stage.ray(rng), rng).medium.x / 64.0;
                }
            }
        });
        std::printf("one pass %.5g +- %.2g, eight %.5g +- %.2g\n", e.mean[0], e.error[0], e.mean[1], e.error[1]);
        EXPECT_NEAR(e.mean[0], e.mean[1], kSigmas * std::hypot(e.error[0], e.error[1]));
        EXPECT_LT(std::hypot(e.error[0], e.error[1]), 0.05 * e.mean[0]);
    }
}

// From few to many particles the automatic radius falls by the power of the blur's dimensions.
TEST(Passes, TheAutomaticRadiusKeepsTheNumberOfPhotonsAroundARay) {
    const Stage stage(coloured_ball(8, 2.0f, 0.0f), {});
    for (const DensityEstimator estimator : kEstimators) {
        PhotonDensitySettings s;
        s.estimator = estimator;
        const int count = estimator == DensityEstimator::BeamBeam ? 20'000 : 60'000;
        s.paths = count;
        const double few = PhotonDensity(stage.scene(), s, -1, dvec3(0.5, -3.0, 2.5)).radius();
        s.paths = 8 * count;
        const double many = PhotonDensity(stage.scene(), s, -1, dvec3(0.5, -3.0, 2.5)).radius();
        std::printf("radius %.4f m, %.4f m\n", few, many);
        EXPECT_LT(few, 0.28);
        EXPECT_NEAR(few / many / std::pow(8.0, 1.0 / blurred_dimensions(estimator)), 1.0, 0.05);
        s.paths = 1;
        EXPECT_LT(PhotonDensity(stage.scene(), s, -1, dvec3(0.5, -3.0, 2.5)).radius(), 0.3) << "however few there are";
    }
}

// However far a blur reaches: flights beyond the smoke end somewhere, and their pieces are as long as the radius.
TEST(PhotonDensity, ARadiusBeyondTheSceneTakesNoMoreMemory) {
    const Stage stage(coloured_ball(8, 2.0f, 0.0f), {});
    for (const DensityEstimator estimator : kEstimators) {
        PhotonDensitySettings s;
        s.estimator = estimator;
        s.paths = 3000;
        s.radius = 0.1;
        const std::uint64_t usual = PhotonDensity(stage.scene(), s, -1, dvec3(0.5, -3.0, 2.5)).bytes();
        for (const double radius : {1e-9, 1e3, 1e9}) {
            s.radius = radius;
            const PhotonDensity photons(stage.scene(), s, -1, dvec3(0.5, -3.0, 2.5));
            EXPECT_LE(photons.bytes(), 2 * usual) << radius;
            Rng rng(Stream::Points, 5);
            for (int i = 0; i < 20; ++i)
                EXPECT_TRUE(std::isfinite(stage.by_lights(photons, stage.ray(rng), rng).medium.x)) << radius;
        }
    }
}

TEST(PhotonDensity, ThreadsChangeNothing) {
    const Stage stage(lumpy_ball(8, 2.0f, 0.5f), floor_below(0.7f));
    for (const DensityEstimator estimator : kEstimators) {
        const auto seen = [&](int threads) {
            const ThreadLimit limit(threads);
            PhotonDensitySettings s;
            s.estimator = estimator;
            s.paths = 3000;
            const PhotonDensity photons(stage.scene(), s, -1, dvec3(0.5, -3.0, 2.5));
            std::vector<float> all;
            Rng rng(Stream::Points, 5);
            for (int i = 0; i < 200; ++i) {
                const Twice t = stage.by_lights(photons, stage.ray(rng), rng);
                for (int c = 0; c < 3; ++c) {
                    all.push_back(t.medium[c]);
                    all.push_back(t.surface[c]);
                }
            }
            return all;
        };
        const std::vector<float> one = seen(1);
        EXPECT_GT(*std::max_element(one.begin(), one.end()), 0.0f);
        EXPECT_EQ(one, seen(2));
    }
}

bool takes(const std::string& name, const Json& value, PhotonDensitySettings& s) {
    for (const auto& key : PhotonDensityMethod::keys())
        if (key.name == name)
            return key.set(s, value);
    ADD_FAILURE() << name << " is no key";
    return false;
}

TEST(PhotonDensity, RefusesValuesThatMeanNothing) {
    PhotonDensitySettings s;
    const std::pair<const char*, Json> bad[] = {
        {"estimator", "beam"}, {"estimator", 1},  {"paths", 0},       {"paths", 1.5},
        {"radius", 0},         {"radius", -0.1},  {"radius", "none"}, {"radius", 1e-200},
        {"radius", 1e10},      {"passes", 0},     {"passes", 65537},  {"alpha", 0},
        {"alpha", 1.01},       {"alpha", "fast"}, {"neighbours", 0},  {"seed", -1}};
    for (const auto& [name, value] : bad)
        EXPECT_FALSE(takes(name, value, s)) << name << " = " << value.dump();
    EXPECT_TRUE(takes("radius", 0.25, s));
    EXPECT_EQ(s.radius, 0.25);
    EXPECT_TRUE(takes("radius", "auto", s));
    EXPECT_EQ(s.radius, kAutomaticBlur);
    EXPECT_TRUE(takes("alpha", 1, s));
    EXPECT_TRUE(takes("estimator", "point_beam", s));
    EXPECT_EQ(s.estimator, DensityEstimator::PointBeam);
}

}  // namespace
}  // namespace brisance
