// Pictures whose MV and SV come from the fire's single lights: every cell has one owner, and all others are as before.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "camera_rays/pixel_rays.h"
#include "core/error.h"
#include "core/parallel.h"
#include "fire_lights/samplings.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "forecast/plan.h"
#include "render/render_frame.h"
#include "shot/read_shot.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kSide = 16;

Shot small_shot(const std::string& sampling) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = {0.3, -5.0, 1.5};
    shot.camera.target = {0.0, 0.0, -0.2};
    shot.camera.vertical_fov_degrees = 32.0;
    shot.camera.width = shot.camera.height = kSide;
    shot.camera.samples_per_axis = 2;
    shot.tracing.samples = 256;
    shot.virtual_lights.count = 0;
    shot.certify.belief = 0.0;
    shot.correction.samples = 0;  // by lights alone
    shot.scattering_methods.method = kLightingGridMethod;
    shot.fire_lights.sampling = sampling;
    shot.fire_lights.points = 8;
    shot.fire_lights.samples = 8;
    return shot;
}

Medium smoke(float mean_cosine) {
    Recipe r = glowing_ball(6, 2.0f);
    r.settings.smoke.albedo = Rgb(0.8f);
    r.settings.smoke.mean_cosine = mean_cosine;
    r.flame = [](const ivec3& n) { return n.x < 0 && n.y < 0 ? 1.0f : 0.0f; };
    return make_medium(r);
}

Surroundings floor_of_metal() {
    Scene scene;
    SceneMaterial glossy = lambert(0.5f);
    glossy.surface.metallic = 0.5f;
    glossy.surface.roughness = 0.0f;
    add_quad(scene, {-4, -4, -1.1f}, {8, 0, 0}, {0, 8, 0}, glossy);
    return Surroundings(std::move(scene), {});
}

RenderedFrame rendered(const Shot& shot, const Medium& medium, const Surroundings* set = nullptr) {
    Progress silent;
    return render_medium(shot, medium, silent, set);
}

double mean_of(const Image& image, const char* layer) {
    const std::vector<float>& pixels = image.layer(layer).pixels;
    double sum = 0.0;
    for (const float v : pixels)
        sum += v / double(pixels.size());
    return sum;
}

// Of the difference of two layers, over the first's norm.
double difference(const Image& a, const Image& b, const char* layer) {
    const std::vector<float>&x = a.layer(layer).pixels, &y = b.layer(layer).pixels;
    double square = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        square += double(x[i] - y[i]) * (x[i] - y[i]);
        norm += double(x[i]) * x[i];
    }
    return std::sqrt(square / norm);
}

std::vector<std::string> all_samplings() {
    std::vector<std::string> names;
    for (const FireLightSampling& row : fire_light_samplings())
        names.emplace_back(row.name);
    return names;
}

class FireLightPictures : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Samplings, FireLightPictures, ::testing::ValuesIn(all_samplings()),
                         [](const auto& sampling) { return sampling.param; });

// The mean of a cell over pictures of other seeds is the path tracer's, whose two halves tell its own error. Half a
// percent: the camera's samples differ.
void expect_mean_of_paths(const char* cell, const RenderedFrame& paths, Shot lit, const Medium& medium,
                          const Surroundings* set, int seeds) {
    const double a = mean_of(paths.halves[0], cell), b = mean_of(paths.halves[1], cell), truth = 0.5 * (a + b);
    double sum = 0.0, square = 0.0;
    for (int seed = 0; seed < seeds; ++seed) {
        lit.fire_lights.seed = static_cast<std::uint32_t>(seed);
        const double mean = mean_of(rendered(lit, medium, set).image, cell);
        sum += mean / seeds;
        square += mean * mean / seeds;
    }
    const double error = std::hypot(std::sqrt(std::max(0.0, square - sum * sum) / (seeds - 1)), 0.5 * (a - b));
    std::printf("%s: %s of paths %.5g +- %.2g, of lights %.5g, standard error of both %.2g\n",
                lit.fire_lights.sampling.c_str(), cell, truth, 0.5 * std::abs(a - b), sum, error);
    EXPECT_NEAR(sum, truth, 4.0 * error + 0.005 * truth);
    EXPECT_LT(error, 0.05 * truth);
}

// What paths see of light that was scattered once.
RenderedFrame traced(int samples, const Medium& medium, const Surroundings* set) {
    Shot shot = small_shot(kFireByHierarchy);
    shot.method = RenderMethod::Path;
    shot.tracing.samples = samples;
    shot.scattering.bounces = 1;
    return rendered(shot, medium, set);
}

// Sharp peaks make the grid count light as not scattered: MM must not hold it twice, nor lose it.
TEST_P(FireLightPictures, ChangeMVAlone) {
    for (const float g : {0.0f, 0.8f}) {
        const Medium medium = smoke(g);
        Shot shot = small_shot(GetParam());
        if (GetParam() == "all")
            shot.fire_lights.points = 1;
        const Image lights = rendered(shot, medium).image;
        const Image grid = rendered(small_shot(kFireByHierarchy), medium).image;
        EXPECT_EQ(lights.layer("V").pixels, grid.layer("V").pixels);
        EXPECT_LT(difference(grid, lights, "MM"), 1e-5) << "g " << g;
        double sum = 0.0;
        for (const char* cell : {"V", "MV", "MM"})
            sum += mean_of(lights, cell);
        const double beauty = mean_of(lights, "");  // with alpha
        const double of_grid = mean_of(grid, "") - mean_of(grid, "MV") * 0.75;
        EXPECT_NEAR(beauty, of_grid + 0.75 * mean_of(lights, "MV"), 1e-4 * sum);
    }
}

// Over pictures of other seeds. Half a percent: the camera's samples differ.
TEST_P(FireLightPictures, HaveThePathTracersMV) {
    constexpr int kSeeds = 8;
    const Medium medium = smoke(0.3f);
    // One truth for all samplings.
    static const RenderedFrame paths = traced(256, medium, nullptr);
    Shot lit = small_shot(GetParam());
    lit.scattering.bounces = 1;
    lit.fire_lights.points = GetParam() == "all" ? 1 : 8;
    lit.fire_lights.lightcuts_error = 0.002;
    expect_mean_of_paths("MV", paths, lit, medium, nullptr, kSeeds);
}

// Many lights make each estimate: eight pictures add no more to the standard error than the truth does.
bool hardly_noisy(const std::string& sampling) {
    return sampling == "all" || sampling == "lightcuts" || sampling == "multidimensional_lightcuts";
}

// A floor, of which a plate keeps a part in the dark. Over pictures of other seeds; half a percent: the camera's
// samples differ. The truth's standard error is 0.08 %, that of the lights 0.08 to 0.4 %.
TEST_P(FireLightPictures, HaveThePathTracersSV) {
    const int seeds = hardly_noisy(GetParam()) ? 8 : 12;
    Scene scene;
    add_quad(scene, {-4, -4, -1.4f}, {8, 0, 0}, {0, 8, 0}, lambert(0.5f));
    add_quad(scene, {0.1f, -0.8f, -1.15f}, {1.5f, 0, 0}, {0, 1.6f, 0}, lambert(0.3f));
    const Surroundings set(std::move(scene), {});
    const Medium medium = smoke(0.3f);
    // One truth for all samplings.
    static const RenderedFrame paths = traced(3072, medium, &set);
    Shot lit = small_shot(GetParam());
    lit.scattering.bounces = 1;
    lit.camera.samples_per_axis = 3;
    lit.fire_lights.points = 1;
    lit.fire_lights.samples = GetParam() == "intensity" ? 32 : 8;
    lit.fire_lights.lightcuts_error = 0.002;
    expect_mean_of_paths("SV", paths, lit, medium, &set, seeds);
}

// Three tiles of rays through the smoke onto the floor, and more points of the floor than one thread lights at once, so
// that threads do take turns.
TEST_P(FireLightPictures, AreTheSameOnAnyNumberOfThreads) {
    const Medium medium = smoke(0.4f);
    const Surroundings set = floor_of_metal();
    Shot shot = small_shot(GetParam());
    shot.camera.target.z = -0.5;
    shot.camera.vertical_fov_degrees = 10.0;
    shot.camera.width = 2 * kSideOfTile + kSideOfTile / 2;
    shot.camera.height = 8;
    shot.camera.samples_per_axis = 1;
    shot.scattering.bounces = 1;
    shot.fire_lights.points = GetParam() == "all" ? 1 : 3;
    const auto pixels = [&](int threads) {
        const ThreadLimit limit(threads);
        return rendered(shot, medium, &set).image.layer("").pixels;
    };
    EXPECT_EQ(pixels(1), pixels(3));
}

TEST(FireLightPlans, BuildNoHierarchyForSingleScattering) {
    Shot shot = small_shot("intensity");
    shot.scattering.bounces = 1;
    const RenderedFrame frame = rendered(shot, smoke(0.0f));
    for (const StageCost& stage : frame.statistics.stages)
        EXPECT_NE(stage.name, "lights and hierarchy");
    EXPECT_TRUE(std::any_of(frame.statistics.stages.begin(), frame.statistics.stages.end(),
                            [](const StageCost& stage) { return stage.name == "lights of the fire"; }));
    EXPECT_EQ(plan_cells(small_shot(kFireByHierarchy), smoke(0.0f)).fire_sampling, nullptr);
    Shot traced = shot;
    traced.method = RenderMethod::Path;
    EXPECT_EQ(plan_cells(traced, smoke(0.0f)).fire_sampling, nullptr);
}

bool has_stage(const RenderedFrame& frame, const std::string& name) {
    return std::any_of(frame.statistics.stages.begin(), frame.statistics.stages.end(),
                       [&](const StageCost& stage) { return stage.name == name; });
}

std::ptrdiff_t stages_called(const RenderedFrame& frame, const std::string& name) {
    return std::count_if(frame.statistics.stages.begin(), frame.statistics.stages.end(),
                         [&](const StageCost& stage) { return stage.name == name; });
}

// SM remains the grid's, a mirror shows smoke that the grid has lit, and SV has the same mean by lights as by the grid.
TEST(FireLightPlans, LeaveTheSmokesLightOnSurfacesToTheGrid) {
    const Medium medium = smoke(0.0f);
    const Surroundings set = floor_of_metal();
    for (const int bounces : {1, -1}) {
        Shot lights = small_shot("light_tree"), grid = small_shot(kFireByHierarchy);
        lights.scattering.bounces = grid.scattering.bounces = bounces;
        lights.camera.samples_per_axis = grid.camera.samples_per_axis = 4;
        const Image a = rendered(grid, medium, &set).image, b = rendered(lights, medium, &set).image;
        EXPECT_NE(a.layer("SV").pixels, b.layer("SV").pixels);
        EXPECT_NEAR(mean_of(a, "SV"), mean_of(b, "SV"), 0.05 * mean_of(a, "SV"));
        // Where either of fire and smoke may be hidden in part, samples test both by themselves (base_lighting.h).
        if (bounces < 0) {
            EXPECT_LT(difference(a, b, "SM"), 0.02);
        }
        EXPECT_NEAR(mean_of(a, "MV"), mean_of(b, "MV"), 0.05 * mean_of(a, "MV"));
    }
}

// The hierarchy's lights are kept for surfaces once, for the smoke's, and not at all where smoke does not light them.
TEST(FireLightPlans, PrepareNoHierarchyForFireOnSurfaces) {
    const Medium medium = smoke(0.0f);
    const Surroundings set = floor_of_metal();
    for (const int bounces : {1, -1}) {
        Shot lights = small_shot("intensity"), grid = small_shot(kFireByHierarchy);
        lights.scattering.bounces = grid.scattering.bounces = bounces;
        const RenderedFrame a = rendered(grid, medium, &set), b = rendered(lights, medium, &set);
        EXPECT_EQ(stages_called(a, "lights for surfaces"), bounces < 0 ? 2 : 1);
        EXPECT_EQ(stages_called(b, "lights for surfaces"), bounces < 0 ? 1 : 0);
        EXPECT_EQ(has_stage(b, "lights and hierarchy"), bounces < 0);
    }
}

// The half of the fire's light that a window lets through is SS and the grid's.
TEST(FireLightPlans, LeaveLightThroughPanesToTheGrid) {
    Scene scene;
    add_quad(scene, {-4, -4, -1.4f}, {8, 0, 0}, {0, 8, 0}, lambert(0.5f));
    SceneMaterial glass = lambert(1.0f);
    glass.surface.transmission = 1.0f;
    glass.surface.specular = 1.0f;
    glass.surface.roughness = 0.0f;
    glass.surface.thin = true;
    add_quad(scene, {0.1f, -4, -1.15f}, {4, 0, 0}, {0, 8, 0}, glass);
    const Surroundings set(std::move(scene), {});
    const Medium medium = smoke(0.0f);
    Shot lights = small_shot("light_tree"), grid = small_shot(kFireByHierarchy);
    for (Shot* const shot : {&lights, &grid}) {
        shot->virtual_lights.count = 64;
        shot->camera.samples_per_axis = 4;
    }
    const RenderedFrame a = rendered(grid, medium, &set), b = rendered(lights, medium, &set);
    EXPECT_EQ(stages_called(b, "lights for surfaces"), 2);
    // Behind the glass the camera sees SV of the floor as SS.
    EXPECT_NEAR(mean_of(a.image, "SS"), mean_of(b.image, "SS"), 0.05 * mean_of(a.image, "SS"));
    EXPECT_NEAR(mean_of(a.image, "SV"), mean_of(b.image, "SV"), 0.05 * mean_of(a.image, "SV"));
}

// Light in the peak of the phase function counts as not scattered, in SV as in SM that the grid computes.
TEST(FireLightPlans, CountPeaksAsTheGridDoes) {
    const Medium medium = smoke(0.9f);
    const Surroundings set = floor_of_metal();
    Shot lights = small_shot("stochastic_lightcuts"), grid = small_shot(kFireByHierarchy);
    lights.camera.samples_per_axis = grid.camera.samples_per_axis = 4;
    lights.fire_lights.stochastic_cut_size = 40;
    const RenderedFrame a = rendered(grid, medium, &set), b = rendered(lights, medium, &set);
    EXPECT_TRUE(has_stage(b, "lights of the fire, through smoke without peaks"));
    EXPECT_NEAR(mean_of(a.image, "SV"), mean_of(b.image, "SV"), 0.04 * mean_of(a.image, "SV"));
    Shot once = lights;
    once.scattering.bounces = 1;
    const RenderedFrame c = rendered(once, medium, &set);
    EXPECT_FALSE(has_stage(c, "lights of the fire, through smoke without peaks"));
    EXPECT_LT(mean_of(c.image, "SV"), 0.93 * mean_of(b.image, "SV"));
    std::printf("SV of the grid %.4g, of lights %.4g, of light that did not scatter %.4g\n", mean_of(a.image, "SV"),
                mean_of(b.image, "SV"), mean_of(c.image, "SV"));
}

TEST(FireLightPlans, RefuseLampsInThePlaceOfTheFire) {
    try {
        parse_shot(R"({"volume": {"file": "a.vdb"}, "lighting": {"clusters": 4}, "fire_lights": {"sampling": "all"}})",
                   "a.json", "folder");
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Usage);
        EXPECT_NE(std::string(error.what()).find("hierarchy"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace brisance
