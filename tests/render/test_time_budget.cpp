// seconds: the settings of least error for a time.
#include <gtest/gtest.h>

#include "core/stopwatch.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "forecast/machine_speed.h"
#include "make_vdb.h"
#include "render/choice/time_budget.h"
#include "render/render_frame.h"
#include "temp_folder.h"

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

Surroundings floor_below() {
    Scene scene;
    add_quad(scene, {-4, -4, -1.1f}, {8, 0, 0}, {0, 8, 0}, lambert(0.7f));
    return Surroundings(std::move(scene), {});
}

TEST(TimeBudget, WhatIsNotForecastKeepsItsSettings) {
    const Surroundings set = floor_below();
    Listener listener;
    Shot shot = shot_of(5.0);
    shot.lighting.error = 0.037f;
    shot.virtual_lights.passes = 2;
    const TimedSettings t = settings_for_time(shot, glow(8), &set, shot.camera, {shot.seconds, 0.0, 1.0}, listener);
    EXPECT_FLOAT_EQ(t.shot.lighting.error, 0.037f);
    EXPECT_FALSE(t.camera_end);
    EXPECT_EQ(listener.warnings.size(), 1u);
}

// Samples along a pixel's side that a set's picture took; 0: automatic.
int samples_of_set(const Shot& shot, Listener& listener) {
    const Surroundings set = floor_below();
    const RenderedFrame frame = render_medium(shot, glow(8), listener, &set);
    for (const StageCost& stage : frame.statistics.stages)
        if (stage.name == "choice of the samples") {
            const std::string side = stage.detail.at("samples_per_axis");
            return side == "auto" ? 0 : std::stoi(side);
        }
    return -1;
}

// Nobody can say how fast a machine is, but none does this in a hundredth of a second, and any in minutes.
TEST(TimeBudget, SamplesOfASetFollowTheTime) {
    Listener hurried, patient;
    EXPECT_EQ(samples_of_set(shot_of(0.01), hurried), 1);
    ASSERT_FALSE(hurried.warnings.empty());
    EXPECT_NE(hurried.warnings.front().second.find("may not suffice"), std::string::npos);
    EXPECT_EQ(samples_of_set(shot_of(600.0), patient), 8);
    EXPECT_TRUE(patient.warnings.empty());
}

// The picture is that of the same settings without a time, where nothing else follows from the samples.
TEST(TimeBudget, ATimedSetIsDrawnAsIfItsSettingsWereStated) {
    const Surroundings set = floor_below();
    const Medium medium = glow(8);
    Listener listener;
    Shot hurried = shot_of(0.01);
    hurried.virtual_lights.photons = 10000;
    const RenderedFrame timed = render_medium(hurried, medium, listener, &set);
    Shot stated = hurried;
    stated.seconds = 0.0;
    stated.lighting.error = 0.1f;
    stated.lighting.alpha = stated.scattering.alpha = 1.0f;
    stated.camera.samples_per_axis = stated.camera.edge_refinement = 1;
    EXPECT_EQ(timed.image.layer("").pixels, render_medium(stated, medium, listener, &set).image.layer("").pixels);
}

// All frames of a sequence take the samples that one of them has time for.
TEST(TimeBudget, SamplesOfASequenceAreChosenOnce) {
    const TempFolder folder;
    TestGrid smoke;
    smoke.name = "density";
    smoke.world_from_index = cubic(0.1);
    smoke.voxels = fill_box(ivec3(-4), ivec3(4), [](const ivec3&) { return 1.0; });
    write_vdb(folder / "smoke.0001.vdb", {smoke});
    Shot shot = shot_of(600.0);
    shot.volume.file = (folder / "smoke.####.vdb").string();
    QuickQuad floor;
    floor.corners = {dvec3(-4, -4, -1), dvec3(4, -4, -1), dvec3(4, 4, -1), dvec3(-4, 4, -1)};
    shot.scene.quads.push_back(floor);
    Listener listener;
    const TimedSettings t = settings_for_time(shot, folder / "smoke.0001.vdb", 1, listener);
    EXPECT_FALSE(t.camera_end);
    EXPECT_EQ(t.shot.seconds, 0.0);
    EXPECT_EQ(t.shot.camera.samples_per_axis, 8);
    EXPECT_EQ(t.shot.camera.edge_refinement, 1) << "as it was timed";
    for (const auto& [code, line] : listener.warnings)
        EXPECT_NE(code, "seconds") << line;
}

}  // namespace
}  // namespace brisance::test_time_budget
