// Morph targets and their weights.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

using nlohmann::json;

json& primitive_of(TestGltf& gltf) {
    return gltf.json["meshes"][0]["primitives"][0];
}

// A triangle whose first target lifts its corner (1 0 0) by 2 along z, and whose second moves its corner (0 1 0) by
// 3 along x.
TestGltf two_targets() {
    TestGltf gltf = one_triangle();
    primitive_of(gltf)["targets"] = {{{"POSITION", gltf.add_floats("VEC3", {0, 0, 0, 0, 0, 2, 0, 0, 0})}},
                                     {{"POSITION", gltf.add_floats("VEC3", {0, 0, 0, 0, 0, 0, 3, 0, 0})}}};
    return gltf;
}

// Expects the triangle of two_targets() under these weights.
void expect_weights(const Loaded& loaded, double first, double second) {
    const SceneMesh& mesh = loaded.scene.meshes.at(0);
    expect_near(mesh.positions[0], {0, 0, 0});
    expect_near(mesh.positions[1], {1, 0, 2 * first});
    expect_near(mesh.positions[2], {3 * second, 1, 0});
    EXPECT_TRUE(mesh.normals.empty()) << "flat as before";
    EXPECT_TRUE(loaded.messages.warnings.empty());
}

TEST(MorphTargets, TwoThatAreAnimatedLinearly) {
    TestGltf gltf = two_targets();
    gltf.animate("weights", "LINEAR", {1, 3}, {0, 1, 1, -0.5f});
    expect_weights(load(gltf, 0.0), 0.0, 1.0);
    expect_weights(load(gltf, 1.5), 0.25, 0.625);
    expect_weights(load(gltf, 2.0), 0.5, 0.25);
    expect_weights(load(gltf, 9.0), 1.0, -0.5);
}

TEST(MorphTargets, StepHolds) {
    TestGltf gltf = two_targets();
    gltf.animate("weights", "STEP", {0, 1, 2}, {0, 1, 0.5f, 0.25f, 1, 0});
    expect_weights(load(gltf, 0.99), 0.0, 1.0);
    expect_weights(load(gltf, 1.99), 0.5, 0.25);
    expect_weights(load(gltf, 2.0), 1.0, 0.0);
}

TEST(MorphTargets, CubicSplines) {
    TestGltf gltf = two_targets();
    // On [0, 2] the first weight is t^3, tangents 0 and 12, and the second t^2, tangents 0 and 4. A key has all
    // tangents before it, all values, all tangents after it.
    gltf.animate("weights", "CUBICSPLINE", {0, 2}, {9, 9, 0, 0, 0, 0, 12, 4, 8, 4, 9, 9});
    for (const double t : {0.0, 0.5, 1.3, 2.0})
        expect_weights(load(gltf, t), t * t * t, t * t);
}

TEST(MorphTargets, WeightsOfAnimationThenNodeThenMeshThenNone) {
    TestGltf gltf = two_targets();
    expect_weights(load(gltf), 0.0, 0.0);
    gltf.json["meshes"][0]["weights"] = {0.25, 0.5};
    expect_weights(load(gltf), 0.25, 0.5);
    gltf.json["nodes"][0]["weights"] = {1.0, -1.0};
    expect_weights(load(gltf), 1.0, -1.0);
    gltf.animate("weights", "LINEAR", {0}, {0.75f, 0});
    expect_weights(load(gltf), 0.75, 0.0);
}

TEST(MorphTargets, EachNodeHasWeightsOfItsOwn) {
    TestGltf gltf = two_targets();
    gltf.add_node({{"mesh", 0}, {"weights", {0, 1}}, {"translation", {0, 0, 5}}});
    gltf.json["nodes"][0]["weights"] = {1, 0};
    const Loaded loaded = load(gltf);
    expect_near(loaded.scene.meshes.at(0).positions[1], {1, 0, 2});
    expect_near(loaded.scene.meshes.at(1).positions[1], {1, 0, 5});
    expect_near(loaded.scene.meshes.at(1).positions[2], {3, 1, 5});
}

TEST(MorphTargets, NormalsAreDisplacedThenMadeUnit) {
    TestGltf gltf = two_targets();
    primitive_of(gltf)["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    primitive_of(gltf)["targets"][0]["NORMAL"] = gltf.add_floats("VEC3", {1, 0, 0, 0, 0, 0, 0, 0, 1});
    primitive_of(gltf)["targets"][1]["NORMAL"] = gltf.add_floats("VEC3", {0, 2, 0, 0, 0, 0, 0, 0, 0});
    primitive_of(gltf)["targets"][1]["TANGENT"] = 99;  // not looked at, as tangents of the mesh
    gltf.json["nodes"][0]["weights"] = {0.5, 0.25};
    gltf.json["nodes"][0]["scale"] = {1, 1, 2};
    const SceneMesh mesh = load(gltf).scene.meshes.at(0);
    expect_near(mesh.normals[0], glm::normalize(dvec3(0.5, 0.5, 0.5)));
    expect_near(mesh.normals[1], {0, 0, 1});
    expect_near(mesh.normals[2], {0, 0, 1});
}

TEST(MorphTargets, SparseDisplacementsWithoutAView) {
    TestGltf gltf = two_targets();
    const int indices = gltf.add_view(std::string("\1\0", 2));
    const json values = gltf.json["accessors"].at(static_cast<std::size_t>(gltf.add_floats("VEC3", {0, 0, 2})));
    gltf.json["accessors"][1].erase("bufferView");
    gltf.json["accessors"][1]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", values["bufferView"]}}}};
    gltf.json["nodes"][0]["weights"] = {0.5, 1};
    expect_weights(load(gltf), 0.5, 1.0);
}

TEST(MorphTargets, QuantisedDisplacements) {
    TestGltf gltf = two_targets();
    gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const std::vector<std::int8_t> bytes = {0, 0, 0, 0, 0, 0, 127, 0, 0, 0, 0, 0};
    gltf.json["accessors"][1].update(
        {{"bufferView", gltf.add_view({bytes.begin(), bytes.end()})}, {"componentType", 5120}, {"normalized", true}});
    gltf.json["bufferViews"].back()["byteStride"] = 4;
    gltf.json["nodes"][0]["weights"] = {0.5, 0};
    expect_weights(load(gltf), 0.25, 0.0);
}

TEST(MorphTargets, ComeBeforeTheSkin) {
    TestGltf gltf = two_targets();
    const int joint = gltf.add_node({{"scale", {10, 1, 1}}});
    gltf.json["nodes"][0]["skin"] = gltf.add("skins", {{"joints", {joint}}});
    gltf.json["nodes"][0]["weights"] = {0, 1};
    primitive_of(gltf)["attributes"]["WEIGHTS_0"] = gltf.add_floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    const int view = gltf.add_view(std::string(12, '\0'));
    primitive_of(gltf)["attributes"]["JOINTS_0"] =
        gltf.add("accessors", {{"bufferView", view}, {"componentType", 5121}, {"count", 3}, {"type", "VEC4"}});
    gltf.animate("scale", "LINEAR", {0, 1}, {10, 1, 1, 20, 1, 1}, joint);
    gltf.animate("weights", "LINEAR", {0, 1}, {0, 1, 0, 2});
    expect_near(load(gltf, 0.0).scene.meshes.at(0).positions[2], {30, 1, 0});
    expect_near(load(gltf, 0.5).scene.meshes.at(0).positions[2], {15 * 4.5, 1, 0}, 1e-5);
}

TEST(MorphTargets, TextureCoordinatesStayWithANotice) {
    TestGltf gltf = two_targets();
    primitive_of(gltf)["targets"][0]["TEXCOORD_0"] = 0;
    EXPECT_TRUE(load(gltf).messages.noticed("texture coordinates of morph targets"));
}

TEST(MorphTargets, WeightsWithoutTargetsAreLeftOutWithANotice) {
    TestGltf gltf = one_triangle();
    gltf.animate("weights", "LINEAR", {0, 1}, {0, 1});
    const Loaded loaded = load(gltf);
    EXPECT_TRUE(loaded.messages.noticed("there are no morph targets"));
    EXPECT_FALSE(loaded.scene.animated);
}

// The line of morph targets that have been damaged.
std::string line_of_targets(const std::function<void(TestGltf&)>& damage) {
    TestGltf gltf = two_targets();
    gltf.json["nodes"][0]["weights"] = {1, 0};
    damage(gltf);
    const Failure failure = failure_of_loading(gltf);
    EXPECT_EQ(failure.code, ExitCode::BadData) << failure.message;
    return failure.message;
}

TEST(MorphTargets, BadOnesAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(contains(line_of_targets([](TestGltf& g) {
                             primitive_of(g)["targets"][1]["POSITION"] = g.add_floats("VEC3", {0, 0, 0});
                         }),
                         "morph target 1: displacements of positions are not as many as the 3 vertices"));
    EXPECT_TRUE(
        contains(line_of_targets([&](TestGltf& g) {
                     primitive_of(g)["targets"][0]["POSITION"] = g.add_floats("VEC3", {0, 0, 0, nan, 0, 0, 0, 0, 0});
                 }),
                 "morph target 0: displacements of positions are not all finite"));
    EXPECT_TRUE(
        contains(line_of_targets([](TestGltf& g) { primitive_of(g)["targets"][0]["POSITION"] = 99; }), "99 is used"));
    EXPECT_TRUE(contains(line_of_targets([](TestGltf& g) {
                             g.json["meshes"][0]["primitives"].push_back(primitive_of(g));
                             primitive_of(g).erase("targets");
                         }),
                         "primitives with different numbers of morph targets"));
}

TEST(MorphTargets, BadWeightsAreRefused) {
    EXPECT_TRUE(contains(line_of_targets([](TestGltf& g) { g.json["nodes"][0]["weights"] = {1}; }),
                         "node 0 has 1 weights, and its mesh 2 morph targets"));
    EXPECT_TRUE(contains(line_of_targets([](TestGltf& g) {
                             g.json["nodes"][0].erase("weights");
                             g.json["meshes"][0]["weights"] = {1, 2, 3};
                         }),
                         "node 0 has 3 weights, and its mesh 2 morph targets"));
    EXPECT_TRUE(contains(line_of_targets([](TestGltf& g) {
                             g.animate("weights", "LINEAR", {0, 1}, {0, 1, 0});
                         }),
                         "does not have 2 weights for each time"));
    EXPECT_TRUE(contains(line_of_targets([](TestGltf& g) {
                             g.animate("weights", "CUBICSPLINE", {0}, {0, 1});
                         }),
                         "does not have 2 weights for each time"));
    EXPECT_TRUE(contains(line_of_targets([](TestGltf& g) {
                             g.animate("weights", "STEP", {0}, {0, std::numeric_limits<float>::infinity()});
                         }),
                         "values that are not finite"));
}

}  // namespace
}  // namespace brisance::testing
