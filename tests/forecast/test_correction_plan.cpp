// What an error that is asked for means for the lights and for the samples that correct them.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "fixtures/media.h"
#include "forecast/correction_plan.h"

namespace brisance {
namespace {

using namespace testing;

struct Asked {
    Shot shot;
    Medium medium;
    Plan plan;
};

Asked asked(float error, const Recipe& ball = glowing_ball(8, 1.0f)) {
    Recipe r = ball;
    r.settings.smoke.albedo = Rgb(0.5f);
    Asked out;
    out.shot.lighting.error = error;
    out.medium = make_medium(r);
    out.plan = plan_cells(out.shot, out.medium);
    return out;
}

float lights_for(float error) {
    const Asked a = asked(error);
    return error_of_lights(a.shot, a.plan);
}

double most_for(float error) {
    const Asked a = asked(error);
    return most_of_correction(a.shot, a.plan);
}

double usual_for(float error) {
    const Asked a = asked(error);
    return usual_correction(a.shot, a.plan);
}

TEST(CorrectionPlan, LightsAreCoarserThanAskedAndNeverHopelesslyFine) {
    EXPECT_FLOAT_EQ(lights_for(0.05f), 0.05f);
    EXPECT_FLOAT_EQ(lights_for(0.02f), 0.02f);
    EXPECT_FLOAT_EQ(lights_for(0.015f), 0.02f);
    EXPECT_FLOAT_EQ(lights_for(0.008f), 0.016f);
    EXPECT_FLOAT_EQ(lights_for(0.0005f), 0.01f);
}

TEST(CorrectionPlan, SamplesTakeMoreTimeTheLessErrorIsAskedFor) {
    EXPECT_EQ(most_for(0.04f), 0.0);
    double before = 0.0;
    for (const float error : {0.039f, 0.03f, 0.02f, 0.017f, 0.015f, 0.01f, 0.007f}) {
        const double usual = usual_for(error);
        EXPECT_GT(usual, before) << error;
        EXPECT_LE(usual, most_for(error)) << error;
        before = usual;
    }
    EXPECT_EQ(usual_for(0.0001f), most_for(0.0001f));
}

// Of a small picture of a large fire, whose light is dearer than its camera; voxels have an optical depth of 0.6.
float lattice_for(float error, const std::function<void(Shot&)>& change = {}) {
    Asked a = asked(error, glowing_ball(40, 24.0f));
    a.shot.camera.eye = dvec3(0.0, -100.0, 0.0);
    a.shot.camera.up = dvec3(0.0, 0.0, 1.0);
    a.shot.camera.width = 160;
    a.shot.camera.height = 120;
    if (change)
        change(a.shot);
    return shot_of_lights(a.shot, a.plan, {a.medium, nullptr, a.shot.camera}).lighting.lattice_error;
}

// What samples find best may be coarse: three times as much beside them, and no more than they reach. It fades in.
TEST(CorrectionPlan, LatticesMayAddMoreBesideSamples) {
    EXPECT_FLOAT_EQ(lattice_for(0.02f), 0.03f);
    EXPECT_FLOAT_EQ(lattice_for(0.01f), 0.01f);  // most of the time is the samples' then
    EXPECT_LT(lattice_for(0.05f), 0.0f);         // as it is by default
    EXPECT_NEAR(lattice_for(0.0399f), 0.5f * 0.0399f, 2e-4f);
    EXPECT_NEAR(lattice_for(0.0201f), 0.03f, 2e-4f);
    EXPECT_FLOAT_EQ(lattice_for(0.02f, [](Shot& s) { s.lighting.lattice_error = 0.005f; }), 0.005f);
    EXPECT_LT(lattice_for(0.02f, [](Shot& s) { s.correction.samples = 0; }), 0.0f);
}

// Samples take longer in a large picture, of which wider lattices save as much. Lattices that are stated stay.
TEST(CorrectionPlan, LatticesAddMoreWhereThatSavesMoreThanSamplesTake) {
    const auto of_width = [](int width) {
        return lattice_for(0.02f, [&](Shot& s) {
            s.camera.width = width;
            s.camera.height = width * 3 / 4;
        });
    };
    float before = of_width(160);
    EXPECT_FLOAT_EQ(before, 0.03f);
    bool fades = false;
    for (int width = 200; width < 12000; width = width * 5 / 4) {
        const float error = of_width(width);
        EXPECT_LE(error, before) << width;
        fades = fades || (error > 0.0101f && error < 0.0299f);
        before = error;
    }
    EXPECT_FLOAT_EQ(before, 0.01f);
    EXPECT_TRUE(fades);
    EXPECT_LT(lattice_for(0.02f, [](Shot& s) { s.lighting.lattice_level = s.lighting.smoke_lattice_level = 0; }), 0.0f);
}

TEST(CorrectionPlan, BaselinesHaveNoSamples) {
    for (const auto& change : std::vector<std::function<void(Shot&)>>{
             [](Shot& s) { s.lighting.clusters = 4; }, [](Shot& s) { s.lighting.shadows = ShadowMethod::Exact; },
             [](Shot& s) { s.virtual_lights.kind = "point"; }, [](Shot& s) { s.virtual_lights.sampling = "power"; }}) {
        Asked a = asked(0.02f);
        EXPECT_GT(most_of_correction(a.shot, a.plan), 0.0);
        change(a.shot);
        EXPECT_EQ(most_of_correction(a.shot, a.plan), 0.0);
    }
}

// A number of samples that the shot states leaves its lights as they are.
TEST(CorrectionPlan, StatedSamplesChangeNoLights) {
    Asked a = asked(0.01f);
    a.shot.correction.samples = 5000;
    EXPECT_FLOAT_EQ(error_of_lights(a.shot, a.plan), 0.01f);
    EXPECT_EQ(most_of_correction(a.shot, a.plan), 0.0);
}

}  // namespace
}  // namespace brisance
