// Pictures whose MM and SM are owned by a scattering method of the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/parallel.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "forecast/plan.h"
#include "light_selection/progressive_radius.h"
#include "render/render_frame.h"

namespace brisance::test_in_scattering {
namespace {

using namespace testing;

constexpr int kSide = 20;

RayLightSettings& rays_of(Shot& shot) {
    return shot.scattering_methods.get<RayLightSettings>();
}
VolumetricVplSettings& vpls_of(Shot& shot) {
    return shot.scattering_methods.get<VolumetricVplSettings>();
}
VolumetricPhotonSettings& photons_of(Shot& shot) {
    return shot.scattering_methods.get<VolumetricPhotonSettings>();
}
PhotonDensitySettings& densities_of(Shot& shot) {
    return shot.scattering_methods.get<PhotonDensitySettings>();
}

Shot small_shot(RenderMethod method, const std::string& scattering = RayLightsMethod::kName) {
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
    // Only MM and SM are looked at, which the scattering method owns: MV, MS and what is believed need not be good.
    shot.lighting.error = 0.2f;
    shot.virtual_lights.photons = 30000;
    shot.certify.belief = 0.0;
    shot.correction.samples = 0;  // by lights alone
    shot.scattering_methods.method = scattering;
    rays_of(shot).paths = 4000;
    rays_of(shot).count = 30000;
    rays_of(shot).samples = 4;
    vpls_of(shot).paths = 4000;
    vpls_of(shot).count = 6000;
    photons_of(shot).paths = 100000;
    photons_of(shot).neighbours = 32;
    densities_of(shot).paths = 50000;
    densities_of(shot).radius = 0.05;
    densities_of(shot).neighbours = 32;
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

using Layers = std::vector<const char*>;

// Each of these layers over independent sets of lights.
std::vector<Sets> over_sets(Shot shot, const Medium& medium, const Surroundings* set, const Layers& layers) {
    constexpr int kSets = 10;
    std::vector<double> sum(layers.size(), 0.0), square(layers.size(), 0.0);
    Progress silent;
    for (int i = 0; i < kSets; ++i) {
        rays_of(shot).seed = vpls_of(shot).seed = photons_of(shot).seed = densities_of(shot).seed =
            static_cast<std::uint32_t>(i);
        const Image image = render_medium(shot, medium, silent, set).image;
        for (std::size_t l = 0; l < layers.size(); ++l) {
            const double mean = mean_of(image, layers[l]);
            sum[l] += mean / kSets;
            square[l] += mean * mean / kSets;
        }
    }
    std::vector<Sets> out;
    for (std::size_t l = 0; l < layers.size(); ++l)
        out.push_back({sum[l], std::sqrt(std::max(0.0, square[l] - sum[l] * sum[l]) / (kSets - 1))});
    return out;
}

RenderedFrame by_paths(const Medium& medium, const Surroundings* set) {
    Progress silent;
    return render_medium(small_shot(RenderMethod::Path), medium, silent, set);
}

void expect_as_paths(const RenderedFrame& paths, const Shot& by_lights, const Medium& medium, const Surroundings* set,
                     const Layers& layers, double bias = 0.0) {
    const std::string scattering = by_lights.scattering_methods.method;
    const std::vector<Sets> lights = over_sets(by_lights, medium, set, layers);
    for (std::size_t l = 0; l < layers.size(); ++l) {
        const double a = mean_of(paths.halves[0], layers[l]), b = mean_of(paths.halves[1], layers[l]);
        const double error = std::hypot(lights[l].error, 0.5 * (a - b));
        std::printf("%s, %s: paths %.5g, lights %.5g, standard error %.2g\n", scattering.c_str(), layers[l],
                    0.5 * (a + b), lights[l].mean, error);
        // The camera's samples differ: half a percent.
        EXPECT_NEAR(lights[l].mean, 0.5 * (a + b), 3.0 * error + (0.005 + bias) * a) << layers[l];
        EXPECT_LT(error, 0.05 * a) << layers[l];
    }
}

std::vector<std::string> all_methods() {
    std::vector<std::string> names;
    for (const ScatteringMethod& method : scattering_methods())
        names.push_back(method.name);
    return names;
}

class LightsInSmokePictures : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Kinds, LightsInSmokePictures, ::testing::ValuesIn(all_methods()),
                         [](const auto& kind) { return kind.param; });

// Particles are blurred over voxels, eight of which make the smoke's radius; photon beams over a 20th of it.
double blur_of(const std::string& method) {
    return method == std::string(VolumetricPhotonsMethod::kName) ? 0.02
           : method == std::string(PhotonDensityMethod::kName)   ? 0.01
                                                                 : 0.0;
}

TEST_P(LightsInSmokePictures, SmokeIsAsPathsSeeIt) {
    const Shot shot = small_shot(RenderMethod::LightingGrid, GetParam());
    // One truth for all kinds.
    static const RenderedFrame even = by_paths(smoke(0.0f), nullptr), forward = by_paths(smoke(0.6f), nullptr);
    expect_as_paths(even, shot, smoke(0.0f), nullptr, {"MM"}, blur_of(GetParam()));
    expect_as_paths(forward, shot, smoke(0.6f), nullptr, {"MM"}, blur_of(GetParam()));
}

TEST_P(LightsInSmokePictures, SmokeOverAFloorIsAsPathsSeeIt) {
    const Surroundings set = floor_of_two();
    const Shot shot = small_shot(RenderMethod::LightingGrid, GetParam());
    static const RenderedFrame paths = by_paths(smoke(0.0f), &set);  // one truth for all kinds
    expect_as_paths(paths, shot, smoke(0.0f), &set, {"MM", "SM"}, blur_of(GetParam()));
}

TEST_P(LightsInSmokePictures, ThreadsChangeNothing) {
    const Medium medium = smoke(0.6f);
    const Surroundings set = floor_of_two();
    std::vector<Shot> shots = {small_shot(RenderMethod::LightingGrid, GetParam())};
    photons_of(shots.front()).paths = densities_of(shots.front()).paths = 10000;  // bits differ or not, however few
    if (GetParam() == std::string(RayLightsMethod::kName)) {                      // beams
        shots.push_back(shots.front());
        rays_of(shots.back()).radius = kAutomaticRadius;
        rays_of(shots.back()).passes = 2;
    }
    for (Shot& shot : shots) {
        const auto pixels = [&](int threads) {
            const ThreadLimit limit(threads);
            Progress silent;
            return render_medium(shot, medium, silent, &set).image.layer("").pixels;
        };
        EXPECT_EQ(pixels(1), pixels(2)) << "radius " << rays_of(shot).radius;
    }
}

// Passes are independent pictures, so that their mean has less noise.
TEST(RayLightPasses, HaveLessNoise) {
    const Medium medium = smoke(0.0f);
    Shot shot = small_shot(RenderMethod::LightingGrid);
    rays_of(shot).paths = 300;
    shot.camera.width = shot.camera.height = 10;
    const auto spread = [&](int passes) {
        rays_of(shot).passes = passes;
        const Sets sets = over_sets(shot, medium, nullptr, {"MM"}).front();
        return sets.error / sets.mean;
    };
    const double one = spread(1), six = spread(6);
    std::printf("relative standard error: one pass %.3g, six passes %.3g\n", one, six);
    EXPECT_LT(six, 0.75 * one);
}

const nlohmann::ordered_json& detail_of(const Statistics& statistics) {
    for (const StageCost& stage : statistics.stages)
        if (stage.name == "ray lights (MM, SM)")
            return stage.detail;
    throw std::runtime_error("no ray lights");
}

TEST(RayLightPasses, ShrinkBeamsAndDoNotAddUpInMemory) {
    const Medium medium = smoke(0.0f);
    Shot shot = small_shot(RenderMethod::LightingGrid);
    shot.camera.width = shot.camera.height = 4;
    const auto statistics = [&](double radius, int passes) {
        rays_of(shot).radius = radius;
        rays_of(shot).passes = passes;
        Progress silent;
        return render_medium(shot, medium, silent).statistics;
    };
    const auto bytes = [](const Statistics& s) {
        for (const StageCost& stage : s.stages)
            if (stage.name == "ray lights (MM, SM)")
                return double(stage.bytes);
        return 0.0;
    };
    const Statistics one = statistics(0.3, 1), four = statistics(0.3, 4), automatic = statistics(kAutomaticRadius, 4);
    EXPECT_EQ(detail_of(one)["last_radius"], 0.3);
    EXPECT_EQ(detail_of(four)["first_radius"], 0.3);
    EXPECT_DOUBLE_EQ(detail_of(four)["last_radius"].get<double>(),
                     0.3 * radius_shrunk(3, RayLightSettings{}.radius_reduction));
    EXPECT_NEAR(detail_of(automatic)["last_radius"].get<double>() / detail_of(automatic)["first_radius"].get<double>(),
                radius_shrunk(3, RayLightSettings{}.radius_reduction), 1e-9);
    EXPECT_EQ(detail_of(statistics(0.0, 2))["last_radius"], 0.0);
    EXPECT_EQ(detail_of(four)["particles"], 4 * detail_of(one)["particles"].get<int>());
    EXPECT_NEAR(bytes(four) / bytes(one), 1.0, 0.1);
}

// The mean of passes is the truth but for what is left of the blur.
TEST(RayLightPasses, AreAsPathsSeeThem) {
    Shot shot = small_shot(RenderMethod::LightingGrid);
    rays_of(shot).passes = 2;
    const Medium medium = smoke(0.3f);
    const RenderedFrame paths = by_paths(medium, nullptr);
    expect_as_paths(paths, shot, medium, nullptr, {"MM"});
    // Two per metre: 0.1 mean free paths.
    rays_of(shot).radius = 0.05;
    expect_as_paths(paths, shot, medium, nullptr, {"MM"}, 0.015);
    const Surroundings set = floor_of_two();
    expect_as_paths(by_paths(smoke(0.0f), &set), shot, smoke(0.0f), &set, {"SM"}, 0.015);
}

TEST(RayLightPasses, AreNotMadeWithoutSmoke) {
    const Surroundings set = floor_of_two();
    const Shot shot = small_shot(RenderMethod::LightingGrid);
    Progress silent;
    const RenderedFrame frame = render_medium(shot, Medium{}, silent, &set);
    for (const StageCost& stage : frame.statistics.stages)
        EXPECT_EQ(stage.name.find("ray lights"), std::string::npos);
    for (const float v : frame.image.layer("").pixels)
        EXPECT_TRUE(std::isfinite(v));
}

bool skips(const Plan& plan, const char* part) {
    return std::any_of(plan.skipped.begin(), plan.skipped.end(), [&](const SkippedPart& s) { return s.name == part; });
}

TEST_P(LightsInSmokePictures, NothingIsTracedForWhatIsNotThere) {
    const Shot shot = small_shot(RenderMethod::LightingGrid, GetParam());
    const Medium medium = smoke(0.0f);
    EXPECT_TRUE(plan_cells(shot, medium).scattering_method);
    EXPECT_TRUE(skips(plan_cells(shot, medium), "scattered hierarchies"));
    EXPECT_FALSE(plan_cells(shot, Medium{}).scattering_method);
    EXPECT_FALSE(plan_cells(small_shot(RenderMethod::Path, GetParam()), medium).scattering_method);
    Shot once = shot;
    once.scattering.bounces = 1;
    EXPECT_FALSE(plan_cells(once, medium).scattering_method);
    const std::string kind = find_scattering_method(GetParam())->product;
    EXPECT_TRUE(skips(plan_cells(once, medium), kind.c_str()));
    Progress silent;
    for (const StageCost& stage : render_medium(once, medium, silent).statistics.stages)
        EXPECT_EQ(stage.name.find(kind), std::string::npos);
}

// By the phase function and by what escapes, whatever holds the smoke.
TEST(ScatteringMethods, AreChosenByTheMedium) {
    std::string products;
    for (const ScatteringMethod& method : scattering_methods())
        products += (products.empty() ? "" : ", ") + method.product;
    const auto chosen = [&](float mean_cosine, float escape, const std::string& method) {
        Shot shot = small_shot(RenderMethod::LightingGrid, method);
        shot.scattering.escape = escape;
        const Plan plan = plan_cells(shot, smoke(mean_cosine));
        EXPECT_EQ(plan.scattering_method != nullptr, plan.scattering_choice != kLightingGridMethod);
        EXPECT_EQ(plan.share_of_method > 0.0f, plan.scattering_method != nullptr);
        EXPECT_EQ(skips(plan, products.c_str()), !plan.scattering_method);
        EXPECT_EQ(skips(plan, "scattered hierarchies"), plan.scattering_method && !plan.mixed());
        return plan.scattering_choice;
    };
    const auto automatic = std::string(kAutomaticMethod), grid = std::string(kLightingGridMethod),
               rays = std::string(RayLightsMethod::kName), particles = std::string(VolumetricPhotonsMethod::kName);
    EXPECT_EQ(chosen(0.8f, 1.0f, automatic), particles);
    EXPECT_EQ(chosen(-0.8f, 1.0f, automatic), particles);
    EXPECT_EQ(chosen(0.5f, 1.0f, automatic), particles);  // a half of it
    EXPECT_EQ(chosen(0.4f, 1.0f, automatic), grid);
    EXPECT_EQ(chosen(0.8f, 0.0f, automatic), grid);
    EXPECT_EQ(chosen(0.8f, 1.0f, grid), grid);
    EXPECT_EQ(chosen(0.0f, 0.0f, rays), rays);
}

}  // namespace
}  // namespace brisance::test_in_scattering
