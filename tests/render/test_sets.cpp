// Whole frames with surfaces: the many-light methods against the path tracer, cell by cell, on a set of our own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "forecast/plan.h"
#include "render/draw.h"
#include "render/render_frame.h"

namespace brisance::test_sets {
namespace {

using namespace testing;

constexpr int kWidth = 48, kHeight = 36;

// A ball of fire and smoke above a floor, before a wall, beside a screen that hides it from part of the floor.
Scene stage(const Medium& medium) {
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    add_quad(scene, {-4, -4, -1.3f}, {8, 0, 0}, {0, 8, 0}, lambert(0.6f));
    SceneMaterial wall = lambert(0.4f);
    wall.surface.specular = 1.0f;
    wall.surface.roughness = 0.6f;
    add_quad(scene, {-4, 2, -1.3f}, {8, 0, 0}, {0, 0, 5}, wall);
    add_quad(scene, {1.4f, -1.0f, -1.3f}, {0, 1.5f, 0}, {0, 0, 1.2f}, lambert(0.3f));
    return scene;
}

Shot shot_of(RenderMethod method) {
    Shot shot;
    shot.method = method;
    shot.camera_given = true;
    shot.camera.eye = {1.0, -6.0, 1.0};
    shot.camera.target = {0.3, 0.0, -0.4};
    shot.camera.vertical_fov_degrees = 40.0;
    shot.camera.width = kWidth;
    shot.camera.height = kHeight;
    shot.camera.samples_per_axis = 4;
    shot.tracing.samples = 128;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights.count = 2000;
    shot.virtual_lights.photons = 200000;
    return shot;
}

std::vector<LightSettings> lamps() {
    LightSettings lamp;
    lamp.position = {-2.0, -2.0, 1.5};
    lamp.power = Rgb(2.0f);
    return {lamp};
}

struct Whole {
    double sum = 0.0, error = 0.0;
};

Whole whole(const Layer& layer) {
    double sum = 0.0;
    for (std::size_t i = 0; i < layer.pixels.size(); i += layer.channels.size())
        sum += layer.pixels[i];
    return {sum / (double(kWidth) * kHeight), 0.0};
}

// The mean of the picture in every cell. Tolerances: 2 % for hierarchies, and noise, from the tracer's halves.
TEST(Sets, EveryCellIsThePathTracers) {
    const Medium medium = make_medium([] {
        Recipe r = glowing_ball(20, 3.0f);
        r.settings.smoke.albedo = Rgb(0.8f);
        return r;
    }());
    const Surroundings surroundings(stage(medium), lamps());
    Progress silent;
    const RenderedFrame grid = render_medium(shot_of(RenderMethod::LightingGrid), medium, silent, &surroundings);
    const RenderedFrame paths = render_medium(shot_of(RenderMethod::Path), medium, silent, &surroundings);
    double all = 0.0, difference = 0.0;
    for (const std::string& cell : grid.statistics.cells) {
        const double ours = whole(grid.image.layer(cell)).sum, truth = whole(paths.image.layer(cell)).sum;
        const double noise = std::abs(whole(paths.halves[0].layer(cell)).sum - whole(paths.halves[1].layer(cell)).sum);
        EXPECT_NEAR(ours, truth, 0.05 * truth + 2.0 * noise + 1e-4) << cell;
        std::printf("%s %.5f, paths %.5f (%+.2f %%), halves apart %.2f %%\n", cell.c_str(), ours, truth,
                    100.0 * (ours / truth - 1.0), 100.0 * noise / truth);
        all += truth;
        difference += ours - truth;
    }
    EXPECT_EQ(grid.statistics.cells, (std::vector<std::string>{"V", "MV", "MM", "MS", "MA", "SV", "SM", "SS", "SA"}));
    EXPECT_LT(std::abs(difference), 0.015 * all);
}

// Every node samples the sky in a few directions. If all nodes took the same ones, the error would be a tenth.
TEST(Sets, ASkyLightsTheSmoke) {
    Recipe recipe = glowing_ball(20, 3.0f);
    recipe.settings.smoke.albedo = Rgb(0.8f);
    Medium medium = make_medium(recipe);
    medium.source.clear();
    LightSettings sky;
    sky.kind = LightKind::Environment;
    sky.power = Rgb(0.5f);
    const Surroundings surroundings(Scene{}, {sky});
    Shot grid = shot_of(RenderMethod::LightingGrid), paths = shot_of(RenderMethod::Path);
    grid.scattering.bounces = paths.scattering.bounces = 1;
    paths.tracing.samples = 32;
    Progress silent;
    const RenderedFrame truth = render_medium(paths, medium, silent, &surroundings);
    const double ma = whole(truth.image.layer("MA")).sum;
    const double noise = std::abs(whole(truth.halves[0].layer("MA")).sum - whole(truth.halves[1].layer("MA")).sum);
    const RenderedFrame ours = render_medium(grid, medium, silent, &surroundings);
    std::printf("MA %.5f, paths %.5f, halves apart %.2f %%\n", whole(ours.image.layer("MA")).sum, ma,
                100.0 * noise / ma);
    EXPECT_NEAR(whole(ours.image.layer("MA")).sum, ma, 0.02 * ma + 2.0 * noise);
    EXPECT_NEAR(whole(ours.image.layer("A")).sum, whole(truth.image.layer("A")).sum, 0.01);
}

TEST(Sets, DoNotKnowHowManyThreadsThereAre) {
    const Medium medium = make_medium(glowing_ball(12, 3.0f));
    const Surroundings surroundings(stage(medium), lamps());
    Shot shot = shot_of(RenderMethod::LightingGrid);
    shot.camera.samples_per_axis = 2;
    shot.virtual_lights.count = 300;
    shot.virtual_lights.photons = 20000;
    const auto pixels = [&](int threads) {
        const ThreadLimit limit(threads);
        Progress silent;
        return render_medium(shot, medium, silent, &surroundings).image.layer("").pixels;
    };
    const std::vector<float> one = pixels(1);
    EXPECT_EQ(one, pixels(2));
    EXPECT_EQ(one, pixels(8));
}

// Particles that bring light of surfaces to the smoke end sooner where more error is allowed, whatever the number of
// threads. As many as a shot states are traced.
TEST(Sets, DoNotKnowMoreOfLightOnSmokeThanIsAsked) {
    Recipe recipe = glowing_ball(12, 3.0f);
    recipe.settings.smoke.albedo = Rgb(0.8f);
    const Medium medium = make_medium(recipe);
    std::vector<LightSettings> bright = lamps();  // beside which the fire is weak
    bright.front().power = Rgb(2000.0f);
    const Surroundings surroundings(stage(medium), bright);
    const auto draw = [&](double error, int photons, int threads) {
        Shot shot = shot_of(RenderMethod::LightingGrid);
        shot.camera.samples_per_axis = 1;
        shot.virtual_lights.count = 0;  // particles bring all of it
        shot.virtual_lights.photons = photons;
        shot.lighting.error = float(error);
        shot.correction.samples = 0;
        const ThreadLimit limit(threads);
        Progress silent;
        return render_medium(shot, medium, silent, &surroundings);
    };
    const auto particles = [](const RenderedFrame& frame) {
        for (const StageCost& stage : frame.statistics.stages)
            if (stage.name == "light from surfaces (MS)")
                return stage.detail["particles"].get<std::size_t>();
        return std::size_t(0);
    };
    const RenderedFrame rough = draw(0.2, kAutomaticPhotons, 2), fine = draw(0.01, kAutomaticPhotons, 2);
    const auto all = std::size_t(kManyPhotons);  // of so small a picture
    std::printf("%zu and %zu particles of %zu\n", particles(rough), particles(fine), all);
    EXPECT_LT(particles(rough), all / 4);
    EXPECT_GT(particles(fine), 2 * particles(rough));
    EXPECT_EQ(rough.image.layer("MS").pixels, draw(0.2, kAutomaticPhotons, 1).image.layer("MS").pixels);
    EXPECT_EQ(particles(draw(0.2, 20000, 2)), 20000u);
    const double ms = whole(fine.image.layer("MS")).sum;
    ASSERT_GT(ms, 0.0);
    EXPECT_NEAR(whole(rough.image.layer("MS")).sum, ms, 0.1 * ms);
}

// Without a volume nothing of one is planned or built, and without light nothing at all.
TEST(Sets, WhatIsNotThereIsNotPlanned) {
    const Medium nothing;
    Scene scene = stage(nothing);
    Progress silent;
    const Surroundings lit(scene, lamps()), dark(scene, {});
    const Shot shot = shot_of(RenderMethod::LightingGrid);
    const RenderedFrame frame = render_medium(shot, nothing, silent, &lit);
    EXPECT_EQ(frame.statistics.cells, (std::vector<std::string>{"SS", "SA"}));
    for (const StageCost& stage : frame.statistics.stages)
        EXPECT_TRUE(stage.name == "virtual lights" || stage.name == "camera" || stage.name == "believed error" ||
                    stage.name == "between the stages")
            << stage.name;
    const RenderedFrame black = render_medium(shot, nothing, silent, &dark);
    EXPECT_TRUE(black.statistics.cells.empty());
    for (const StageCost& stage : black.statistics.stages)
        EXPECT_TRUE(stage.name == "camera" || stage.name == "believed error" || stage.name == "between the stages")
            << stage.name;
    EXPECT_EQ(whole(black.image.layer("")).sum, 0.0);
    EXPECT_GT(whole(frame.image.layer("")).sum, 0.0);
}

// Surfaces in one plane send each other no light: nothing looks for it, and all else is as it was.
TEST(Sets, APlaneHasNoLightBetweenSurfaces) {
    Recipe recipe = glowing_ball(10, 3.0f);
    recipe.settings.smoke.albedo = Rgb(0.8f);
    const Medium medium = make_medium(recipe);
    Scene floor, walled;
    add_quad(floor, {-4, -4, -1.3f}, {8, 0, 0}, {0, 8, 0}, lambert(0.6f));
    add_quad(floor, {5, -4, -1.3f}, {2, 0, 0}, {0, 8, 0}, lambert(0.2f));
    EXPECT_TRUE(floor.is_flat());
    walled = floor;
    add_quad(walled, {-4, 60, -1.3f}, {8, 0, 0}, {0, 0, 5}, lambert(0.4f));
    EXPECT_FALSE(walled.is_flat());
    const Shot shot = shot_of(RenderMethod::LightingGrid);
    const Surroundings alone(floor, lamps()), beside_wall(walled, lamps());
    const Plan plan = plan_cells(shot, medium, &alone);
    EXPECT_FALSE(plan.needs(Cell::SS));
    EXPECT_TRUE(plan.needs(Cell::MS) && plan.needs(Cell::SV) && plan.needs(Cell::SM) && plan.needs(Cell::SA));
    EXPECT_TRUE(std::ranges::any_of(plan.skipped, [](const SkippedPart& s) { return s.name == "SS"; }));
    EXPECT_NE(why_no_virtual_lights(shot, plan)->find("one plane"), std::string::npos);
    EXPECT_TRUE(plan_cells(shot, medium, &beside_wall).needs(Cell::SS));
    floor.materials[0].surface.transmission = 0.5f;
    const Surroundings pane(floor, lamps());
    EXPECT_TRUE(plan_cells(shot, medium, &pane).needs(Cell::SS)) << "a pane shows what is behind it";
    floor.materials[0].surface.transmission = 0.0f;
    floor.materials[0].surface.specular = 1.0f;
    const Surroundings polished(floor, lamps());
    EXPECT_TRUE(plan_cells(shot, medium, &polished).needs(Cell::SS)) << "pixels share what rough lobes reflect";
    Shot paths = shot_of(RenderMethod::Path);
    paths.tracing.samples = 8;
    Progress silent;
    EXPECT_EQ(render_medium(paths, medium, silent, &beside_wall).statistics.cells.size(), 9u);
    const RenderedFrame traced = render_medium(paths, medium, silent, &alone);
    EXPECT_EQ(std::ranges::count(traced.statistics.cells, "SS"), 0);
}

// Few rays stand for the others of a pixel where it shows one plain surface. By all rays the picture is the same within
// lighting.error, which is what a pixel may err by, at edges and in penumbrae, too; its mean is the same.
TEST(Sets, FewRaysLightPlainSurfacesAsAllDo) {
    const Medium medium = make_medium(glowing_ball(10, 3.0f));
    Scene scene = stage(medium);
    add_ball(scene, {-1.6f, -0.8f, -0.9f}, 0.4f, 60, lambert(0.5f));
    const Surroundings set(std::move(scene), {});
    Shot few = shot_of(RenderMethod::LightingGrid), all = few;
    few.camera.samples_per_axis = 0;
    few.scattering.bounces = all.scattering.bounces = 1;
    Progress silent;
    const std::vector<float> seen = render_medium(few, medium, silent, &set).image.layer("SV").pixels,
                             truth = render_medium(all, medium, silent, &set).image.layer("SV").pixels;
    double square = 0.0, of_truth = 0.0, worst = 0.0, sum = 0.0, of_sum = 0.0;
    for (std::size_t i = 0; i < seen.size(); i += 3) {
        const double difference = seen[i] - truth[i];
        square += difference * difference;
        of_truth += double(truth[i]) * truth[i];
        sum += difference;
        of_sum += truth[i];
        worst = std::max(worst, std::abs(difference));
    }
    const double rms = std::sqrt(of_truth / (double(kWidth) * kHeight));
    std::printf("rRMSE %.4f, mean %+.5f, worst pixel %.3f of the RMS\n", std::sqrt(square / of_truth), sum / of_sum,
                worst / rms);
    EXPECT_GT(square, 0.0) << "few rays were meant to light it";
    EXPECT_LT(std::sqrt(square / of_truth), few.lighting.error);
    EXPECT_LT(std::abs(sum), 0.1 * few.lighting.error * of_sum);
    EXPECT_LT(worst, 5.0 * few.lighting.error * rms);
}

// A fire in a ball of smoke, which is even in one half. The other half has as much of it in every other block of two
// voxels, by chance: half more light comes through its gaps. Before a wall a screen hides one half or the other.
TEST(Sets, AScreenHidesAsMuchAsThatPartOfAFireSends) {
    const Medium medium = make_medium([] {
        constexpr int kRadius = 20, kFire = 8;
        Recipe r = glowing_ball(kRadius, 1.0f);
        r.flame = [](const ivec3& n) { return ball(n, dvec3(0.0), kFire); };
        r.density = [](const ivec3& n) {
            const bool clumps = n.x >= 0 && ball(n, dvec3(0.0), kFire + 2) == 0.0f;
            const float part = !clumps ? 1.0f : (testing::noise(n >> 1, 1) < 0.5f ? 0.0f : 2.0f);
            return 5.0f * part * ball(n, dvec3(0.0), kRadius);
        };
        return r;
    }());
    std::vector<double> truths;
    for (const float side : {-1.0f, 1.0f}) {
        Scene scene;
        scene.origin = medium.world_of_local(vec3(0.0f));
        add_quad(scene, {-1, 3, -1}, {2, 0, 0}, {0, 0, 2}, lambert(0.6f));
        add_quad(scene, {0, 1.2f, -3}, {side * 4, 0, 0}, {0, 0, 6}, lambert(0.0f));
        const Surroundings set(std::move(scene), {});
        const auto wall = [&](RenderMethod method) {
            Shot shot = shot_of(method);
            shot.camera.eye = {0.0, 1.5, 0.0};
            shot.camera.target = {0.0, 3.0, 0.0};
            shot.scattering.bounces = 1;
            shot.virtual_lights.count = 0;
            shot.tracing.samples = 256;
            Progress silent;
            return render_medium(shot, medium, silent, &set);
        };
        const RenderedFrame grid = wall(RenderMethod::LightingGrid), paths = wall(RenderMethod::Path);
        const double ours = whole(grid.image.layer("SV")).sum, truth = whole(paths.image.layer("SV")).sum;
        const double noise = std::abs(whole(paths.halves[0].layer("SV")).sum - whole(paths.halves[1].layer("SV")).sum);
        std::printf("SV past the screen at %+.0f: %.5f, paths %.5f (%+.2f %%), halves apart %.2f %%\n", side, ours,
                    truth, 100.0 * (ours / truth - 1.0), 100.0 * noise / truth);
        EXPECT_NEAR(ours, truth, 0.03 * truth + noise);
        truths.push_back(truth);
    }
    EXPECT_GT(truths[0], 1.3 * truths[1]) << "the halves were meant to differ";
}

// What the many-light methods cannot do is refused, not left out.
TEST(Sets, RefuseWhatTheyCannotDo) {
    const Medium nothing;
    const Surroundings surroundings(stage(nothing), lamps());
    Progress silent;
    Shot finite = shot_of(RenderMethod::LightingGrid), plain = shot_of(RenderMethod::Path);
    finite.scattering.bounces = 3;
    plain.tracing.emission = EmissionEstimator::Collision;
    for (const Shot* shot : {&finite, &plain})
        EXPECT_THROW(render_medium(*shot, nothing, silent, &surroundings), Error);
}

// A surface in front hides what is behind it and closes the picture.
TEST(Sets, SurfacesHideTheSmokeBehindThem) {
    const Medium medium = make_medium(glowing_ball(12, 3.0f));
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    add_quad(scene, {-9, -2, -9}, {18, 0, 0}, {0, 0, 18}, lambert(0.0f));
    const Surroundings surroundings(scene, {});
    Progress silent;
    for (const RenderMethod method : {RenderMethod::LightingGrid, RenderMethod::Path}) {
        Shot shot = shot_of(method);
        shot.tracing.samples = 2;
        const Image image = render_medium(shot, medium, silent, &surroundings).image;
        const Layer& colour = image.layer("");
        const Layer& z = image.layer("Z");
        for (std::size_t p = 0; p < z.pixels.size(); ++p) {
            EXPECT_EQ(colour.pixels[4 * p], 0.0f);
            EXPECT_EQ(colour.pixels[4 * p + 3], 1.0f);
            EXPECT_LT(z.pixels[p], 10.0f);
        }
    }
}

}  // namespace
}  // namespace brisance::test_sets
