// Hot soot emits by Planck's law, and fire has no edge at its threshold.
#include <gtest/gtest.h>

#include <cmath>

#include "medium/emission.h"

namespace brisance {
namespace {

// The CIE 1931 y-bar at 380, 390 ... 780 nm, as published: the code's own observer is a fit to it.
constexpr double kYBar[] = {0.000039, 0.000120, 0.000396, 0.001210, 0.004000, 0.011600, 0.023000, 0.038000, 0.060000,
                            0.090980, 0.139020, 0.208020, 0.323000, 0.503000, 0.710000, 0.862000, 0.954000, 0.994950,
                            0.995000, 0.952000, 0.870000, 0.757000, 0.631000, 0.503000, 0.381000, 0.265000, 0.175000,
                            0.107000, 0.061000, 0.032000, 0.017000, 0.008210, 0.004102, 0.002091, 0.001047, 0.000520,
                            0.000249, 0.000120, 0.000060, 0.000030, 0.000015};

double planck(double metres, double kelvin) {  // [W/(m^2 sr m)]
    const double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23;
    return 2.0 * h * c * c / std::pow(metres, 5.0) / std::expm1(h * c / (metres * k * kelvin));
}

double seen(double kelvin) {  // integral of B y-bar [W/(m^2 sr)]
    double sum = 0.0;
    for (int i = 0; i < 41; ++i)
        sum += kYBar[i] * planck((380.0 + 10.0 * i) * 1e-9, kelvin) * 10e-9;
    return sum;
}

double seen_of_white() {
    double sum = 0.0;
    for (const double y : kYBar)
        sum += y * 10e-9;
    return sum;
}

TEST(Blackbody, LuminanceIsPlancksLawSeenByTheStandardObserver) {
    const Blackbody blackbody(BlackbodyScale::Absolute);
    for (const double kelvin : {2000.0, 2500.0, 3000.0, 5000.0, 6504.0, 1e4, 1e5, 9e5})
        EXPECT_NEAR(luminance(blackbody.radiance(kelvin)) / seen(kelvin), 1.0, 0.015) << kelvin << " K";
}

TEST(Blackbody, TwoTemperaturesDifferAsPlanckSays) {
    const Blackbody blackbody(BlackbodyScale::Absolute);
    const double ratio = luminance(blackbody.radiance(4000.0f)) / luminance(blackbody.radiance(2000.0f));
    EXPECT_NEAR(ratio / (seen(4000.0) / seen(2000.0)), 1.0, 0.01);
    // Far above the visible photon energies radiance is proportional to temperature (Rayleigh and Jeans).
    EXPECT_NEAR(luminance(blackbody.radiance(9e5f)) / luminance(blackbody.radiance(4.5e5f)), 2.0, 0.05);
}

TEST(Blackbody, NormalizedHasASpectralPeakOfOne) {
    const Blackbody blackbody(BlackbodyScale::Normalized);
    for (const double kelvin : {2000.0, 3000.0, 5200.0, 1e4}) {
        const double peak = planck(2.897771955e-3 / kelvin, kelvin);
        EXPECT_NEAR(luminance(blackbody.radiance(kelvin)) / (seen(kelvin) / (peak * seen_of_white())), 1.0, 0.015);
        EXPECT_LT(luminance(blackbody.radiance(kelvin)), 1.0f);
    }
}

TEST(Blackbody, HotterIsBrighter) {
    const Blackbody blackbody(BlackbodyScale::Absolute);
    float before = -1.0f;
    for (double kelvin = 40.0; kelvin < 1.1e6; kelvin *= 1.05) {
        const float now = luminance(blackbody.radiance(static_cast<float>(kelvin)));
        ASSERT_TRUE(std::isfinite(now));
        ASSERT_GE(now, before) << kelvin << " K";
        if (kelvin > 600.0 && kelvin < 9e5) {
            ASSERT_GT(now, before) << kelvin << " K";
        }
        before = now;
    }
}

TEST(Blackbody, GlowsRedThenWhiteThenBlue) {
    const Blackbody blackbody(BlackbodyScale::Absolute);
    for (const float kelvin : {900.0f, 1500.0f, 3000.0f, 5000.0f}) {
        const Rgb c = blackbody.radiance(kelvin);
        EXPECT_GT(c.x, c.y) << kelvin;
        EXPECT_GE(c.y, c.z) << kelvin;
        EXPECT_GE(c.z, 0.0f);
    }
    const Rgb white = blackbody.radiance(6504.0f);
    EXPECT_NEAR(white.x / white.y, 1.0f, 0.1f);
    EXPECT_NEAR(white.z / white.y, 1.0f, 0.1f);
    const Rgb blue = blackbody.radiance(20000.0f);
    EXPECT_GT(blue.z, blue.x);
}

TEST(Blackbody, IsSmoothInTemperature) {
    const Blackbody blackbody(BlackbodyScale::Absolute);
    for (double kelvin = 800.0; kelvin < 8000.0; kelvin *= 1.003) {
        const double a = luminance(blackbody.radiance(kelvin)), b = luminance(blackbody.radiance(kelvin * 1.0005));
        ASSERT_NEAR(b / a, 1.0, 0.02) << kelvin;  // Wien: d ln L / d ln T is about 31 at 800 K
    }
}

TEST(Blackbody, ColdIsBlack) {
    const Blackbody blackbody(BlackbodyScale::Absolute);
    EXPECT_EQ(blackbody.radiance(0.0f), Rgb(0.0f));
    EXPECT_EQ(blackbody.radiance(-100.0f), Rgb(0.0f));
    EXPECT_LT(luminance(blackbody.radiance(293.0f)), 1e-20f);
    EXPECT_EQ(blackbody.radiance(std::nanf("")), Rgb(0.0f));
}

FireSettings soot(FireModel model, float threshold) {
    FireSettings fire;
    fire.model = model;
    fire.threshold = threshold;
    fire.temperature_in = {0.0f, 1.0f};
    fire.temperature_kelvin = {1000.0f, 5000.0f};  // colours in gamut from the threshold on
    return fire;
}

TEST(Source, IsZeroUpToItsThresholdAndRisesFromThere) {
    for (const FireModel model : {FireModel::Flame, FireModel::Blackbody, FireModel::NormalizedBlackbody}) {
        const SourceRadiance source(soot(model, 0.5f));
        const auto at = [&](float v) { return source({v, v, Rgb(1.0f)}); };
        const Rgb bright = at(1.0f);
        EXPECT_EQ(at(0.2f), Rgb(0.0f));
        EXPECT_EQ(at(0.5f), Rgb(0.0f));
        for (int c = 0; c < 3; ++c) {
            EXPECT_GT(at(0.51f)[c], 0.0f);
            EXPECT_LT(at(0.5001f)[c], 1e-2f * bright[c]);
        }
    }
}

TEST(Source, GridValuesStandForTheTemperaturesTheShotSays) {
    FireSettings fire = soot(FireModel::Blackbody, 0.0f);
    fire.temperature_in = {2.0f, 4.0f};
    fire.strength = 3.0f;
    const Rgb here = SourceRadiance(fire)({3.0f, 0.0f, Rgb(1.0f)});
    const Rgb planck_here = 3.0f * Blackbody(BlackbodyScale::Absolute).radiance(3000.0f);
    EXPECT_NEAR(here.x / planck_here.x, 1.0f, 1e-5f);
    EXPECT_EQ(SourceRadiance(fire)({-9.0f, 0.0f, Rgb(1.0f)}), Rgb(0.0f)) << "below absolute zero";
}

TEST(Source, IsProportionalToStrengthAndTint) {
    FireSettings fire = soot(FireModel::Flame, 0.0f);
    fire.strength = 2.0f;
    fire.colour = Rgb(1.0f, 0.5f, 0.25f);
    const Rgb source = SourceRadiance(fire)({0.0f, 3.0f, Rgb(1.0f, 1.0f, 2.0f)});
    EXPECT_EQ(source, Rgb(6.0f, 3.0f, 3.0f));
}

TEST(Source, FlamesModulateHeatWhereAsked) {
    FireSettings fire = soot(FireModel::Blackbody, 0.0f);
    fire.modulate_by_flame = true;
    const SourceRadiance source(fire);
    EXPECT_EQ(source({1.0f, 0.0f, Rgb(1.0f)}), Rgb(0.0f));
    EXPECT_EQ(source({1.0f, -2.0f, Rgb(1.0f)}), Rgb(0.0f));
    EXPECT_NEAR(source({1.0f, 2.0f, Rgb(1.0f)}).x / source({1.0f, 1.0f, Rgb(1.0f)}).x, 2.0f, 1e-6f);
}

TEST(Source, NoneIsDark) {
    EXPECT_EQ(SourceRadiance(soot(FireModel::None, 0.0f))({9.0f, 9.0f, Rgb(1.0f)}), Rgb(0.0f));
}

TEST(Ramp, IsLinearBetweenStopsAndConstantBeyond) {
    const std::vector<RampStop> ramp = {
        {1.0f, Rgb(1.0f, 0.0f, 0.0f)}, {3.0f, Rgb(0.0f, 1.0f, 0.0f)}, {4.0f, Rgb(2.0f)}};
    EXPECT_EQ(ramp_colour(ramp, -5.0f), Rgb(1.0f, 0.0f, 0.0f));
    EXPECT_EQ(ramp_colour(ramp, 1.0f), Rgb(1.0f, 0.0f, 0.0f));
    EXPECT_EQ(ramp_colour(ramp, 1.5f), Rgb(0.75f, 0.25f, 0.0f));
    EXPECT_EQ(ramp_colour(ramp, 3.0f), Rgb(0.0f, 1.0f, 0.0f));
    EXPECT_EQ(ramp_colour(ramp, 9.0f), Rgb(2.0f));
    EXPECT_EQ(ramp_colour({}, 0.3f), Rgb(1.0f));
}

TEST(Ramp, AStepOfTwoStopsAtOneValueIsAStep) {
    const std::vector<RampStop> ramp = {{0.0f, Rgb(0.0f)}, {1.0f, Rgb(0.0f)}, {1.0f, Rgb(1.0f)}, {2.0f, Rgb(1.0f)}};
    EXPECT_EQ(ramp_colour(ramp, 0.999f), Rgb(0.0f));
    EXPECT_EQ(ramp_colour(ramp, 1.0f), Rgb(1.0f));
    EXPECT_EQ(ramp_colour(ramp, 1.001f), Rgb(1.0f));
}

}  // namespace
}  // namespace brisance
