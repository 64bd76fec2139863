// What changes from frame to frame of a still, and what does not.
#include "film_strip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "metrics/layers.h"
#include "render/render_frame.h"
#include "render/still_variants.h"
#include "report_text.h"
#include "shot/keys/keys.h"
#include "small_ball.h"
#include "suite/contest.h"

namespace brisance {
namespace {

Picture flat(float value) {
    return {40, 30, std::vector<Rgb>(1200, Rgb(value))};
}

Picture noisy(float value, float deviation, unsigned seed) {
    Picture picture = flat(value);
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(0.0f, deviation);
    for (Rgb& pixel : picture.pixels)
        for (int c = 0; c < 3; ++c)
            pixel[c] += normal(random);
    return picture;
}

// However wrong it is.
TEST(Flicker, OfAnErrorThatStandsStillIsZero) {
    const std::vector<Picture> frames(3, noisy(3.0f, 0.5f, 1));
    EXPECT_EQ(flicker_of(frames, {flat(1.0f), flat(1.0f)}), 0.0);
    for (const float value : flicker_map(frames, {flat(1.0f), std::nullopt}).values)
        EXPECT_EQ(value, 0.0f);
}

// 3600 independent values in each of three frames: its relative standard error is about 1.1 %, five of which are
// allowed.
TEST(Flicker, OfNewNoiseIsItsSize) {
    const std::vector<Picture> frames = {noisy(5.0f, 0.2f, 1), noisy(5.0f, 0.2f, 2), noisy(5.0f, 0.2f, 3)};
    EXPECT_NEAR(flicker_of(frames, {flat(2.0f), std::nullopt}), 0.1, 0.0055);
    // The noise of the reference's halves does not count as light.
    EXPECT_NEAR(flicker_of(frames, {noisy(2.0f, 2.0f, 4), noisy(2.0f, 2.0f, 5)}), 0.1, 0.012);
}

TEST(Flicker, LeavesOutPixelsThatAreNoNumbers) {
    std::vector<Picture> frames(2, flat(1.0f));
    frames[1].pixels[7] = Rgb(NAN);
    EXPECT_EQ(flicker_of(frames, {flat(1.0f), std::nullopt}), 0.0);
}

TEST(Flicker, IsNoneOfOneFrameOrWithoutLight) {
    const std::vector<Picture> frames(2, flat(1.0f));
    EXPECT_TRUE(std::isnan(flicker_of(std::span(frames).first(1), {flat(1.0f), std::nullopt})));
    EXPECT_TRUE(std::isnan(flicker_of(frames, {flat(0.0f), std::nullopt})));
}

TEST(FlickerMap, ShowsWhereItFlickers) {
    std::vector<Picture> frames(2, flat(1.0f));
    frames[1].pixels[5] = Rgb(1.0f + 0.1f * std::sqrt(2.0f));
    const Plane map = flicker_map(frames, {flat(1.0f), std::nullopt});
    EXPECT_NEAR(map.values[5], std::log10(0.1 / 1.01) / 3.0 + 1.0, 1e-3);
    EXPECT_EQ(map.values[4], 0.0f);
}

TEST(Strips, HaveOtherSeedsInEveryFrameAndMove) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = {1.0, 2.0, 3.0};
    const Shot second = frame_of_strip(shot, 1, 0.5), third = frame_of_strip(shot, 2, 0.5);
    EXPECT_EQ(second.camera.eye, dvec3(2.5, 4.5, 6.5));
    EXPECT_EQ(third.camera.eye, dvec3(4.0, 7.0, 10.0));
    EXPECT_EQ(frame_of_strip(shot, 1, 0.0).camera.eye, shot.camera.eye);
    int seeds = 0;
    for (const Key& key : shot_keys()) {
        if (!key.path.ends_with(".seed") || key.path == "certify.seed")
            continue;
        ++seeds;
        EXPECT_EQ((std::set<Json>{*key.get(shot), *key.get(second), *key.get(third)}.size()), 3u) << key.path;
    }
    EXPECT_GE(seeds, 7);
    shot.tracing.seed = (1 << 30) - 1;
    EXPECT_EQ(reseeded(shot, 2).tracing.seed, 1) << "stays a seed that the key takes";
}

Shot looking_at_the_ball(RenderMethod method, int samples) {
    Shot shot;
    shot.volume.file = "ball.vdb";
    shot.method = method;
    shot.camera.eye = dvec3(0.0, -6.0, 0.0);
    shot.camera.width = 24;
    shot.camera.height = 18;
    shot.camera_given = true;
    shot.tracing.samples = samples;
    shot.certify.belief = 0.0;
    shot.correction.samples = 0;  // by lights alone
    return shot;
}

// Of the picture, in three frames that stand where they are.
double flicker_of_ball(const Shot& shot, bool other_seeds) {
    Progress silent;
    std::vector<Picture> frames;
    for (int frame = 0; frame < 3; ++frame) {
        const Shot of_frame = other_seeds ? frame_of_strip(shot, frame, 0.0) : shot;
        frames.push_back(picture_of(render_medium(of_frame, input().medium, silent).image, {""}).picture);
    }
    return flicker_of(frames, {frames[0], std::nullopt});
}

TEST(Strips, OfAStillCameraAndTheSameSeedsDoNotFlicker) {
    EXPECT_EQ(flicker_of_ball(looking_at_the_ball(RenderMethod::Path, 4), false), 0.0);
}

// The lighting grid draws nothing for smoke without surfaces.
TEST(Strips, OfAMethodWithoutRandomNumbersDoNotFlicker) {
    EXPECT_EQ(flicker_of_ball(looking_at_the_ball(RenderMethod::LightingGrid, 4), true), 0.0);
}

// Like the root of their number: 16 times as many paths, a quarter. Pixels are independent, and heavy tails are few.
TEST(Strips, OfThePathTracerFlickerLessWithMorePaths) {
    const double few = flicker_of_ball(looking_at_the_ball(RenderMethod::Path, 4), true);
    const double many = flicker_of_ball(looking_at_the_ball(RenderMethod::Path, 64), true);
    EXPECT_GT(few / many, 2.5);
    EXPECT_LT(few / many, 6.0);
}

TEST(Strips, GiveTheFlickerOfTheFirstRunToTablesAndContests) {
    Report report;
    report.layers = {"", "MM"};
    report.shot.json = "{}";
    MethodResult result;
    result.method.label = "photons";
    result.method.cells = {Cell::MM};
    for (const double seconds : {1.0, 2.0}) {
        MeasuredRun run;
        run.cost = {seconds, seconds};
        run.errors["MM"].differences.rrmse = 0.5 / seconds;
        result.runs.push_back(run);
    }
    result.flicker["MM"] = 0.375;
    report.methods = {result};
    const std::string csv = measurements_csv(report);
    const std::size_t first = csv.find(",0.375,");
    ASSERT_NE(first, std::string::npos);
    EXPECT_EQ(csv.find(",0.375,", first + 1), std::string::npos) << "of the first run alone";
    const Contest contest = contests(report, Clock::Cpu).front();
    EXPECT_EQ(contest.contenders.front().flicker, 0.375);
}

}  // namespace
}  // namespace brisance
