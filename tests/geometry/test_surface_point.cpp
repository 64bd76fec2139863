// The surface point at a hit.
#include <gtest/gtest.h>

#include "fixtures/sets.h"
#include "geometry/surface_point.h"

namespace brisance {
namespace {

using namespace testing;

SurfacePoint middle_of(const Scene& scene, const dvec3& toward_viewer) {
    return surface_point(scene, {1.0, 0, 0, vec2(1.0f / 3.0f)}, toward_viewer);
}

Scene one_quad(const SceneMaterial& material) {
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
    return scene;
}

TEST(SurfacePoint, OpaqueSurfacesFaceTheViewerOnBothSides) {
    const Scene scene = one_quad(lambert(0.5f));
    EXPECT_NEAR(middle_of(scene, dvec3(0, 0, 1)).frame.normal.z, 1.0, 1e-12);
    EXPECT_NEAR(middle_of(scene, dvec3(0, 0, -1)).frame.normal.z, -1.0, 1e-12);
}

TEST(SurfacePoint, GlassKeepsItsOutside) {
    SceneMaterial glass = lambert(1.0f);
    glass.surface.transmission = 1.0f;
    const Scene scene = one_quad(glass);
    EXPECT_NEAR(middle_of(scene, dvec3(0, 0, -1)).frame.normal.z, 1.0, 1e-12);
    glass.surface.thin = true;
    const Scene sheet = one_quad(glass);
    EXPECT_NEAR(middle_of(sheet, dvec3(0, 0, -1)).frame.normal.z, -1.0, 1e-12);
}

TEST(SurfacePoint, FrontsEmitAndBacksOnlyWhereDoubleSided) {
    const Rgb radiance(3.0f, 2.0f, 1.0f);
    const Scene one = one_quad(emitting(radiance)), both = one_quad(emitting(radiance, true));
    EXPECT_EQ(middle_of(one, dvec3(0, 0, 1)).emission, radiance);
    EXPECT_EQ(middle_of(one, dvec3(0, 0, -1)).emission, Rgb(0.0f));
    EXPECT_EQ(middle_of(both, dvec3(0, 0, -1)).emission, radiance);
}

// Interpolated normals that turn away from a viewer who sees the triangle would make silhouettes black.
TEST(SurfacePoint, ShadingNormalsAreSeen) {
    Scene scene = one_quad(lambert(0.5f));
    scene.meshes[0].normals.assign(4, glm::normalize(vec3(1.0f, 0.0f, 0.2f)));
    for (const double x : {-1.0, -10.0, 1.0}) {
        const dvec3 viewer = glm::normalize(dvec3(x, 0.3, 0.05));
        const SurfacePoint point = middle_of(scene, viewer);
        EXPECT_GT(glm::dot(point.frame.normal, viewer), 0.0);
        EXPECT_NEAR(glm::length(point.frame.normal), 1.0, 1e-12);
    }
    const SurfacePoint seen = middle_of(scene, dvec3(0, 0, 1));
    EXPECT_NEAR(seen.frame.normal.x, double(glm::normalize(vec3(1.0f, 0.0f, 0.2f)).x), 1e-6);
}

// A texel of (0.5 + 0.5 sin, 0.5, 0.5 + 0.5 cos) turns the normal by that angle toward growing u; green, toward falling
// v.
TEST(SurfacePoint, NormalMapsTurnTowardUAndAgainstV) {
    SceneMaterial bumpy = lambert(0.5f);
    bumpy.normal.texture = 0;
    Scene scene = one_quad(bumpy);
    scene.meshes[0].uv = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};  // v runs down the picture
    Texture texture;
    texture.width = texture.height = 1;
    texture.floats = {0.5f + 0.5f * 0.6f, 0.5f, 0.5f + 0.5f * 0.8f, 1.0f};
    scene.textures.push_back(std::make_shared<const Texture>(texture));
    const dvec3 n = middle_of(scene, dvec3(0, 0, 1)).frame.normal;
    EXPECT_NEAR(n.x, 0.6, 1e-6);
    EXPECT_NEAR(n.y, 0.0, 1e-6);
    texture.floats = {0.5f, 0.5f + 0.5f * 0.6f, 0.5f + 0.5f * 0.8f, 1.0f};
    scene.textures[0] = std::make_shared<const Texture>(texture);
    EXPECT_NEAR(middle_of(scene, dvec3(0, 0, 1)).frame.normal.y, 0.6, 1e-6);
}

TEST(SurfacePoint, TexturesMultiplyFactorsInTheirChannels) {
    SceneMaterial m = lambert(1.0f);
    m.surface.base_colour = Rgb(0.5f, 1.0f, 1.0f);
    m.surface.metallic = 0.8f;
    m.surface.roughness = 0.5f;
    m.base_colour.texture = m.metal_rough.texture = 0;
    Scene scene = one_quad(m);
    scene.meshes[0].uv.assign(4, vec2(0.5f));
    Texture texture;
    texture.width = texture.height = 1;
    texture.floats = {0.5f, 0.4f, 0.25f, 1.0f};
    scene.textures.push_back(std::make_shared<const Texture>(texture));
    const SurfaceMaterial found = middle_of(scene, dvec3(0, 0, 1)).material;
    EXPECT_EQ(found.base_colour, Rgb(0.25f, 0.4f, 0.25f));
    EXPECT_FLOAT_EQ(found.metallic, 0.8f * 0.25f);
    EXPECT_FLOAT_EQ(found.roughness, 0.5f * 0.4f);
}

}  // namespace
}  // namespace brisance
