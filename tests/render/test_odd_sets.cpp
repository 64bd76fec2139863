// Sets that nobody builds on purpose, and everybody has once: surfaces that touch, cut or coincide, closed rooms
// without light, lamps in walls, a sky of one bright texel, lamps of a million triangles. The lighting grid shows what
// paths show, and no grain decides the picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/stopwatch.h"
#include "fixtures/luminances.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"

namespace brisance::test_odd_sets {
namespace {

using namespace testing;

constexpr int kWidth = 32, kHeight = 24;

// A ball of radius 1 m around the origin, in voxels of 0.1 m.
Medium small_ball(bool burns) {
    Recipe r = glowing_ball(10, 3.0f);
    r.settings.smoke.albedo = Rgb(0.8f);
    if (!burns)
        r.flame = [](const ivec3&) { return 0.0f; };
    return make_medium(r);
}

Shot shot_of(RenderMethod method) {
    Shot shot;
    shot.method = method;
    shot.camera_given = true;
    shot.camera.eye = {1.0, -5.0, 1.2};
    shot.camera.target = {0.0, 0.0, -0.3};
    shot.camera.vertical_fov_degrees = 42.0;
    shot.camera.width = kWidth;
    shot.camera.height = kHeight;
    shot.tracing.samples = 256;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights.count = 1000;
    shot.virtual_lights.photons = 100000;
    return shot;
}

Scene scene_of(const Medium& medium) {
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    return scene;
}

LightSettings point_lamp(const dvec3& position, float intensity) {
    LightSettings lamp;
    lamp.position = position;
    lamp.power = Rgb(intensity);
    return lamp;
}

RenderedFrame rendered(RenderMethod method, const Medium& medium, const Surroundings& set) {
    Progress silent;
    return render_medium(shot_of(method), medium, silent, &set);
}

double sum_of(const std::vector<double>& pixels) {
    return std::accumulate(pixels.begin(), pixels.end(), 0.0);
}

// What single pixels show beyond three times the brightest truth around them.
double grains(const std::vector<double>& pixels, const std::vector<double>& truth) {
    double out = 0.0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            double around = 0.0;
            for (int v = std::max(0, y - 2); v <= std::min(kHeight - 1, y + 2); ++v)
                for (int u = std::max(0, x - 2); u <= std::min(kWidth - 1, x + 2); ++u)
                    around = std::max(around, truth[std::size_t(v) * kWidth + u]);
            out += std::max(0.0, pixels[std::size_t(y) * kWidth + x] - 3.0 * around);
        }
    return out;
}

// Every cell within `tolerance` of the picture and four times the truth's noise, from its halves, whose difference is
// twice the standard error on average; grains make less than 1 % of it.
void expect_as_paths(const Medium& medium, const Surroundings& set, const char* what, double tolerance = 0.02) {
    const RenderedFrame grid = rendered(RenderMethod::LightingGrid, medium, set);
    const RenderedFrame paths = rendered(RenderMethod::Path, medium, set);
    const std::vector<double> seen = luminances(grid.image.layer("")), truth = luminances(paths.image.layer(""));
    const double picture = sum_of(truth);
    EXPECT_GT(picture, 0.0) << what;
    for (const double pixel : seen)
        ASSERT_TRUE(std::isfinite(pixel) && pixel >= 0.0) << what;
    for (const std::string& cell : grid.statistics.cells) {
        const double ours = sum_of(luminances(grid.image.layer(cell))),
                     theirs = sum_of(luminances(paths.image.layer(cell))),
                     apart = std::abs(sum_of(luminances(paths.halves[0].layer(cell))) -
                                      sum_of(luminances(paths.halves[1].layer(cell))));
        std::printf("%s %s: %.3f %% of the picture, paths %.3f %%, halves apart %.3f %%\n", what, cell.c_str(),
                    100.0 * ours / picture, 100.0 * theirs / picture, 100.0 * apart / picture);
        EXPECT_NEAR(ours, theirs, tolerance * picture + 2.0 * apart) << what << ", " << cell;
    }
    std::printf("%s: grains %.3f %%\n", what, 100.0 * grains(seen, truth) / picture);
    EXPECT_LT(grains(seen, truth), 0.01 * picture) << what;
}

// A floor twice in one place, a block that stands in it with one face in the wall's plane, a sheet through the smoke in
// a plane of its nodes, and another in a plane of its voxels' faces.
TEST(OddSets, SurfacesThatTouchCutAndCoincide) {
    const Medium medium = small_ball(true);
    Scene scene = scene_of(medium);
    add_quad(scene, {-3, -3, -1.0f}, {6, 0, 0}, {0, 6, 0}, lambert(0.7f));
    add_quad(scene, {-3, -3, -1.0f}, {6, 0, 0}, {0, 6, 0}, lambert(0.2f));
    add_quad(scene, {-3, 2, -1.0f}, {6, 0, 0}, {0, 0, 4}, lambert(0.5f));
    add_box(scene, {-2.0f, 1.0f, -1.0f}, {-1.2f, 2.0f, 0.0f}, lambert(0.6f));
    add_quad(scene, {0.2f, -0.5f, 0.0f}, {2, 0, 0}, {0, 1.5f, 0}, lambert(0.5f));
    add_quad(scene, {-0.35f, 0.0f, -1.0f}, {0, 1.5f, 0}, {0, 0, 1.2f}, lambert(0.5f));
    expect_as_paths(medium, Surroundings(std::move(scene), {point_lamp({-1.5, -2.0, 1.5}, 1.0f)}), "touching");
}

// A camera in a closed room that has smoke but no light, while a fire and a lamp burn outside.
TEST(OddSets, AClosedRoomWithoutLightIsBlack) {
    Recipe recipe = glowing_ball(10, 3.0f);
    recipe.flame = [](const ivec3& n) { return n.x > 7 ? 1.0f : 0.0f; };
    const Medium medium = make_medium(recipe);
    Scene scene = scene_of(medium);
    add_box(scene, {-3, -6, -1.5f}, {0.55f, 3, 2}, lambert(0.7f), true);
    Shot shot = shot_of(RenderMethod::LightingGrid);
    shot.camera.eye = {-1.5, -5.0, 0.5};
    shot.camera.target = {-0.8, 0.0, 0.0};
    const Surroundings set(std::move(scene), {point_lamp({3.0, 0.0, 0.0}, 10.0f)});
    for (const RenderMethod method : {RenderMethod::LightingGrid, RenderMethod::Path}) {
        shot.method = method;
        Progress silent;
        const RenderedFrame frame = render_medium(shot, medium, silent, &set);
        EXPECT_EQ(sum_of(luminances(frame.image.layer(""))), 0.0) << int(method);
    }
}

// A lamp that a block encloses, and one in the plane of a wall, beside one that hangs free. The enclosed one is by far
// the strongest, and must not take the samples that the others need.
TEST(OddSets, LampsInWalls) {
    const Medium medium = small_ball(true);
    Scene scene = scene_of(medium);
    add_quad(scene, {-3, -3, -1.3f}, {6, 0, 0}, {0, 6, 0}, lambert(0.6f));
    add_quad(scene, {-3, 2, -1.3f}, {6, 0, 0}, {0, 0, 4}, lambert(0.5f));
    add_box(scene, {1.2f, 0.6f, -1.3f}, {2.0f, 1.4f, -0.5f}, lambert(0.6f));
    expect_as_paths(
        medium,
        Surroundings(std::move(scene), {point_lamp({1.6, 1.0, -0.9}, 100.0f), point_lamp({-1.5, 2.0, 1.0}, 2.0f),
                                        point_lamp({-1.5, -2.0, 1.5}, 2.0f)}),
        "lamps in walls");
}

// Lamps inside of the smoke, one at a node, one on the face of a sheet in it.
TEST(OddSets, LampsInSmoke) {
    const Medium medium = small_ball(false);
    Scene scene = scene_of(medium);
    add_quad(scene, {-3, -3, -1.3f}, {6, 0, 0}, {0, 6, 0}, lambert(0.6f));
    add_quad(scene, {-0.4f, -0.3f, 0.0f}, {0, 0.8f, 0}, {0, 0, 0.8f}, lambert(0.5f));
    expect_as_paths(
        medium, Surroundings(std::move(scene), {point_lamp({0.3, 0.0, 0.0}, 2.0f), point_lamp({-0.4, 0.1, 0.4}, 2.0f)}),
        "lamps in smoke");
}

// One texel of 2,048 sends nearly all of a sky's light.
TEST(OddSets, ASkyOfOneBrightTexel) {
    Texture picture;
    picture.width = 64;
    picture.height = 32;
    picture.wrap_v = Wrap::Clamp;
    for (int i = 0; i < 64 * 32; ++i) {
        const float v = i == 9 * 64 + 21 ? 3e4f : 0.02f;
        picture.floats.insert(picture.floats.end(), {v, v, v, 1.0f});
    }
    LightSettings sky;
    sky.kind = LightKind::Environment;
    const Medium medium = small_ball(false);
    Scene scene = scene_of(medium);
    add_quad(scene, {-3, -3, -1.3f}, {6, 0, 0}, {0, 6, 0}, lambert(0.6f));
    SceneMaterial plastic = lambert(0.4f);
    plastic.surface.specular = 1.0f;
    plastic.surface.roughness = 0.2f;
    add_ball(scene, {-1.6f, -0.6f, -0.9f}, 0.4f, 30, plastic);
    std::vector<Texture> pictures;
    pictures.push_back(std::move(picture));
    expect_as_paths(medium, Surroundings(std::move(scene), {sky}, std::move(pictures)), "bright texel");
}

// A lamp of a million triangles is the lamp of two, within what lighting.error allows each.
TEST(OddSets, ALampOfAMillionTriangles) {
    constexpr int kAcross = 708;
    const Medium medium = small_ball(false);
    const auto frame_with = [&](int across) {
        Scene scene = scene_of(medium);
        add_quad(scene, {-3, -3, -1.3f}, {6, 0, 0}, {0, 6, 0}, lambert(0.6f));
        SceneMesh lamp;
        for (int j = 0; j <= across; ++j)
            for (int i = 0; i <= across; ++i)
                lamp.positions.emplace_back(-2.0f + float(i) / float(across), -0.5f + float(j) / float(across), 1.8f);
        const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (across + 1) + i); };
        for (int j = 0; j < across; ++j)
            for (int i = 0; i < across; ++i) {
                lamp.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
                lamp.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
            }
        lamp.material = int(scene.materials.size());
        scene.materials.push_back(emitting(Rgb(5.0f)));
        std::printf("%zu triangles\n", lamp.triangles.size());
        scene.meshes.push_back(std::move(lamp));
        const Stopwatch watch;
        const Surroundings set(std::move(scene), {});
        RenderedFrame out = rendered(RenderMethod::LightingGrid, medium, set);
        std::printf("%.2f s\n", watch.seconds());
        return out;
    };
    const RenderedFrame two = frame_with(1), million = frame_with(kAcross);
    const std::vector<double> picture = luminances(two.image.layer(""));
    EXPECT_EQ(two.statistics.cells, million.statistics.cells);
    for (const std::string& cell : two.statistics.cells) {
        const double a = sum_of(luminances(two.image.layer(cell))), b = sum_of(luminances(million.image.layer(cell)));
        std::printf("%s %.4f, %.4f\n", cell.c_str(), a, b);
        EXPECT_NEAR(a, b, 0.02 * sum_of(picture)) << cell;
    }
    EXPECT_LT(grains(luminances(million.image.layer("")), picture), 0.01 * sum_of(picture));
}

}  // namespace
}  // namespace brisance::test_odd_sets
