// Pictures whose MM and SM are owned by ray lights, or by point lights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/plan.h"
#include "render/render_frame.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kSide = 20;

Shot small_shot(RenderMethod method, ScatteringMethod scattering) {
    Shot shot;
    shot.method = method;
    shot.camera_given = true;
    shot.camera.eye = {0.3, -5.0, 1.5};
    shot.camera.target = {0.0, 0.0, -0.2};
    shot.camera.vertical_fov_degrees = 32.0;
    shot.camera.width = shot.camera.height = kSide;
    shot.camera.samples_per_axis = 2;
    shot.tracing.samples = 64;
    shot.virtual_lights.count = 0;
    shot.ray_lights.method = scattering;
    shot.ray_lights.paths = 4000;
    shot.ray_lights.count = 30000;
    shot.ray_lights.samples = 4;
    shot.point_lights.paths = 4000;
    shot.point_lights.count = 6000;
    return shot;
}

Medium smoke(float mean_cosine) {
    Recipe r = glowing_ball(8, 2.0f);
    r.settings.smoke.albedo = Rgb(0.8f);
    r.settings.smoke.mean_cosine = mean_cosine;
    r.flame = [](const ivec3& n) { return n.x < 0 ? 1.0f : 0.0f; };
    return make_medium(r);
}

// Plain to the left, half a mirror to the right.
Surroundings floor_of_two() {
    Scene scene;
    SceneMaterial glossy = lambert(0.5f);
    glossy.surface.metallic = 0.5f;
    glossy.surface.roughness = 0.3f;
    glossy.surface.specular = 1.0f;
    add_quad(scene, {-4, -4, -1.1f}, {4, 0, 0}, {0, 8, 0}, lambert(0.7f));
    add_quad(scene, {0, -4, -1.1f}, {4, 0, 0}, {0, 8, 0}, glossy);
    return Surroundings(std::move(scene), {});
}

double mean_of(const Image& image, const char* layer) {
    const std::vector<float>& pixels = image.layer(layer).pixels;
    double sum = 0.0;
    for (const float v : pixels)
        sum += v / double(pixels.size());
    return sum;
}

struct Sets {
    double mean = 0.0, error = 0.0;
};

// Over independent sets of lights.
Sets over_sets(Shot shot, const Medium& medium, const Surroundings* set, const char* layer) {
    constexpr int kSets = 10;
    double sum = 0.0, square = 0.0;
    Progress silent;
    for (int i = 0; i < kSets; ++i) {
        shot.ray_lights.seed = shot.point_lights.seed = static_cast<std::uint32_t>(i);
        const double mean = mean_of(render_medium(shot, medium, silent, set).image, layer);
        sum += mean / kSets;
        square += mean * mean / kSets;
    }
    return {sum, std::sqrt(std::max(0.0, square - sum * sum) / (kSets - 1))};
}

void expect_as_paths(ScatteringMethod scattering, const Medium& medium, const Surroundings* set, const char* layer) {
    Progress silent;
    const RenderedFrame paths = render_medium(small_shot(RenderMethod::Path, scattering), medium, silent, set);
    const double a = mean_of(paths.halves[0], layer), b = mean_of(paths.halves[1], layer);
    const Sets lights = over_sets(small_shot(RenderMethod::LightingGrid, scattering), medium, set, layer);
    const double error = std::hypot(lights.error, 0.5 * (a - b));
    std::printf("%s, %s: paths %.5g, lights %.5g, standard error %.2g\n", name_of(scattering), layer, 0.5 * (a + b),
                lights.mean, error);
    // The camera's samples differ: half a percent.
    EXPECT_NEAR(lights.mean, 0.5 * (a + b), 3.0 * error + 0.005 * a) << layer;
    EXPECT_LT(error, 0.05 * a) << layer;
}

class LightsInSmokePictures : public ::testing::TestWithParam<ScatteringMethod> {};

INSTANTIATE_TEST_SUITE_P(Kinds, LightsInSmokePictures,
                         ::testing::Values(ScatteringMethod::RayLights, ScatteringMethod::PointLights),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

TEST_P(LightsInSmokePictures, SmokeIsAsPathsSeeIt) {
    expect_as_paths(GetParam(), smoke(0.0f), nullptr, "MM");
    expect_as_paths(GetParam(), smoke(0.6f), nullptr, "MM");
}

TEST_P(LightsInSmokePictures, SmokeOverAFloorIsAsPathsSeeIt) {
    const Surroundings set = floor_of_two();
    expect_as_paths(GetParam(), smoke(0.0f), &set, "MM");
    expect_as_paths(GetParam(), smoke(0.0f), &set, "SM");
}

TEST_P(LightsInSmokePictures, ThreadsChangeNothing) {
    const Medium medium = smoke(0.6f);
    const Surroundings set = floor_of_two();
    const auto pixels = [&](int threads) {
        const ThreadLimit limit(threads);
        Progress silent;
        return render_medium(small_shot(RenderMethod::LightingGrid, GetParam()), medium, silent, &set)
            .image.layer("")
            .pixels;
    };
    EXPECT_EQ(pixels(1), pixels(2));
}

bool skips(const Plan& plan, const char* part) {
    return std::any_of(plan.skipped.begin(), plan.skipped.end(), [&](const SkippedPart& s) { return s.name == part; });
}

TEST_P(LightsInSmokePictures, NothingIsTracedForWhatIsNotThere) {
    const Shot shot = small_shot(RenderMethod::LightingGrid, GetParam());
    const Medium medium = smoke(0.0f);
    EXPECT_TRUE(plan_cells(shot, medium).scattered_lights);
    EXPECT_TRUE(skips(plan_cells(shot, medium), "scattered hierarchies"));
    EXPECT_FALSE(plan_cells(shot, Medium{}).scattered_lights);
    EXPECT_FALSE(plan_cells(small_shot(RenderMethod::Path, GetParam()), medium).scattered_lights);
    Shot once = shot;
    once.scattering.bounces = 1;
    EXPECT_FALSE(plan_cells(once, medium).scattered_lights);
    const std::string kind = GetParam() == ScatteringMethod::RayLights ? "ray lights" : "point lights";
    EXPECT_TRUE(skips(plan_cells(once, medium), kind.c_str()));
    Progress silent;
    for (const StageCost& stage : render_medium(once, medium, silent).statistics.stages)
        EXPECT_EQ(stage.name.find(kind), std::string::npos);
}

TEST_P(LightsInSmokePictures, MarchingIsRefused) {
    Shot shot = small_shot(RenderMethod::LightingGrid, GetParam());
    shot.lighting.gather = GatherMethod::RayMarch;
    Progress silent;
    EXPECT_THROW(render_medium(shot, smoke(0.0f), silent), Error);
}

}  // namespace
}  // namespace brisance
