// seconds: the settings of least error for a time.
#include <gtest/gtest.h>

#include "core/stopwatch.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "forecast/machine_speed.h"
#include "render/choice/time_budget.h"
#include "render/render_frame.h"

namespace brisance::test_time_budget {
namespace {

using namespace testing;

Medium glow(int radius) {
    Recipe r = glowing_ball(radius, 2.0f);
    r.settings.smoke.albedo = Rgb(0.7f);
    return make_medium(r);
}

Shot shot_of(double seconds, RenderMethod method = RenderMethod::LightingGrid) {
    Shot shot;
    shot.method = method;
    shot.seconds = seconds;
    shot.camera_given = true;
    shot.camera.eye = {0.3, -5.0, 1.5};
    shot.camera.target = {0.0, 0.0, 0.0};
    shot.camera.vertical_fov_degrees = 32.0;
    shot.camera.width = shot.camera.height = 64;
    return shot;
}

TimedSettings timed(const Shot& shot, const Medium& medium, double speed = 1.0, double spent = 0.0) {
    Progress silent;
    return settings_for_time(shot, medium, nullptr, shot.camera, {shot.seconds, spent, speed}, silent);
}

TEST(TimeBudget, MoreTimeNeverMeansCoarserSettings) {
    const Medium medium = glow(16);
    float last = 1.0f;
    for (const double seconds : {0.1, 1.0, 3.0, 10.0, 100.0, 1000.0}) {
        const TimedSettings t = timed(shot_of(seconds), medium);
        EXPECT_LE(t.shot.lighting.error, last);
        EXPECT_TRUE(t.too_short || t.seconds <= seconds) << seconds;
        EXPECT_EQ(t.shot.seconds, 0.0);
        last = t.shot.lighting.error;
    }
    EXPECT_FLOAT_EQ(last, with_step({}, step_count() - 1).lighting.error);
}

// A machine twice as fast does in half the time what a slow one does.
TEST(TimeBudget, CountsWithTheMachine) {
    const Medium medium = glow(16);
    for (const double seconds : {0.5, 2.0, 8.0})
        EXPECT_EQ(timed(shot_of(seconds), medium, 2.0).shot.lighting.error,
                  timed(shot_of(2.0 * seconds), medium, 1.0).shot.lighting.error);
    EXPECT_GT(machine_speed(), 0.0);
}

TEST(TimeBudget, TimeThatIsGoneDoesNotCount) {
    const Medium medium = glow(16);
    EXPECT_GE(timed(shot_of(20.0), medium, 1.0, 19.5).shot.lighting.error,
              timed(shot_of(20.0), medium).shot.lighting.error);
}

TEST(TimeBudget, TooLittleTimeIsSaidAndTakesTheCoarsest) {
    Listener listener;
    const Shot shot = shot_of(0.01);
    const Medium medium = glow(8);
    const RenderedFrame frame = render_medium(shot, medium, listener);
    ASSERT_FALSE(frame.statistics.warnings.empty());
    EXPECT_TRUE(frame.statistics.warnings.front().starts_with("seconds: ")) << frame.statistics.warnings.front();
    EXPECT_EQ(frame.image.layer("").pixels,
              render_medium(with_step(shot_of(0.0), 0), medium, listener).image.layer("").pixels);
}

// The path tracer is told when to stop, and no pass begins that does not fit.
TEST(TimeBudget, PathsStopByTime) {
    const Medium medium = glow(8);
    Shot shot = shot_of(30.0, RenderMethod::Path);
    const TimedSettings t = timed(shot, medium);
    EXPECT_EQ(t.shot.tracing.samples, 0);
    EXPECT_GT(t.shot.tracing.seconds, 25.0);
    EXPECT_LT(t.shot.tracing.seconds, 30.0);
}

TEST(TimeBudget, AutoTakesPathsForSmallPicturesAndTheGridForLargeOnes) {
    const Medium medium = glow(24);
    Shot small = shot_of(8.0, RenderMethod::Automatic), large = small;
    small.camera.width = small.camera.height = 8;
    large.camera.width = large.camera.height = 2048;
    EXPECT_EQ(timed(small, medium).shot.method, RenderMethod::Path);
    EXPECT_EQ(timed(large, medium, 4.0).shot.method, RenderMethod::LightingGrid);
}

TEST(TimeBudget, WhatIsNotForecastKeepsItsSettings) {
    Scene scene;
    add_quad(scene, {-4, -4, -1.1f}, {8, 0, 0}, {0, 8, 0}, lambert(0.7f));
    const Surroundings set(std::move(scene), {});
    Listener listener;
    Shot shot = shot_of(5.0);
    shot.lighting.error = 0.037f;
    const TimedSettings t = settings_for_time(shot, glow(8), &set, shot.camera, {shot.seconds, 0.0, 1.0}, listener);
    EXPECT_FLOAT_EQ(t.shot.lighting.error, 0.037f);
    EXPECT_EQ(listener.warnings.size(), 1u);
}

}  // namespace
}  // namespace brisance::test_time_budget
