// What glossy surfaces show: of other surfaces by narrow lobes, of everything by rough ones, which pixels share.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "fixtures/cell_means.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"

namespace brisance {
namespace {

using namespace testing;

const Medium& small_burst() {
    static const Medium medium = [] {
        Recipe recipe = glowing_ball(12, 2.0f);
        recipe.settings.smoke.albedo = Rgb(0.8f);
        return make_medium(recipe);
    }();
    return medium;
}

SceneMaterial metal(float roughness) {
    SceneMaterial m = lambert(0.8f);
    m.surface.metallic = 1.0f;
    m.surface.roughness = roughness;
    return m;
}

// Varnish over a dark base.
SceneMaterial varnish(float roughness) {
    SceneMaterial m = lambert(0.1f);
    m.surface.specular = 1.0f;
    m.surface.roughness = roughness;
    return m;
}

// A floor under a ball of fire and smoke, between a wall behind and one aside; a lamp above.
Surroundings corner(const SceneMaterial& floor, const SceneMaterial& back, const SceneMaterial& side) {
    Scene scene;
    scene.origin = small_burst().world_of_local(vec3(0.0f));
    add_quad(scene, {-3, -3, -1.4f}, {6, 0, 0}, {0, 6, 0}, floor);
    add_quad(scene, {-3, 3, -1.4f}, {6, 0, 0}, {0, 0, 4}, back);
    add_quad(scene, {-3, -3, -1.4f}, {0, 6, 0}, {0, 0, 4}, side);
    scene.meshes.back().triangles = {{0, 1, 2}, {0, 2, 3}};
    add_quad(scene, {0.5f, 0.5f, 2.4f}, {0, 0.8f, 0}, {0.8f, 0, 0}, emitting(Rgb(1.0f)));
    return Surroundings(std::move(scene), {});
}

// `close`: a part of the floor, whose pixels are small beside what they may share over.
Shot shot_of(RenderMethod method, double sharing, std::uint32_t seed, bool close) {
    Shot shot;
    shot.method = method;
    shot.camera_given = true;
    shot.camera.eye = {2.0, -7.0, 1.6};
    shot.camera.target = close ? dvec3(0.5, -1.5, -1.4) : dvec3(0.0, 0.0, -0.6);
    shot.camera.vertical_fov_degrees = close ? 5.0 : 40.0;
    shot.camera.width = 40;
    shot.camera.height = 30;
    shot.camera.samples_per_axis = 4;
    shot.tracing.samples = 256;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights.count = 1500;
    shot.virtual_lights.photons = 200000;
    shot.virtual_lights.sharing_radius = sharing;
    shot.virtual_lights.seed = seed;
    return shot;
}

RenderedFrame rendered(const Surroundings& set, RenderMethod method, double sharing = 0.2, std::uint32_t seed = 0,
                       bool close = false) {
    Progress silent;
    return render_medium(shot_of(method, sharing, seed, close), small_burst(), silent, &set);
}

// Variance of a pixel for want of samples, by two pictures.
double noise_of(const Image& a, const Image& b, const std::string& cell) {
    const std::vector<float>&x = a.layer(cell).pixels, &y = b.layer(cell).pixels;
    double squares = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
        squares += 0.5 * (double(x[i]) - y[i]) * (double(x[i]) - y[i]);
    return squares / double(x.size());
}

// Puddle, window and wall: a narrow lobe shows a surface, another narrow lobe there shows a third. And as rough ones.
// One picture's SS has a standard error of 2 %; four of them have half of it.
class GlossySurfaces : public ::testing::TestWithParam<float> {};

TEST_P(GlossySurfaces, EveryCellIsThePathTracers) {
    const float roughness = GetParam();
    const Surroundings set = corner(varnish(roughness), metal(roughness), lambert(0.6f));
    const RenderedFrame paths = rendered(set, RenderMethod::Path);
    constexpr std::uint32_t kPictures = 4;
    std::map<std::string, double> grid;
    for (std::uint32_t seed = 0; seed < kPictures; ++seed) {
        const Image image = rendered(set, RenderMethod::LightingGrid, 0.2, seed).image;
        for (const std::string cell : {"SV", "SM", "SA", "SS"})
            grid[cell] += mean_of(image, cell) / kPictures;
    }
    for (const auto& [cell, ours] : grid) {
        const double truth = mean_of(paths.image, cell);
        const double noise = std::abs(mean_of(paths.halves[0], cell) - mean_of(paths.halves[1], cell));
        EXPECT_NEAR(ours, truth, 0.04 * truth + 1.5 * noise) << cell;
        std::printf("%s %.5f, paths %.5f (%+.2f %%)\n", cell.c_str(), ours, truth, 100.0 * (ours / truth - 1.0));
    }
}

INSTANTIATE_TEST_SUITE_P(Roughness, GlossySurfaces, ::testing::Values(0.1f, 0.5f));

// Rough lobes reflect the same, with a fraction of the noise: of fire, smoke and lamp.
TEST(GlossySurfacesShared, KeepTheirEnergyAndLoseTheirNoise) {
    const Surroundings set = corner(varnish(0.5f), metal(0.5f), lambert(0.6f));
    std::map<double, Image> one, other;
    for (const double radius : {0.0, 0.2}) {
        one[radius] = rendered(set, RenderMethod::LightingGrid, radius, 0, true).image;
        other[radius] = rendered(set, RenderMethod::LightingGrid, radius, 1, true).image;
    }
    for (const std::string cell : {"SV", "SM", "SA"}) {
        const double alone = mean_of(one[0.0], cell) + mean_of(other[0.0], cell),
                     shared = mean_of(one[0.2], cell) + mean_of(other[0.2], cell);
        const double before = noise_of(one[0.0], other[0.0], cell), after = noise_of(one[0.2], other[0.2], cell);
        std::printf("%s: mean %+.2f %%, noise %.2f of before\n", cell.c_str(), 100.0 * (shared / alone - 1.0),
                    std::sqrt(after / before));
        EXPECT_NEAR(shared, alone, 0.01 * alone) << cell;
        EXPECT_LT(after, 0.5 * before) << cell;
    }
}

// Pixels whose samples are shaded in rounds show the same light on average as those that shade all: of six pictures
// each, within four standard errors as their spread tells, and 0.3 %.
TEST(GlossySurfacesInRounds, KeepTheLightOfAllSamples) {
    constexpr int kPictures = 6;
    const Surroundings set = corner(varnish(0.2f), metal(0.5f), lambert(0.6f));
    Progress silent;
    std::map<std::string, std::array<double, 2>> sums, squares;
    for (int k = 0; k < kPictures; ++k)
        for (const bool all : {false, true}) {
            Shot shot = shot_of(RenderMethod::LightingGrid, 0.2, std::uint32_t(k), false);
            shot.camera.samples_per_axis = all ? 4 : 0;
            const Image image = render_medium(shot, small_burst(), silent, &set).image;
            for (const std::string cell : {"SV", "SM", "SA", "SS"}) {
                const double mean = mean_of(image, cell);
                sums[cell][all] += mean / kPictures;
                squares[cell][all] += mean * mean / kPictures;
            }
        }
    for (const auto& [cell, mean] : sums) {
        const auto variance = [&](int i) { return squares[cell][i] - mean[i] * mean[i]; };
        const double error = std::sqrt((variance(0) + variance(1)) / (kPictures - 1));
        EXPECT_NEAR(mean[0], mean[1], 4.0 * error + 0.003 * mean[1]) << cell;
        std::printf("%s %+.2f ± %.2f %%\n", cell.c_str(), 100.0 * (mean[0] / mean[1] - 1.0), 100.0 * error / mean[1]);
    }
}

}  // namespace
}  // namespace brisance
