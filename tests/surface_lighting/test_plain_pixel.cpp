// Which pixels show one plain surface.
#include <gtest/gtest.h>

#include "fixtures/sets.h"
#include "geometry/intersector.h"
#include "surface_lighting/plain_pixel.h"

namespace brisance {
namespace {

using namespace testing;

// What 4 x 4 rays from above see of the square of that side about a point.
std::vector<SurfaceSample> pixel_at(const Scene& scene, const dvec3& at, double side = 0.1,
                                    const dvec3& from = {0.0, 0.0, 10.0}) {
    const Intersector surfaces(scene);
    std::vector<SurfaceSample> samples;
    for (int k = 0; k < 16; ++k) {
        SurfaceSample s{};
        s.number = std::uint64_t(k);
        const dvec3 below = at + side * dvec3((k % 4 - 1.5) / 4.0, (k / 4 - 1.5) / 4.0, 0.0);
        s.ray = {below + from, -glm::normalize(from)};
        const auto hit = surfaces.first_hit(s.ray);
        if (!hit)
            return {};
        s.hit = *hit;
        samples.push_back(s);
    }
    return samples;
}

bool plain(const Scene& scene, const dvec3& at, double side = 0.1) {
    const std::vector<SurfaceSample> samples = pixel_at(scene, at, side);
    EXPECT_EQ(samples.size(), 16u);
    return shows_plain_surface(scene, samples);
}

Scene floor_of(const SceneMaterial& material) {
    Scene scene;
    add_quad(scene, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, material);
    return scene;
}

TEST(PlainPixel, IsAFloorAlsoWhereItsTrianglesMeet) {
    const Scene scene = floor_of(lambert(0.5f));
    EXPECT_TRUE(plain(scene, {1.0, -0.5, 0.0}));
    EXPECT_TRUE(plain(scene, {0.5, 0.5, 0.0})) << "on the diagonal";
}

TEST(PlainPixel, IsNoEdgeOfAnotherSurface) {
    Scene scene = floor_of(lambert(0.5f));
    add_quad(scene, {0, -1, 0.5f}, {1, 0, 0}, {0, 1, 0}, lambert(0.5f));
    EXPECT_FALSE(plain(scene, {0.0, -0.5, 0.0}));
    EXPECT_TRUE(plain(scene, {0.5, -0.5, 0.0}));
}

TEST(PlainPixel, IsNoStepAndNoRidgeOfOneMesh) {
    Scene scene;
    add_box(scene, {-1, -1, -1}, {0, 1, 0}, lambert(0.5f));
    SceneMesh& mesh = scene.meshes[0];
    const std::size_t corners = mesh.positions.size();
    Scene other;
    add_box(other, {0, -1, -1}, {1, 1, 0.01f}, lambert(0.5f));
    mesh.positions.insert(mesh.positions.end(), other.meshes[0].positions.begin(), other.meshes[0].positions.end());
    for (const glm::uvec3& t : other.meshes[0].triangles)
        mesh.triangles.push_back(t + std::uint32_t(corners));
    EXPECT_FALSE(plain(scene, {0.0, 0.3, 0.0})) << "a step";
    const std::vector<SurfaceSample> grazing = pixel_at(scene, {0.0, 0.3, 0.005}, 1.0, {10.0, 0.0, 0.3});
    ASSERT_EQ(grazing.size(), 16u);
    EXPECT_FALSE(shows_plain_surface(scene, grazing)) << "a step seen from far";
    EXPECT_TRUE(plain(scene, {0.5, 0.3, 0.0}));
    Scene ridge;
    SceneMesh roof;
    roof.positions = {{0, -1, 0}, {0, 1, 0}, {1, 0, -0.5f}, {-1, 0, -0.5f}};
    roof.triangles = {{0, 2, 1}, {0, 1, 3}};
    ridge.materials.push_back(lambert(0.5f));
    ridge.meshes.push_back(roof);
    EXPECT_FALSE(plain(ridge, {0.0, 0.1, 0.0}));
}

// A smooth object of many small triangles is as plain as a large one.
TEST(PlainPixel, IsAFinelyDividedBall) {
    Scene scene;
    add_ball(scene, {0, 0, 0}, 1.0f, 400, lambert(0.5f));
    EXPECT_TRUE(plain(scene, {0.3, 0.2, 0.0}, 0.03));
}

TEST(PlainPixel, IsNothingThatATextureChangesOrLightPasses) {
    SceneMaterial textured = lambert(0.5f), clear = lambert(0.5f), mirror = lambert(0.5f), cut = lambert(0.5f);
    textured.base_colour.texture = 0;
    clear.surface.transmission = 0.5f;
    mirror.surface.metallic = 1.0f;
    mirror.surface.roughness = 0.0f;
    cut.alpha_mode = AlphaMode::Mask;
    for (const SceneMaterial& m : {textured, clear, mirror, cut}) {
        Scene scene = floor_of(lambert(0.5f));
        const std::vector<SurfaceSample> samples = pixel_at(scene, {1.0, -0.5, 0.0});
        scene.materials[0] = m;
        EXPECT_FALSE(shows_plain_surface(scene, samples));
    }
}

}  // namespace
}  // namespace brisance
