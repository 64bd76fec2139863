// What several moments of a scene have in common: whether anything moves, and the pictures.
#include <gtest/gtest.h>

#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

using nlohmann::json;

const std::vector<float> kThere = {0, 0, 0, 0, 0, 2};  // and back again: keys of a translation

bool animated(const TestGltf& gltf) {
    const bool result = load(gltf, 0.0).scene.animated;
    EXPECT_EQ(load(gltf, 0.5).scene.animated, result) << "whatever the moment";
    return result;
}

TEST(Animated, ByAMovedMeshOrItsAncestors) {
    TestGltf gltf = one_triangle();
    EXPECT_FALSE(animated(gltf));
    const int parent = gltf.add("nodes", {{"children", {0}}});
    gltf.json["scenes"][0]["nodes"] = {parent};
    EXPECT_FALSE(animated(gltf));
    TestGltf itself = gltf;
    itself.animate("translation", "LINEAR", {0, 1}, kThere, 0);
    EXPECT_TRUE(animated(itself));
    gltf.animate("translation", "LINEAR", {0, 1}, kThere, parent);
    EXPECT_TRUE(animated(gltf));
}

TEST(Animated, NotByWhatIsNotThere) {
    TestGltf empty = one_triangle();
    empty.animate("translation", "LINEAR", {0, 1}, kThere, empty.add_node(json::object()));
    EXPECT_FALSE(animated(empty)) << "a node without a mesh";
    TestGltf other = one_triangle();
    other.animate("translation", "LINEAR", {0, 1}, kThere, other.add("nodes", {{"mesh", 0}}));
    EXPECT_FALSE(animated(other)) << "a node that is not of the scene";
    TestGltf points = one_triangle();
    points.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0})["mode"] = 0;
    points.animate("translation", "LINEAR", {0, 1}, kThere, 1);
    EXPECT_FALSE(animated(points)) << "points, which are left out";
    TestGltf fixed = one_triangle();
    fixed.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    fixed.animate("translation", "LINEAR", {0, 1}, kThere);
    EXPECT_FALSE(animated(fixed)) << "a node with a matrix, whose animation is left out";
}

TEST(Animated, NotByKeysThatStandStill) {
    const auto with = [](const std::string& interpolation, const std::vector<float>& times,
                         const std::vector<float>& values) {
        TestGltf gltf = one_triangle();
        gltf.animate("translation", interpolation, times, values);
        return animated(gltf);
    };
    EXPECT_FALSE(with("LINEAR", {0, 1}, {1, 2, 3, 1, 2, 3}));
    EXPECT_FALSE(with("STEP", {0}, {1, 2, 3}));
    EXPECT_TRUE(with("STEP", {0, 1}, {1, 2, 3, 1, 2, 4}));
    EXPECT_FALSE(with("CUBICSPLINE", {0, 1}, {0, 0, 0, 5, 6, 7, 0, 0, 0, 0, 0, 0, 5, 6, 7, 0, 0, 0}));
    EXPECT_TRUE(with("CUBICSPLINE", {0, 1}, {0, 0, 0, 5, 6, 7, 0, 1, 0, 0, 0, 0, 5, 6, 7, 0, 0, 0}))
        << "a tangent moves it between equal keys";
}

TEST(Animated, ByWeights) {
    TestGltf gltf = one_triangle();
    gltf.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
    gltf.json["nodes"][0]["weights"] = {0.5};
    EXPECT_FALSE(animated(gltf));
    TestGltf still = gltf;
    still.animate("weights", "LINEAR", {0, 1}, {0.5f, 0.5f});
    EXPECT_FALSE(animated(still));
    gltf.animate("weights", "LINEAR", {0, 1}, {0, 1});
    EXPECT_TRUE(animated(gltf));
}

TEST(Animated, ByJointsButNotByTheNodeOfASkinnedMesh) {
    TestGltf gltf = one_triangle();
    const int joint = gltf.add("nodes", json::object());
    const int parent = gltf.add_node({{"children", {joint}}});
    gltf.json["nodes"][0]["skin"] = gltf.add("skins", {{"joints", {joint}}});
    json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["WEIGHTS_0"] = gltf.add_floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    attributes["JOINTS_0"] = gltf.add("accessors", {{"bufferView", gltf.add_view(std::string(12, '\0'))},
                                                    {"componentType", 5121},
                                                    {"count", 3},
                                                    {"type", "VEC4"}});
    EXPECT_FALSE(animated(gltf));
    TestGltf own_node = gltf;
    own_node.animate("translation", "LINEAR", {0, 1}, kThere, 0);
    EXPECT_FALSE(animated(own_node));
    gltf.animate("translation", "LINEAR", {0, 1}, kThere, parent);
    EXPECT_TRUE(animated(gltf));
}

TEST(Animated, ByCamerasAndLights) {
    TestGltf gltf = one_triangle();
    gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    const int camera = gltf.add_node({{"camera", 0}});
    const int light = gltf.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    EXPECT_FALSE(animated(gltf));
    for (const int node : {camera, light}) {
        TestGltf moved = gltf;
        moved.animate("translation", "LINEAR", {0, 1}, kThere, node);
        EXPECT_TRUE(animated(moved));
    }
}

// A triangle that moves, with a picture beside the file and one in its buffer.
TestGltf moving_pictures() {
    TestGltf gltf = one_triangle();
    const int view = gltf.add_view(encoded(".png", 2, 1, 3, {1, 2, 3, 4, 5, 6}));
    gltf.add("textures", {{"source", gltf.add("images", {{"bufferView", view}})}});
    gltf.add("textures", {{"source", gltf.add("images", {{"uri", "beside.png"}})}});
    json& primitive = gltf.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 0, 1, 0, 0, 1});
    primitive["material"] =
        gltf.add("materials", {{"pbrMetallicRoughness",
                                {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}}});
    gltf.animate("translation", "LINEAR", {0, 1}, kThere);
    return gltf;
}

TEST(SamePictures, AreSharedAndNotOpenedAgain) {
    const TempFolder folder;
    moving_pictures().write_glb(folder / "scene.glb");
    write_bytes(folder / "beside.png", encoded(".png", 1, 1, 4, {9, 8, 7, 6}));
    SceneSettings settings;
    settings.files = {{"scene.glb"}, {"scene.glb"}};  // twice: four textures
    Listener messages;
    const auto moment = [&](double seconds, std::uint64_t memory, const Scene* same) {
        return load_scene(settings, folder.path(), seconds, dvec3(0.0), memory, messages, same);
    };
    const Scene first = moment(0.0, kPlenty, nullptr), alone = moment(0.5, kPlenty, nullptr);
    std::filesystem::remove(folder / "beside.png");
    EXPECT_EQ(failure_of([&] { moment(0.5, kPlenty, nullptr); }).code, ExitCode::MissingInput);
    const Scene second = moment(0.5, kPlenty, &first);
    ASSERT_EQ(second.textures.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(second.textures[i], first.textures[i]) << "one and the same";
        EXPECT_NE(alone.textures[i], first.textures[i]);
        EXPECT_EQ(alone.textures[i]->bytes, first.textures[i]->bytes) << "as when they are read again";
    }
    for (std::size_t m = 0; m < 2; ++m) {
        EXPECT_EQ(second.materials[m].base_colour.texture, alone.materials[m].base_colour.texture);
        EXPECT_EQ(second.materials[m].metal_rough.texture, alone.materials[m].metal_rough.texture);
        EXPECT_EQ(second.meshes[m].positions, alone.meshes[m].positions);
    }
    expect_near(second.meshes[0].positions[0], {0, 0, 1});
}

TEST(SamePictures, DoNotCountAsMemoryAgain) {
    const TempFolder folder;
    TestGltf gltf = moving_pictures();
    gltf.json["images"][0] = {{"uri", "large.png"}};
    gltf.write_glb(folder / "scene.glb");
    write_bytes(folder / "beside.png", encoded(".png", 1, 1, 4, {9, 8, 7, 6}));
    write_bytes(folder / "large.png", encoded(".png", 512, 512, 3, std::vector<std::uint8_t>(512 * 512 * 3, 5)));
    SceneSettings settings;
    settings.files = {{"scene.glb"}};
    Progress silent;
    const Scene first = load_scene(settings, folder.path(), 0.0, dvec3(0.0), kPlenty, silent);
    constexpr std::uint64_t kFew = 512 * 512;
    const auto code = [&](const Scene* same) {
        return failure_of([&] { load_scene(settings, folder.path(), 1.0, dvec3(0.0), kFew, silent, same); }).code;
    };
    EXPECT_EQ(code(nullptr), ExitCode::Temporary);
    EXPECT_EQ(code(&first), ExitCode::Success);
}

}  // namespace
}  // namespace brisance::testing
