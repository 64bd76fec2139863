// Surfaces that stand in the smoke, around it, and around the camera: light stops at them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"

namespace brisance::test_surfaces_in_smoke {
namespace {

using namespace testing;

constexpr int kWidth = 40, kHeight = 30;

// A ball of smoke of radius 1 m that burns on its left side only.
Medium half_burning() {
    Recipe r = glowing_ball(20, 3.0f);
    r.settings.smoke.albedo = Rgb(0.8f);
    r.flame = [](const ivec3& n) { return n.x < -4 ? 1.0f : 0.0f; };
    return make_medium(r);
}

Shot shot_of(RenderMethod method) {
    Shot shot;
    shot.method = method;
    shot.camera_given = true;
    shot.camera.eye = {0.0, -5.0, 0.0};
    shot.camera.target = {0.0, 0.0, 0.0};
    shot.camera.vertical_fov_degrees = 28.0;
    shot.camera.width = kWidth;
    shot.camera.height = kHeight;
    shot.camera.samples_per_axis = 3;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights.count = 2000;
    shot.virtual_lights.photons = 200000;
    return shot;
}

// The layer's sum over the columns [from, to).
double columns(const Layer& layer, int from, int to) {
    double sum = 0.0;
    const std::size_t channels = layer.channels.size();
    for (int y = 0; y < kHeight; ++y)
        for (int x = from; x < to; ++x)
            sum += layer.pixels[(std::size_t(y) * kWidth + x) * channels];
    return sum / (kWidth * kHeight);
}

struct Pair {
    RenderedFrame grid, paths;
    // Of a cell, in columns: ours, the truth, and twice the truth's noise.
    std::array<double, 3> sums(const char* cell, int from, int to) const {
        const double a = columns(paths.halves[0].layer(cell), from, to);
        const double b = columns(paths.halves[1].layer(cell), from, to);
        return {columns(grid.image.layer(cell), from, to), 0.5 * (a + b), std::abs(a - b)};
    }
};

Pair both(const Medium& medium, const Surroundings& surroundings, int path_samples = 256) {
    Progress silent;
    Shot paths = shot_of(RenderMethod::Path);
    paths.tracing.samples = path_samples;
    return {render_medium(shot_of(RenderMethod::LightingGrid), medium, silent, &surroundings),
            render_medium(paths, medium, silent, &surroundings)};
}

TEST(SurfacesInSmoke, AWallThroughItHoldsTheFiresLightUp) {
    const Medium medium = half_burning();
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    add_quad(scene, {0.02f, -2, -2}, {0, 4, 0}, {0, 0, 4}, lambert(0.0f));
    const Surroundings surroundings(scene, {});
    // The fire's light and black walls: the halves of few paths are 0.1 % of the lit side apart.
    const Pair pictures = both(medium, surroundings, 64);
    for (const char* cell : {"MV", "MM"}) {
        const auto lit = pictures.sums(cell, 0, kWidth / 2), dark = pictures.sums(cell, kWidth / 2, kWidth);
        std::printf("%s lit %.5f, paths %.5f, halves apart %.5f; dark %.5f, paths %.5f, halves apart %.5f\n", cell,
                    lit[0], lit[1], lit[2], dark[0], dark[1], dark[2]);
        EXPECT_NEAR(lit[0], lit[1], 0.03 * lit[1] + lit[2]) << cell;
        // Lights of several voxels may lie on both sides.
        const double leak = cell == std::string("MV") ? 0.003 : 0.015;
        EXPECT_NEAR(dark[0], dark[1], leak * lit[1] + dark[2]) << cell << ": what comes through";
    }
}

// Fire and smoke in a closed room with the camera.
TEST(SurfacesInSmoke, ARoomAroundCameraAndSmoke) {
    const Medium medium = half_burning();
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    add_box(scene, {-2, -5.5f, -1.5f}, {2, 2, 1.5f}, lambert(0.5f), true);
    const Surroundings surroundings(scene, {});
    const Pair pictures = both(medium, surroundings);
    for (const std::string& cell : pictures.grid.statistics.cells) {
        const auto s = pictures.sums(cell.c_str(), 0, kWidth);
        std::printf("%s %.5f, paths %.5f (%+.2f %%), halves apart %.2f %%\n", cell.c_str(), s[0], s[1],
                    100.0 * (s[0] / s[1] - 1.0), 100.0 * s[2] / s[1]);
        EXPECT_NEAR(s[0], s[1], 0.05 * s[1] + s[2]) << cell;
    }
    for (std::size_t p = 3; p < pictures.grid.image.layer("").pixels.size(); p += 4)
        EXPECT_EQ(pictures.grid.image.layer("").pixels[p], 1.0f);
}

// A fire stands on a floor, which is brightest where the smoke is closest: within less than the width of one virtual
// light, and of one voxel. The floor lies half a voxel and a quarter of one above the nodes below it, and in a plane of
// them.
TEST(SurfacesInSmoke, AFloorUnderFireAndSmokeIsLitAndLightsThem) {
    const Medium medium = half_burning();
    for (const float height : {-0.525f, -0.5375f, -0.5f}) {
        Scene scene;
        scene.origin = medium.world_of_local(vec3(0.0f));
        add_quad(scene, {-6, -6, height}, {12, 0, 0}, {0, 12, 0}, lambert(0.8f));
        const Surroundings surroundings(scene, {});
        const Pair pictures = both(medium, surroundings);
        for (const char* cell : {"MS", "SV", "SM", "MM"}) {
            const auto s = pictures.sums(cell, 0, kWidth);
            std::printf("floor at %.4f m: %s %.6f, paths %.6f (%+.1f %%), halves apart %.6f\n", double(height), cell,
                        s[0], s[1], 100.0 * (s[0] / s[1] - 1.0), s[2]);
            EXPECT_NEAR(s[0], s[1], 0.06 * s[1] + s[2]) << cell << " " << height;
        }
    }
}

// A lamp on one side of a screen lights the floor there; smoke on the other side sees neither.
TEST(SurfacesInSmoke, LitFloorsBehindAWallDoNotLightIt) {
    Recipe recipe = glowing_ball(20, 3.0f);
    recipe.settings.smoke.albedo = Rgb(0.8f);
    Medium medium = make_medium(recipe);
    medium.source.clear();
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    add_quad(scene, {-6, -2, -1.3f}, {12, 0, 0}, {0, 4, 0}, lambert(0.7f));
    add_quad(scene, {-1.3f, -4, -4}, {0, 8, 0}, {0, 0, 9}, lambert(0.0f));
    LightSettings lamp;
    lamp.position = {-3.0, 0.0, 0.5};
    lamp.power = Rgb(20.0f);
    Scene open = scene;
    open.meshes.pop_back();
    Progress silent;
    const Surroundings without_wall(open, {lamp});
    const RenderedFrame lit = render_medium(shot_of(RenderMethod::LightingGrid), medium, silent, &without_wall);
    EXPECT_GT(columns(lit.image.layer("MS"), 0, kWidth), 5e-3);
    const Surroundings surroundings(scene, {lamp});
    const Pair pictures = both(medium, surroundings);
    const auto ms = pictures.sums("MS", 0, kWidth);
    std::printf("MS %.6f, paths %.6f, halves apart %.6f\n", ms[0], ms[1], ms[2]);
    EXPECT_NEAR(ms[0], ms[1], 1e-4 + ms[2]);
}

}  // namespace
}  // namespace brisance::test_surfaces_in_smoke
