// A wall without thickness in a room full of haze, with fire on one side: light reaches the other side only around it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"

namespace brisance::test_thin_walls {
namespace {

using namespace testing;

constexpr int kWidth = 32, kHeight = 24;

// Six metres of haze, and a ball of smoke that burns inside, to the left.
Medium burst_at_the_left() {
    Recipe recipe;
    recipe.box = cube(-24, 24);
    recipe.world_from_index = cubic(0.125);
    recipe.density = [](const ivec3& n) { return std::max(0.005f, 0.3f * ball(n, dvec3(-9.0, 0.0, 0.0), 6)); };
    recipe.flame = [](const ivec3& n) { return ball(n, dvec3(-9.0, 0.0, 0.0), 5); };
    recipe.settings = black_smoke();
    recipe.settings.smoke.extinction_per_metre = 12.0f;
    recipe.settings.smoke.albedo = Rgb(0.8f);
    return make_medium(recipe);
}

// A floor, and the wall in the middle, which leaves the upper half open.
Surroundings floor_and_wall() {
    Scene scene;
    add_quad(scene, {-3, -3, -2.99f}, {6, 0, 0}, {0, 6, 0}, lambert(0.7f));
    add_quad(scene, {0, -3, -2.99f}, {0, 6, 0}, {0, 0, 2.6f}, lambert(0.7f));
    return Surroundings(std::move(scene), {});
}

RenderedFrame picture(const Medium& medium, const Surroundings& set, RenderMethod method) {
    Shot shot;
    shot.method = method;
    shot.camera_given = true;
    shot.camera.eye = {1.5, -9.0, -0.5};
    shot.camera.target = {1.5, 0.0, -0.9};
    shot.camera.vertical_fov_degrees = 30.0;
    shot.camera.width = kWidth;
    shot.camera.height = kHeight;
    shot.camera.samples_per_axis = 2;
    shot.tracing.samples = 256;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights.count = 2000;
    shot.virtual_lights.photons = 200000;
    Progress silent;
    return render_medium(shot, medium, silent, &set);
}

// A cell's mean over the lower right, behind the wall.
double behind_wall(const Image& image, const std::string& cell) {
    const Layer& layer = image.layer(cell);
    double sum = 0.0;
    for (int y = kHeight / 2; y < kHeight; ++y)
        for (int x = kWidth / 2; x < kWidth; ++x)
            sum += layer.pixels[(std::size_t(y) * kWidth + x) * 3];
    return sum / (kHeight / 2.0 * kWidth / 2.0);
}

// By the grid, and by paths with the standard error of their two halves.
void expect_right(const std::string& cell, const Image& grid, const RenderedFrame& paths, double tolerance) {
    const double a = behind_wall(paths.halves[0], cell), b = behind_wall(paths.halves[1], cell), truth = 0.5 * (a + b);
    const double ours = behind_wall(grid, cell), error = 0.5 * std::abs(a - b);
    std::printf("%s behind the wall: %.4g, paths %.4g +- %.1f %% (%+.1f %%)\n", cell.c_str(), ours, truth,
                100.0 * error / truth, 100.0 * (ours / truth - 1.0));
    EXPECT_NEAR(ours, truth, tolerance * truth + 2.0 * error) << cell;
    EXPECT_LT(error, 0.1 * truth) << cell << " is not sampled enough";
}

TEST(ThinWalls, KeepLightOnItsSide) {
    const Medium medium = burst_at_the_left();
    const Surroundings set = floor_and_wall();
    const RenderedFrame grid = picture(medium, set, RenderMethod::LightingGrid);
    const RenderedFrame paths = picture(medium, set, RenderMethod::Path);
    for (const std::string cell : {"MS", "MM", "MV"})
        expect_right(cell, grid.image, paths, 0.1);
}

}  // namespace
}  // namespace brisance::test_thin_walls
