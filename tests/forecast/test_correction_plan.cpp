// What an error that is asked for means for the lights and for the samples that correct them.
#include <gtest/gtest.h>

#include "fixtures/media.h"
#include "forecast/correction_plan.h"

namespace brisance {
namespace {

using namespace testing;

struct Asked {
    Shot shot;
    Plan plan;
};

Asked asked(float error) {
    Recipe r = glowing_ball(8, 1.0f);
    r.settings.smoke.albedo = Rgb(0.8f);
    Asked out;
    out.shot.lighting.error = error;
    out.plan = plan_cells(out.shot, make_medium(r));
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
    EXPECT_EQ(most_for(0.02f), 0.0);
    double before = 0.0;
    for (const float error : {0.019f, 0.017f, 0.015f, 0.01f, 0.007f}) {
        const double usual = usual_for(error);
        EXPECT_GT(usual, before) << error;
        EXPECT_LE(usual, most_for(error)) << error;
        before = usual;
    }
    EXPECT_EQ(usual_for(0.0001f), most_for(0.0001f));
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
