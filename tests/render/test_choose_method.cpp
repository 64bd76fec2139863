// method=auto takes the method that reaches the error asked for sooner, and renders as that method does.
#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "forecast/correction_plan.h"
#include "render/choice/choose_method.h"
#include "render/render_frame.h"

namespace brisance::test_choose_method {
namespace {

using namespace testing;

// Glowing smoke of so many nodes in radius.
Medium glow(int radius, float albedo = 0.7f) {
    Recipe r = glowing_ball(radius, 2.0f);
    r.settings.smoke.albedo = Rgb(albedo);
    return make_medium(r);
}

Shot shot_of(int size, float error = 0.02f) {
    Shot shot;
    shot.method = RenderMethod::Automatic;
    shot.lighting.error = error;
    shot.camera_given = true;
    shot.camera.eye = {0.3, -5.0, 1.5};
    shot.camera.target = {0.0, 0.0, 0.0};
    shot.camera.vertical_fov_degrees = 32.0;
    shot.camera.width = shot.camera.height = size;
    return shot;
}

MethodForecast forecast(const Shot& shot, const Medium& medium, const Surroundings* surroundings = nullptr) {
    Progress silent;
    return forecast_methods(shot, medium, surroundings, shot.camera, silent);
}

TEST(ChooseMethod, SmallPicturesTakePathsAndLargeOnesTheGrid) {
    const Medium medium = glow(24);
    EXPECT_EQ(forecast(shot_of(8), medium).method, RenderMethod::Path);
    EXPECT_EQ(forecast(shot_of(1024), medium).method, RenderMethod::LightingGrid);
}

Shot by_lights_alone(Shot shot) {
    shot.correction.samples = 0;
    return shot;
}

// Four times the pixels need four times the paths, and so does half the error. The grid's shadow maps become finer, and
// so does the lattice of its series, which costs less.
TEST(ChooseMethod, PathsCostMoreWithPixelsAndLessError) {
    const Medium medium = glow(16);
    const MethodForecast one = forecast(by_lights_alone(shot_of(128, 0.01f)), medium),
                         finer = forecast(by_lights_alone(shot_of(128, 0.005f)), medium),
                         larger = forecast(by_lights_alone(shot_of(256, 0.01f)), medium);
    EXPECT_NEAR(finer.path_seconds / one.path_seconds, 4.0, 0.1);
    EXPECT_NEAR(larger.path_seconds / one.path_seconds, 4.0, 0.8);
    EXPECT_GT(finer.grid_seconds, one.grid_seconds);
    EXPECT_LT(finer.grid_seconds, 3.0 * one.grid_seconds);
}

// The samples of a correction count for the grid's picture, which is lit on what lattices may add beside them.
TEST(ChooseMethod, CorrectionsTakeTheirTime) {
    const Medium medium = glow(16);
    // By lights of 0.02 on the lattices that the plan for the error chooses.
    const auto alone = [&](float error) {
        Shot shot = shot_of(128, error);
        const Plan plan = plan_cells(with_method(shot, {RenderMethod::LightingGrid, "", 0.0, 0.0, 0.0, {}}), medium);
        shot.lighting = shot_of_lights(shot, plan, {medium, nullptr, shot.camera}).lighting;
        EXPECT_EQ(shot.lighting.error, 0.02f);
        return forecast(by_lights_alone(shot), medium).grid_seconds;
    };
    EXPECT_NEAR(forecast(shot_of(128, 0.01f), medium).grid_seconds / alone(0.01f), 4.0, 1e-6);
    EXPECT_NEAR(forecast(shot_of(128, 0.02f), medium).grid_seconds / alone(0.02f), 1.75, 1e-6);
    EXPECT_NEAR(forecast(shot_of(128, 0.04f), medium).grid_seconds /
                    forecast(by_lights_alone(shot_of(128, 0.04f)), medium).grid_seconds,
                1.0, 1e-6);
}

// The pilot ignores that the path tracer's samples are stratified, which need up to a half fewer.
TEST(ChooseMethod, ForecastsTheSamplesThatPathsNeed) {
    const Medium medium = glow(12);
    Shot shot = shot_of(64, 0.03f);
    const MethodForecast f = forecast(shot, medium);
    shot = with_method(shot, {RenderMethod::Path, "", 0.0, 0.0, 0.0, {}});
    Progress silent;
    const double taken = render_medium(shot, medium, silent).metadata.samples_per_pixel;
    EXPECT_GT(f.samples / taken, 0.67);
    EXPECT_LT(f.samples / taken, 2.0);
}

TEST(ChooseMethod, RendersAsTheMethodThatItTakes) {
    const Medium medium = glow(8);
    for (const int size : {8, 400}) {
        Shot shot = shot_of(size, 0.05f);
        shot.camera.samples_per_axis = 1;
        Progress silent;
        const RenderedFrame frame = render_medium(shot, medium, silent);
        const MethodForecast f = forecast(shot, medium);
        EXPECT_EQ(f.method, size == 8 ? RenderMethod::Path : RenderMethod::LightingGrid);
        EXPECT_EQ(frame.image.layer("").pixels,
                  render_medium(with_method(shot, f), medium, silent).image.layer("").pixels);
        EXPECT_EQ(frame.statistics.stages.front().name, "choice of the method");
        EXPECT_EQ(frame.halves.empty(), size != 8);
        EXPECT_EQ(frame.metadata.text.at("brisance/method"), size == 8 ? "path" : "lighting_grid");
    }
}

// The error of what paths render is the one asked for.
TEST(ChooseMethod, PathsEndAtTheErrorAskedFor) {
    Shot shot = shot_of(8, 0.04f);
    Progress silent;
    const RenderedFrame frame = render_medium(shot, glow(24), silent);
    ASSERT_EQ(frame.halves.size(), 2u);
    double noise = 0.0, norm = 0.0;
    const std::vector<float>&a = frame.halves[0].layer("").pixels, &b = frame.halves[1].layer("").pixels;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (i % 4 == 3)
            continue;  // alpha
        noise += std::pow(double(a[i]) - b[i], 2);
        norm += std::pow(double(a[i]) + b[i], 2);
    }
    EXPECT_LE(std::sqrt(noise / norm), 0.0401);
}

// The shot's own error comes first, and the number of samples does not count.
TEST(ChooseMethod, AStatedErrorOfPathsCounts) {
    const Medium medium = glow(12);
    Shot shot = shot_of(32, 0.02f);
    shot.tracing.samples = 2;
    const MethodForecast by_default = forecast(shot, medium);
    shot.tracing.error = 0.01;
    const MethodForecast stated = forecast(shot, medium);
    EXPECT_NEAR(stated.samples / by_default.samples, 4.0, 0.1);
    const Shot traced = with_method(shot, {RenderMethod::Path, "", 0.0, 0.0, 0.0, {}});
    EXPECT_EQ(traced.tracing.error, 0.01);
    EXPECT_EQ(traced.tracing.samples, 0);
}

TEST(ChooseMethod, IsTheSameOnAnyNumberOfThreads) {
    const Medium medium = glow(12);
    const auto seconds = [&](int threads) {
        const ThreadLimit limit(threads);
        const MethodForecast f = forecast(shot_of(64), medium);
        return std::pair(f.path_seconds, f.grid_seconds);
    };
    EXPECT_EQ(seconds(1), seconds(2));
}

TEST(ChooseMethod, WhatIsNotForecastIsLitByTheGrid) {
    Scene scene;
    add_quad(scene, {-4, -4, -1.1f}, {8, 0, 0}, {0, 8, 0}, lambert(0.7f));
    const Surroundings set(std::move(scene), {});
    const auto grid = [](const MethodForecast& f) {
        return f.method == RenderMethod::LightingGrid && f.path_seconds == 0.0 && !f.reason.empty();
    };
    EXPECT_TRUE(grid(forecast(shot_of(8), glow(8), &set)));
    EXPECT_TRUE(grid(forecast(shot_of(8), glow(8, 0.0f))));
    Shot rays = shot_of(8);
    rays.scattering_methods.method = RayLightsMethod::kName;
    EXPECT_TRUE(grid(forecast(rays, glow(8))));
}

}  // namespace
}  // namespace brisance::test_choose_method
