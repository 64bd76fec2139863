#include <gtest/gtest.h>

#include <cmath>

#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

QuickQuad unit_quad() {
    QuickQuad quad;
    quad.corners = {dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(1, 1, 0), dvec3(0, 1, 0)};
    return quad;
}

TEST(QuickShapes, AQuadIsTwoTrianglesThatFaceOneWay) {
    SceneSettings settings;
    settings.quads = {unit_quad()};
    settings.quads[0].material.emission = Rgb(1, 2, 3);
    settings.quads[0].material.colour = Rgb(0.25f);
    const Loaded loaded = load_settings(settings);
    ASSERT_EQ(loaded.scene.meshes.size(), 1u);
    const SceneMesh& mesh = loaded.scene.meshes[0];
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_DOUBLE_EQ(area_of(mesh), 1.0);
    for (std::size_t t = 0; t < 2; ++t)
        EXPECT_GT(cross_of(mesh, t).z, 0.0);
    const SceneMaterial& material = loaded.scene.materials.at(0);
    EXPECT_EQ(material.emission, Rgb(1, 2, 3));
    EXPECT_EQ(material.surface.base_colour, Rgb(0.25f));
    EXPECT_EQ(material.surface.specular, 0.0f);
    EXPECT_FALSE(material.double_sided);
    EXPECT_TRUE(loaded.messages.warnings.empty());
}

TEST(QuickShapes, AQuadFarFromTheWorldsOriginKeepsItsDigits) {
    SceneSettings settings;
    settings.quads = {unit_quad()};
    const dvec3 far(1e8, -1e8, 1e8);
    for (dvec3& corner : settings.quads[0].corners)
        corner += far;
    EXPECT_DOUBLE_EQ(area_of(load_settings(settings, ".", 0.0, kPlenty, far).scene.meshes[0]), 1.0);
}

TEST(QuickShapes, AGlassQuadIsASheetAGlassSphereIsNot) {
    SceneSettings settings;
    settings.quads = {unit_quad()};
    settings.quads[0].material.transmission = 1.0f;
    settings.spheres.emplace_back();
    settings.spheres[0].material.transmission = 1.0f;
    const Loaded loaded = load_settings(settings);
    EXPECT_TRUE(loaded.scene.materials.at(0).surface.thin);
    EXPECT_FALSE(loaded.scene.materials.at(1).surface.thin);
}

TEST(QuickShapes, AQuadThatIsNotFlatIsKeptWithAWarning) {
    SceneSettings settings;
    settings.quads = {unit_quad()};
    settings.quads[0].corners[3].z = 0.2;
    const Loaded loaded = load_settings(settings);
    EXPECT_EQ(loaded.scene.triangle_count(), 2u);
    EXPECT_TRUE(loaded.messages.warned("not-flat"));
}

TEST(QuickShapes, AQuadWithoutAreaIsLeftOutWithAWarning) {
    for (const double x : {0.0, std::numeric_limits<double>::quiet_NaN(), 1e300}) {
        SceneSettings settings;
        settings.quads.emplace_back();
        settings.quads[0].corners.fill(dvec3(x));
        settings.lights.emplace_back();
        settings.lights[0].kind = LightKind::Quad;
        const Loaded loaded = load_settings(settings);
        EXPECT_TRUE(loaded.scene.meshes.empty());
        EXPECT_EQ(loaded.messages.warnings.size(), 2u);
        EXPECT_TRUE(loaded.messages.warned("no-area"));
    }
}

TEST(QuickShapes, ATriangleMayBeGivenAsAQuad) {
    SceneSettings settings;
    settings.quads = {unit_quad()};
    settings.quads[0].corners[3] = settings.quads[0].corners[2];
    EXPECT_EQ(load_settings(settings).scene.triangle_count(), 1u);
}

TEST(QuickShapes, AQuadLightIsBlackAndEmitsFromItsFront) {
    SceneSettings settings;
    settings.lights.resize(2);  // the other is a point
    settings.lights[0].kind = LightKind::Quad;
    settings.lights[0].name = "Panel";
    settings.lights[0].corners = unit_quad().corners;
    settings.lights[0].power = Rgb(5, 6, 7);
    const Loaded loaded = load_settings(settings);
    ASSERT_EQ(loaded.scene.meshes.size(), 1u);
    EXPECT_EQ(loaded.scene.meshes[0].name, "Panel");
    EXPECT_GT(cross_of(loaded.scene.meshes[0], 0).z, 0.0);
    const SceneMaterial& material = loaded.scene.materials.at(0);
    EXPECT_EQ(material.emission, Rgb(5, 6, 7));
    EXPECT_EQ(material.surface.base_colour, Rgb(0.0f));
    EXPECT_EQ(material.surface.specular, 0.0f);
    EXPECT_EQ(material.surface.metallic, 0.0f);
    EXPECT_FALSE(material.double_sided);
}

// Wherever the ceiling is and however large: of rays from below all see the panel.
TEST(QuickShapes, AQuadLightInACeilingIsSeen) {
    for (const double size : {1.0, 1000.0})
        for (const dvec3& at : {dvec3(0.0), dvec3(13.7, -41.3, 7.9)}) {
            SceneSettings settings;
            QuickQuad ceiling = unit_quad();
            for (dvec3& corner : ceiling.corners)
                corner = at + size * (corner - dvec3(0.4, 0.3, 0.0));
            settings.quads = {ceiling};
            settings.lights.resize(1);
            settings.lights[0].kind = LightKind::Quad;
            settings.lights[0].corners = unit_quad().corners;
            for (dvec3& corner : settings.lights[0].corners)
                corner += at;
            const Scene scene = load_settings(settings).scene;
            ASSERT_EQ(scene.meshes.size(), 2u);
            const vec3 panel = scene.meshes[1].positions[0], wall = scene.meshes[0].positions[0];
            EXPECT_GT(panel.z, wall.z) << size << " " << at.x;
            EXPECT_LT(panel.z - wall.z, 1e-5f * float(size + 100.0));
        }
}

TEST(QuickShapes, ASphereIsRoundAndFacesOutward) {
    SceneSettings settings;
    settings.spheres.resize(1);
    settings.spheres[0].centre = {1, 2, 3};
    settings.spheres[0].radius = 0.5;
    const Loaded loaded = load_settings(settings);
    const SceneMesh& mesh = loaded.scene.meshes.at(0);
    EXPECT_EQ(mesh.triangles.size(), 20480u);
    EXPECT_EQ(mesh.positions.size(), 10242u);
    const double exact = 4.0 * 3.14159265358979 * 0.25;
    EXPECT_LT(area_of(mesh), exact);
    EXPECT_GT(area_of(mesh), exact * (1.0 - 4e-4));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const dvec3 from_centre = dvec3(mesh.positions[i]) - dvec3(1, 2, 3);
        EXPECT_NEAR(glm::length(from_centre), 0.5, 1e-6);
        EXPECT_NEAR(glm::length(from_centre / 0.5 - dvec3(mesh.normals[i])), 0.0, 2e-6);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const dvec3 corner = dvec3(mesh.positions[mesh.triangles[t].x]) - dvec3(1, 2, 3);
        EXPECT_GT(glm::dot(cross_of(mesh, t), corner), 0.0);
    }
}

TEST(QuickShapes, ARadiusMustBeAboveZero) {
    for (const double radius : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        SceneSettings settings;
        settings.spheres.resize(1);
        settings.spheres[0].radius = radius;
        const Failure failure = failure_of([&] { load_settings(settings); });
        EXPECT_EQ(failure.code, ExitCode::BadData);
        EXPECT_TRUE(contains(failure.message, "sphere 0")) << failure.message;
    }
}

TEST(QuickShapes, SpheresCountAgainstTheMemory) {
    SceneSettings settings;
    settings.spheres.resize(100);
    const Failure failure = failure_of([&] { load_settings(settings, ".", 0.0, 50 << 20); });
    EXPECT_EQ(failure.code, ExitCode::Temporary);
    EXPECT_TRUE(contains(failure.message, "triangles")) << failure.message;
}

}  // namespace
}  // namespace brisance::testing
