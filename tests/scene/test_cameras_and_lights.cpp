#include <gtest/gtest.h>

#include <cmath>

#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

using nlohmann::json;

json perspective(double yfov, double aspect = 2.0) {
    return {{"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", 0.1}, {"aspectRatio", aspect}}}};
}

TestGltf with_camera(const json& camera, json node = json::object()) {
    TestGltf gltf;
    node["camera"] = gltf.add("cameras", camera);
    gltf.add_node(node);
    return gltf;
}

TestGltf with_light(const json& light, json node = json::object()) {
    TestGltf gltf;
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    node["extensions"]["KHR_lights_punctual"]["light"] = 0;
    gltf.add_node(node);
    return gltf;
}

TEST(Cameras, PlacedByTheirNodes) {
    const double h = std::sqrt(0.5);
    const Loaded loaded = load(
        with_camera(perspective(1.0),
                    {{"name", "Shot"}, {"translation", {1, 2, 3}}, {"rotation", {0, h, 0, h}}, {"scale", {2, 3, 4}}}));
    ASSERT_EQ(loaded.scene.cameras.size(), 1u);
    const SceneCamera& camera = loaded.scene.cameras[0];
    EXPECT_EQ(camera.name, "Shot");
    EXPECT_NEAR(camera.vertical_fov_degrees, 180.0 / 3.14159265358979, 1e-9);
    EXPECT_EQ(camera.aspect, 2.0);
    const dmat4& m = camera.world_from_camera;
    expect_near(dvec3(m[0]), {0, 0, -1}, 1e-12);
    expect_near(dvec3(m[1]), {0, 1, 0}, 1e-12);
    expect_near(dvec3(m[2]), {1, 0, 0}, 1e-12);
    expect_near(dvec3(m[3]), {1, 2, 3}, 1e-12);
    EXPECT_EQ(loaded.scene.meshes.size(), 0u);
}

TEST(Cameras, NamedByTheCameraWhereTheNodeHasNoName) {
    json camera = perspective(1.0);
    camera["name"] = "Lens";
    camera["perspective"].erase("aspectRatio");
    const Loaded loaded = load(with_camera(camera));
    EXPECT_EQ(loaded.scene.cameras.at(0).name, "Lens");
    EXPECT_FALSE(loaded.scene.cameras.at(0).aspect.has_value());
}

TEST(Cameras, UnderShearAndReflectionTheyStayRigid) {
    TestGltf gltf = with_camera(perspective(1.0), {{"matrix", {-2, 0, 0, 0, 1, 3, 1, 0, 0, 0, 4, 0, 5, 6, 7, 1}}});
    const dmat4 m = load(gltf).scene.cameras.at(0).world_from_camera;
    const dmat3 r(m);
    EXPECT_NEAR(glm::determinant(r), 1.0, 1e-12);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(glm::dot(r[i], r[j]), i == j ? 1.0 : 0.0, 1e-12);
    expect_near(r[2], {0, 0, 1}, 1e-12);
    expect_near(dvec3(m[3]), {5, 6, 7}, 1e-12);
}

TEST(Cameras, UnderAnimatedNodesOfAFileThatIsZUp) {
    const TempFolder folder;
    TestGltf gltf = with_camera(perspective(1.0));
    const int times = gltf.add_floats("SCALAR", {0, 2});
    const int positions = gltf.add_floats("VEC3", {0, 0, 0, 0, 4, 2});
    gltf.add("animations", {{"samplers", {{{"input", times}, {"output", positions}}}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
    gltf.write_glb(folder / "scene.glb");
    const std::vector<SceneCamera> cameras = load_cameras({"scene.glb", 'z'}, folder.path(), 1.0);
    ASSERT_EQ(cameras.size(), 1u);
    expect_near(dvec3(cameras[0].world_from_camera[3]), {0, -1, 2}, 1e-12);
    expect_near(dvec3(cameras[0].world_from_camera[1]), {0, 0, 1}, 1e-12);
    expect_near(dvec3(cameras[0].world_from_camera[2]), {0, -1, 0}, 1e-12);
}

TEST(Cameras, NoneAtAllIsNoError) {
    EXPECT_TRUE(load(one_triangle()).scene.cameras.empty());
}

TEST(Cameras, AFileOfACameraNeedsNoPicturesOrMeshesToBeSound) {
    const TempFolder folder;
    TestGltf gltf = with_camera(perspective(1.0));
    gltf.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 9});
    gltf.write_glb(folder / "scene.glb");
    EXPECT_EQ(load_cameras({"scene.glb"}, folder.path(), 0.0).size(), 1u);
}

TEST(Cameras, AFieldOfViewOf0OrAbove180DegreesIsRefused) {
    for (const double yfov : {0.0, -1.0, 3.2, 400.0}) {
        const Failure failure = failure_of_loading(with_camera(perspective(yfov), {{"name", "Shot"}}));
        EXPECT_EQ(failure.code, ExitCode::BadData) << yfov;
        EXPECT_TRUE(contains(failure.message, "Shot")) << failure.message;
    }
    EXPECT_EQ(failure_of_loading(with_camera(perspective(1.0, -2.0))).code, ExitCode::BadData);
}

TEST(Cameras, OrthographicOnesAreLeftOutWithANotice) {
    const Loaded loaded = load(with_camera(
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}}));
    EXPECT_TRUE(loaded.scene.cameras.empty());
    EXPECT_TRUE(loaded.messages.noticed("perspective"));
}

TEST(Cameras, ScaledToNothingOrNotThere) {
    EXPECT_TRUE(load(with_camera(perspective(1.0), {{"scale", {0, 0, 0}}})).messages.warned("flat-camera"));
    EXPECT_TRUE(load(with_camera(perspective(1.0), {{"scale", {1, 0, 1}}})).messages.warned("flat-camera"));
    TestGltf gltf = with_camera(perspective(1.0));
    gltf.json["nodes"][0]["camera"] = 3;
    EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData);
}

TEST(Lights, PointSpotAndSun) {
    const Loaded point =
        load(with_light({{"type", "point"}, {"color", {1, 0.5, 0.25}}, {"intensity", 8}, {"name", "Bulb"}},
                        {{"translation", {1, 2, 3}}}));
    ASSERT_EQ(point.scene.lights.size(), 1u);
    EXPECT_EQ(point.scene.lights[0].kind, LightKind::Point);
    EXPECT_EQ(point.scene.lights[0].name, "Bulb");
    EXPECT_EQ(point.scene.lights[0].power, Rgb(8, 4, 2)) << "1 cd is 1 W/sr";
    expect_near(point.scene.lights[0].position, {1, 2, 3}, 1e-12);

    const Loaded spot =
        load(with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 1.0}}}},
                        {{"rotation", {1, 0, 0, 1}}}));
    ASSERT_EQ(spot.scene.lights.size(), 1u);
    EXPECT_EQ(spot.scene.lights[0].kind, LightKind::Spot);
    EXPECT_NEAR(spot.scene.lights[0].inner_degrees, 28.64788975654116, 1e-9);
    EXPECT_NEAR(spot.scene.lights[0].outer_degrees, 57.29577951308232, 1e-9);
    expect_near(spot.scene.lights[0].direction, {0, 1, 0}, 1e-12);

    const Loaded sun = load(with_light({{"type", "directional"}, {"intensity", 3}}));
    ASSERT_EQ(sun.scene.lights.size(), 1u);
    EXPECT_EQ(sun.scene.lights[0].kind, LightKind::Sun);
    EXPECT_EQ(sun.scene.lights[0].angle_degrees, 0.0);
    expect_near(sun.scene.lights[0].direction, {0, 0, -1}, 1e-12);
}

TEST(Lights, RangesAreLeftOutWithANotice) {
    EXPECT_TRUE(load(with_light({{"type", "point"}, {"range", 5}})).messages.noticed("ranges"));
}

TEST(Lights, BadOnesAreRefused) {
    const json bad[] = {{{"type", "area"}},
                        {{"type", "point"}, {"intensity", -1}},
                        {{"type", "point"}, {"color", {-1, 0, 0}}},
                        {{"type", "spot"}, {"spot", {{"innerConeAngle", 1.0}, {"outerConeAngle", 0.5}}}},
                        {{"type", "spot"}, {"spot", {{"outerConeAngle", 3.0}}}}};
    for (const json& light : bad)
        EXPECT_EQ(failure_of_loading(with_light(light)).code, ExitCode::BadData) << light;
    TestGltf gltf = with_light({{"type", "point"}});
    gltf.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 7;
    EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData);
    EXPECT_EQ(failure_of_loading(with_light({{"type", "directional"}}, {{"scale", {0, 0, 0}}})).code,
              ExitCode::BadData);
}

}  // namespace
}  // namespace brisance::testing
