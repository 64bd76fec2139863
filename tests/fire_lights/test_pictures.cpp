// Pictures whose MV comes from the fire's single lights: every cell has one owner, and all others are as before.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

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
    Shot traced = small_shot(kFireByHierarchy), lit = small_shot(GetParam());
    traced.method = RenderMethod::Path;
    traced.scattering.bounces = lit.scattering.bounces = 1;
    lit.fire_lights.points = GetParam() == "all" ? 1 : 8;
    lit.fire_lights.lightcuts_error = 0.002;
    const RenderedFrame paths = rendered(traced, medium);
    const double a = mean_of(paths.halves[0], "MV"), b = mean_of(paths.halves[1], "MV"), truth = 0.5 * (a + b);
    double sum = 0.0, square = 0.0;
    for (int seed = 0; seed < kSeeds; ++seed) {
        lit.fire_lights.seed = static_cast<std::uint32_t>(seed);
        const double mean = mean_of(rendered(lit, medium).image, "MV");
        sum += mean / kSeeds;
        square += mean * mean / kSeeds;
    }
    const double error = std::hypot(std::sqrt(std::max(0.0, square - sum * sum) / (kSeeds - 1)), 0.5 * (a - b));
    std::printf("%s: MV of paths %.5g, of lights %.5g, standard error %.2g\n", GetParam().c_str(), truth, sum, error);
    EXPECT_NEAR(sum, truth, 4.0 * error + 0.005 * truth);
    EXPECT_LT(error, 0.05 * truth);
}

TEST_P(FireLightPictures, AreTheSameOnAnyNumberOfThreads) {
    const Medium medium = smoke(0.4f);
    Shot shot = small_shot(GetParam());
    shot.scattering.bounces = 1;
    shot.fire_lights.points = GetParam() == "all" ? 1 : 3;
    const auto pixels = [&](int threads) {
        const ThreadLimit limit(threads);
        return rendered(shot, medium).image.layer("").pixels;
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

// SV and SM remain the grid's, and a mirror shows smoke that the grid has lit.
TEST(FireLightPlans, LeaveSurfacesToTheGrid) {
    const Medium medium = smoke(0.0f);
    const Surroundings set = floor_of_metal();
    for (const int bounces : {1, -1}) {
        Shot lights = small_shot("light_tree"), grid = small_shot(kFireByHierarchy);
        lights.scattering.bounces = grid.scattering.bounces = bounces;
        const Image a = rendered(grid, medium, &set).image, b = rendered(lights, medium, &set).image;
        EXPECT_EQ(a.layer("SV").pixels, b.layer("SV").pixels);
        if (bounces < 0) {
            EXPECT_EQ(a.layer("SM").pixels, b.layer("SM").pixels);
        }
        EXPECT_NEAR(mean_of(a, "MV"), mean_of(b, "MV"), 0.05 * mean_of(a, "MV"));
    }
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
