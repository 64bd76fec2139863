// Pictures whose cells come from lights of all kinds together, on surfaces and in smoke: layers add up, other cells
// stay, and what does not go together is refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "camera_rays/pixel_rays.h"
#include "core/error.h"
#include "core/parallel.h"
#include "fixtures/instant_radiosity.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "forecast/plan.h"
#include "render/render_frame.h"
#include "shot/read_shot.h"

namespace brisance {
namespace {

using namespace testing;

constexpr const char* kApart = "none";

Shot small_shot(const std::string& sampling) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = {0.3, -5.0, 1.5};
    shot.camera.target = {0.0, 0.0, -0.2};
    shot.camera.vertical_fov_degrees = 40.0;
    shot.camera.width = shot.camera.height = 8;
    shot.camera.samples_per_axis = 2;
    shot.certify.belief = 0.0;
    shot.correction.samples = 0;  // by lights alone
    shot.scattering_methods.method = kLightingGridMethod;
    shot.virtual_lights = instant_radiosity("point", 200, 5000);
    shot.unified_lights.sampling = sampling;
    shot.unified_lights.samples = 8;
    return shot;
}

Medium smoke() {
    Recipe r = glowing_ball(4, 2.0f);
    r.settings.smoke.albedo = Rgb(0.8f);
    r.flame = [](const ivec3& n) { return n.x < 0 && n.y < 0 ? 1.0f : 0.0f; };
    return make_medium(r);
}

// A floor, half a mirror, a wall, a lamp, a sun and a sky.
Surroundings set_with_lights() {
    Scene scene;
    add_quad(scene, {-4, -4, -1.4f}, {8, 0, 0}, {0, 8, 0}, lambert(0.5f));
    add_quad(scene, {-4, 2, -1.4f}, {8, 0, 0}, {0, 0, 4}, lambert(0.6f));
    SceneMaterial mirror = lambert(0.9f);
    mirror.surface.metallic = 1.0f;
    mirror.surface.roughness = 0.0f;
    add_quad(scene, {1.2f, -3, -1.3f}, {1.2f, 0, 0}, {0, 4, 0}, mirror);
    LightSettings lamp, sun, sky;
    lamp.position = {-1.5, -1.0, 1.0};
    lamp.power = Rgb(0.6f);
    sun.kind = LightKind::Sun;
    sun.direction = {0.5, 0.3, -1.0};
    sun.power = Rgb(0.2f, 0.3f, 0.5f);
    sky.kind = LightKind::Environment;
    sky.power = Rgb(0.1f, 0.15f, 0.2f);
    return Surroundings(std::move(scene), {lamp, sun, sky});
}

RenderedFrame rendered(const Shot& shot, const Medium& medium, const Surroundings* set) {
    Progress silent;
    return render_medium(shot, medium, silent, set);
}

std::vector<std::string> all_samplings() {
    std::vector<std::string> names;
    for (const UnifiedLightSampling& row : unified_light_samplings())
        names.emplace_back(row.name);
    return names;
}

class UnifiedPictures : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Samplings, UnifiedPictures, ::testing::ValuesIn(all_samplings()),
                         [](const auto& sampling) { return sampling.param; });

std::vector<double> sum_of_cells(const Image& image, std::size_t pixels) {
    std::vector<double> sums(pixels * 3, 0.0);
    for (const Layer& layer : image.layers)
        if (std::find(kCellNames.begin(), kCellNames.end(), layer.name) != kCellNames.end())
            for (std::size_t p = 0; p < pixels; ++p)
                for (std::size_t c = 0; c < 3; ++c)
                    sums[3 * p + c] += layer.pixels[p * layer.channels.size() + c];
    return sums;
}

// Cells add up to the picture, pixel by pixel, also behind the mirror. MM remains the grid's, whose series begins with
// MV, MS and MA of its nodes, and SM too.
TEST_P(UnifiedPictures, AddUp) {
    const Medium medium = smoke();
    const Surroundings set = set_with_lights();
    Shot shot = small_shot(GetParam());
    const Image unified = rendered(shot, medium, &set).image;
    shot.unified_lights.smoke = false;
    const Image on_surfaces = rendered(shot, medium, &set).image;
    const Image apart = rendered(small_shot(kApart), medium, &set).image;
    const Layer& beauty = unified.layer("");
    const std::size_t channels = beauty.channels.size(), pixels = beauty.pixels.size() / channels;
    const std::vector<double> sums = sum_of_cells(unified, pixels);
    for (std::size_t p = 0; p < pixels; ++p)
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(beauty.pixels[p * channels + c], sums[3 * p + c], 1e-5 * (1.0 + sums[3 * p + c])) << p;
    for (const char* cell : {"V", "A", "MM"})
        EXPECT_EQ(unified.layer(cell).pixels, apart.layer(cell).pixels) << cell;
    for (const char* cell : {"MV", "MA", "MS"}) {
        EXPECT_NE(unified.layer(cell).pixels, apart.layer(cell).pixels) << cell;
        EXPECT_EQ(on_surfaces.layer(cell).pixels, apart.layer(cell).pixels) << cell;
    }
    for (const char* cell : {"SV", "SS", "SA"}) {
        EXPECT_NE(unified.layer(cell).pixels, apart.layer(cell).pixels) << cell;
        EXPECT_EQ(unified.layer(cell).pixels, on_surfaces.layer(cell).pixels) << cell;
    }
}

// Three tiles of rays, and more points of surfaces than one thread lights at once, so that threads do take turns.
// Floor, wall, mirror and smoke are in it. No light is well sampled, as none has to be.
Shot shot_for_threads(const std::string& sampling) {
    Shot shot = small_shot(sampling);
    shot.camera.target.z = -0.5;
    shot.camera.vertical_fov_degrees = 14.0;
    shot.camera.width = 2 * kSideOfTile + kSideOfTile / 2;
    shot.camera.samples_per_axis = 1;
    shot.virtual_lights = instant_radiosity("point", 100, 5000);
    shot.unified_lights.points = 2;
    shot.unified_lights.samples = 2;
    return shot;
}

TEST_P(UnifiedPictures, AreTheSameOnAnyNumberOfThreads) {
    const Medium medium = smoke();
    const Surroundings set = set_with_lights();
    const auto pixels = [&](int threads) {
        const ThreadLimit limit(threads);
        return rendered(shot_for_threads(GetParam()), medium, &set).image.layer("").pixels;
    };
    EXPECT_EQ(pixels(1), pixels(3));
}

// Nothing of the fire is prepared twice: no hierarchy for the base of surfaces, and no choice of the fire's alone.
TEST(UnifiedPlans, OwnTheFireOnSurfaces) {
    const Medium medium = smoke();
    const Surroundings set = set_with_lights();
    Shot shot = small_shot("stochastic_lightcuts");
    shot.scattering.bounces = 1;
    shot.fire_lights.sampling = "light_tree";
    shot.unified_lights.smoke = false;
    const Plan plan = plan_cells(shot, medium, &set);
    ASSERT_NE(plan.unified_sampling, nullptr);
    EXPECT_TRUE(plan.fire_lights_on_surfaces());
    EXPECT_NE(plan.fire_sampling, nullptr) << "MV remains its own";
    const RenderedFrame frame = rendered(shot, medium, &set);
    const auto stages = [&](const char* name) {
        return std::count_if(frame.statistics.stages.begin(), frame.statistics.stages.end(),
                             [&](const StageCost& stage) { return stage.name == name; });
    };
    EXPECT_EQ(stages("lights of all kinds"), 1);
    EXPECT_EQ(stages("lights for surfaces"), 0);
    EXPECT_EQ(plan_cells(shot, medium).unified_sampling, nullptr) << "no surfaces, and not in smoke";
    shot.method = RenderMethod::Path;
    EXPECT_EQ(plan_cells(shot, medium, &set).unified_sampling, nullptr);
}

// In smoke as well, with what nodes hold left to MM; without virtual lights nothing stands for surfaces there.
TEST(UnifiedPlans, OwnTheSmokeOfRays) {
    const Medium medium = smoke();
    const Surroundings set = set_with_lights();
    Shot shot = small_shot("light_tree");
    const auto owned = [&](const Surroundings* around) { return plan_cells(shot, medium, around).on_rays; };
    EXPECT_EQ(owned(&set), (CellSet{Cell::MV, Cell::MS, Cell::MA}));
    EXPECT_EQ(owned(nullptr), (CellSet{Cell::MV}));
    EXPECT_EQ(plan_cells(shot, medium, &set).fire_sampling, nullptr);
    shot.virtual_lights.count = 0;
    EXPECT_EQ(owned(&set), (CellSet{Cell::MV, Cell::MA}));
    shot.unified_lights.smoke = false;
    EXPECT_EQ(owned(&set), CellSet{});
}

TEST(UnifiedPlans, RefuseWhatDoesNotGoTogether) {
    const auto refusal = [](const std::string& other, const std::string& more = {}) {
        try {
            parse_shot(R"({"volume": {"file": "a.vdb"}, "unified_lights": {"sampling": "lightcuts")" + more + "}, " +
                           other + "}",
                       "a.json", "folder");
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::Usage);
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(refusal(R"("lighting": {"clusters": 4})").find("lighting.clusters=0"), std::string::npos);
    EXPECT_NE(refusal(R"("virtual_lights": {"sampling": "resampled", "resampling_neighbours": 4})")
                  .find("resampling_neighbours=0"),
              std::string::npos);
    EXPECT_NE(refusal(R"("virtual_lights": {"kind": "point", "path_extension": false},
                         "output": {"layers": {"bound": true}})")
                  .find("output.layers.bound=false"),
              std::string::npos);
    const std::string of_fire = refusal(R"("fire_lights": {"sampling": "all"})");
    EXPECT_NE(of_fire.find("fire_lights.sampling=hierarchy"), std::string::npos) << of_fire;
    EXPECT_NE(of_fire.find("unified_lights.smoke=false"), std::string::npos) << of_fire;
    EXPECT_EQ(refusal(R"("fire_lights": {"sampling": "all"})", R"(, "smoke": false)"), "");
}

}  // namespace
}  // namespace brisance
