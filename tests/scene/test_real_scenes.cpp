// Whole scenes whose contents are known, where they are at hand: BRISANCE_DATA names a folder with scenes/ in it.
#include <gtest/gtest.h>

#include <cstdlib>

#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

struct Emitter {
    Rgb radiance;
    double area;
    std::optional<dvec3> normal;  // none: a sphere
};

class RealScenes : public ::testing::Test {
protected:
    void load_known(const std::string& name, std::size_t triangles, const dvec3& eye, double fov_y) {
        const char* const data = std::getenv("BRISANCE_DATA");
        const std::filesystem::path file = std::filesystem::path(data != nullptr ? data : "") / "scenes" / name;
        if (data == nullptr || !std::filesystem::exists(file))
            GTEST_SKIP() << "set BRISANCE_DATA to a folder with scenes/" << name << " in it";
        loaded_ = load_file(file);
        EXPECT_TRUE(loaded_.messages.warnings.empty()) << loaded_.messages.warnings.front().second;
        EXPECT_EQ(loaded_.scene.triangle_count(), triangles);
        ASSERT_EQ(loaded_.scene.cameras.size(), 1u);
        const SceneCamera& camera = loaded_.scene.cameras.front();
        EXPECT_EQ(camera.name, "Camera");
        EXPECT_NEAR(glm::length(dvec3(camera.world_from_camera[3]) - eye), 0.0, 2e-5);
        EXPECT_NEAR(camera.vertical_fov_degrees, fov_y, 1e-4);
        EXPECT_TRUE(camera.aspect.has_value());
    }

    void expect_emitters(const std::vector<Emitter>& emitters) const {
        if (IsSkipped())
            return;
        std::size_t found = 0;
        for (const SceneMesh& mesh : loaded_.scene.meshes) {
            const SceneMaterial& material = loaded_.scene.materials[static_cast<std::size_t>(mesh.material)];
            if (!material.emits())
                continue;
            ASSERT_LT(found, emitters.size());
            const Emitter& expected = emitters[found++];
            EXPECT_NEAR(glm::length(material.emission / expected.radiance - Rgb(1.0f)), 0.0, 1e-5);
            EXPECT_NEAR(area_of(mesh) / expected.area, 1.0, 1e-4);
            EXPECT_FALSE(material.double_sided);
            for (std::size_t t = 0; expected.normal && t < mesh.triangles.size(); ++t)
                EXPECT_NEAR(glm::dot(glm::normalize(cross_of(mesh, t)), glm::normalize(*expected.normal)), 1.0, 1e-5);
        }
        EXPECT_EQ(found, emitters.size());
    }

    Loaded loaded_;
};

TEST_F(RealScenes, VeachAjar) {
    load_known("veach-ajar.glb", 382628, {4.05402, 1.61647, -2.30652}, 35.9834);
    expect_emitters({{Rgb(1000.0f), 3.86072, dvec3(0.0, 0.0, -1.0)}});
    if (IsSkipped())
        return;
    ASSERT_EQ(loaded_.scene.textures.size(), 4u);
    for (const auto& texture : loaded_.scene.textures) {
        EXPECT_EQ(texture->nearest, texture->name == "checker");
        EXPECT_TRUE(texture->srgb);
        EXPECT_EQ(texture->bytes.size(),
                  4 * static_cast<std::size_t>(texture->width) * static_cast<std::size_t>(texture->height));
    }
    for (const SceneMaterial& material : loaded_.scene.materials)
        EXPECT_FALSE(material.surface.thin) << material.name;
}

TEST_F(RealScenes, CornellBox) {
    load_known("cornell-box.glb", 36, {0.0, 1.0, 6.8}, 19.5);
    expect_emitters({{Rgb(17.0f, 12.0f, 4.0f), 0.1786, dvec3(0.0, -1.0, 0.0)}});
}

TEST_F(RealScenes, VeachBidir) {
    load_known("veach-bidir.glb", 11544, {16.2155, 4.05167, 0.011486}, 35.0);
    expect_emitters({{Rgb(523.258f), 0.304162, dvec3(0.0, 1.0, 0.0)},
                     {Rgb(12048.2f, 8605.84f, 6196.21f), 0.0184938, dvec3(0.070781, -0.429239, 0.900413)}});
}

TEST_F(RealScenes, VeachMis) {
    load_known("veach-mis.glb", 11956, {28.2792, 3.5, 1e-6}, 20.11429);
    expect_emitters({{Rgb(7.59909f), 12.5412, {}}, {Rgb(30.3964f), 3.13529, {}}, {Rgb(3039.64f), 0.0313529, {}}});
}

}  // namespace
}  // namespace brisance::testing
