// Meshes that follow the joints of a skin.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

using nlohmann::json;

const float kHalf = std::sqrt(0.5f);
const std::vector<float> kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

std::string as_text(const std::vector<std::uint8_t>& bytes) {
    return {bytes.begin(), bytes.end()};
}

// JOINTS_n of bytes, four for each vertex.
int add_joints(TestGltf& gltf, const std::vector<std::uint8_t>& joints) {
    const int view = gltf.add_view(as_text(joints));
    return gltf.add("accessors",
                    {{"bufferView", view}, {"componentType", 5121}, {"count", joints.size() / 4}, {"type", "VEC4"}});
}

json& attributes_of(TestGltf& gltf) {
    return gltf.json["meshes"][0]["primitives"][0]["attributes"];
}

// A triangle on node 0 whose corners follow the joints, nodes 1, 2, ... of the scene, by the weights.
TestGltf skinned(const std::vector<json>& joints, const std::vector<std::uint8_t>& joint_of,
                 const std::vector<float>& weight_of) {
    TestGltf gltf = one_triangle();
    json nodes = json::array();
    for (const json& joint : joints)
        nodes.push_back(gltf.add_node(joint));
    gltf.json["nodes"][0]["skin"] = gltf.add("skins", {{"joints", nodes}, {"name", "Bar"}});
    attributes_of(gltf)["JOINTS_0"] = add_joints(gltf, joint_of);
    attributes_of(gltf)["WEIGHTS_0"] = gltf.add_floats("VEC4", weight_of);
    return gltf;
}

// All corners follow the first joint.
TestGltf skinned(const json& joint) {
    return skinned({joint}, std::vector<std::uint8_t>(12, 0), {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
}

// The weight of the upper joint at a height of the bar.
double upper(double y) {
    return std::min(std::max(y - 0.5, 0.0), 1.0);
}

constexpr int kRows = 9;  // of the bar, from y = 0 to 2

// A strip of two columns from y = 0 to 2 with a joint at its foot and one in the middle, which bends by a quarter turn
// about z within the first second. The mesh's node is elsewhere, which is of no account.
TestGltf bar() {
    TestGltf gltf;
    std::vector<float> positions, normals, weights;
    std::vector<std::uint8_t> joints;
    for (int row = 0; row < kRows; ++row)
        for (const float x : {-0.25f, 0.25f}) {
            const float y = 2.0f * static_cast<float>(row) / (kRows - 1);
            const auto w = static_cast<float>(upper(y));
            positions.insert(positions.end(), {x, y, 0.0f});
            normals.insert(normals.end(), {4.0f * x, 0.0f, 0.0f});
            joints.insert(joints.end(), {0, 1, 0, 0});
            weights.insert(weights.end(), {1.0f - w, w, 0.0f, 0.0f});
        }
    gltf.add_mesh(positions)["mode"] = 5;
    json& attributes = attributes_of(gltf);
    attributes["NORMAL"] = gltf.add_floats("VEC3", normals);
    attributes["JOINTS_0"] = add_joints(gltf, joints);
    attributes["WEIGHTS_0"] = gltf.add_floats("VEC4", weights);
    const int elbow = gltf.add("nodes", {{"translation", {0, 1, 0}}});
    const int foot = gltf.add_node({{"children", {elbow}}});
    std::vector<float> matrices = kIdentity;
    matrices.insert(matrices.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1});
    const int inverse = gltf.add_floats("MAT4", matrices);
    gltf.json["nodes"][0]["translation"] = {100, 200, 300};
    gltf.json["nodes"][0]["skin"] = gltf.add("skins", {{"joints", {foot, elbow}}, {"inverseBindMatrices", inverse}});
    gltf.animate("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, kHalf, kHalf}, elbow);
    return gltf;
}

TEST(Skins, ABarBendsByAQuarterTurn) {
    const Loaded loaded = load(bar(), 1.0);
    const SceneMesh& mesh = loaded.scene.meshes.at(0);
    ASSERT_EQ(mesh.positions.size(), 2u * kRows);
    for (int i = 0; i < 2 * kRows; ++i) {
        const double x = i % 2 == 0 ? -0.25 : 0.25, y = 2.0 * (i / 2) / (kRows - 1), w = upper(y);
        const auto v = static_cast<std::size_t>(i);
        // About (0 1 0), (x y) becomes (1 - y, 1 + x).
        expect_near(mesh.positions[v], {(1 - w) * x + w * (1 - y), (1 - w) * y + w * (1 + x), 0.0});
        expect_near(mesh.normals[v], glm::normalize(4.0 * x * dvec3(1 - w, w, 0.0)));
    }
    EXPECT_TRUE(loaded.messages.warnings.empty());
    EXPECT_TRUE(loaded.messages.notices.empty());
}

TEST(Skins, InTheirBindPoseMeshesKeepTheirShape) {
    const SceneMesh mesh = load(bar(), 0.0).scene.meshes.at(0);
    for (int i = 0; i < 2 * kRows; ++i)
        expect_near(mesh.positions[static_cast<std::size_t>(i)],
                    {i % 2 == 0 ? -0.25 : 0.25, 2.0 * (i / 2) / (kRows - 1), 0.0});
}

TEST(Skins, StandWhereTheFileStandsAndKeepTheirDigits) {
    const TempFolder folder;
    bar().write_glb(folder / "bar.glb");
    SceneFile file{"bar.glb", 'z', dmat4(2.0)};
    file.world_from_file[3] = {1e7 + 0.125, 0, 0, 1};
    SceneSettings settings;
    settings.files.push_back(file);
    const Loaded loaded = load_settings(settings, folder.path(), 0.0, kPlenty, dvec3(1e7, 0, 0));
    const SceneMesh& mesh = loaded.scene.meshes.at(0);
    expect_near(mesh.positions.back(), {0.125 + 2 * 0.25, 0, 4}, 1e-6);
    expect_near(mesh.normals.back(), {1, 0, 0});
}

TEST(Skins, NormalsStayPerpendicularUnderUnevenScale) {
    // Half of a joint at rest and half of one scaled by (3 1 1): (2 1 1).
    TestGltf gltf = skinned({json::object(), {{"scale", {3, 1, 1}}}}, {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0},
                            {0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0});
    const float third = std::sqrt(1.0f / 3.0f);
    attributes_of(gltf)["POSITION"] = gltf.add_floats("VEC3", {1, 0, 0, 0, 1, 0, 0, 0, 1});
    attributes_of(gltf)["NORMAL"] =
        gltf.add_floats("VEC3", {third, third, third, third, third, third, third, third, third});
    const SceneMesh mesh = load(gltf).scene.meshes.at(0);
    expect_near(mesh.positions[0], {2, 0, 0});
    for (const vec3& n : mesh.normals)
        expect_near(n, glm::normalize(dvec3(0.5, 1, 1)));
    expect_near(glm::normalize(cross_of(mesh, 0)), mesh.normals[0]);
}

TEST(Skins, JointsAndWeightsOfAllTypes) {
    // Corner c moves by 51 / 255, 102 / 255, 255 / 255 of joint 1's way.
    const std::vector<std::uint8_t> joints = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
    const std::vector<std::uint8_t> weights = {204, 51, 0, 0, 153, 102, 0, 0, 0, 255, 0, 0};
    const auto corners = [&](bool wide_joints, bool wide_weights) {
        TestGltf gltf = skinned({json::object(), {{"translation", {0, 0, 5}}}}, joints, std::vector<float>(12, 1));
        json& joint = gltf.json["accessors"][attributes_of(gltf)["JOINTS_0"].get<std::size_t>()];
        json& weight = gltf.json["accessors"][attributes_of(gltf)["WEIGHTS_0"].get<std::size_t>()];
        std::vector<std::uint8_t> two_bytes;
        for (const std::uint8_t j : joints)
            two_bytes.insert(two_bytes.end(), {j, 0});
        if (wide_joints)
            joint.update({{"bufferView", gltf.add_view(as_text(two_bytes))}, {"componentType", 5123}});
        two_bytes.clear();
        for (const std::uint8_t w : weights)
            two_bytes.insert(two_bytes.end(), {w, w});  // 257 w
        const int view = gltf.add_view(as_text(wide_weights ? two_bytes : weights));
        weight.update({{"bufferView", view}, {"componentType", wide_weights ? 5123 : 5121}, {"normalized", true}});
        return load(gltf).scene.meshes.at(0).positions;
    };
    for (const bool wide_joints : {false, true})
        for (const bool wide_weights : {false, true}) {
            const std::vector<vec3> p = corners(wide_joints, wide_weights);
            expect_near(p[0], {0, 0, 1});
            expect_near(p[1], {1, 0, 2});
            expect_near(p[2], {0, 1, 5});
        }
}

TEST(Skins, WeightsAreDividedByTheirSum) {
    const TestGltf gltf = skinned({json::object(), {{"translation", {0, 0, 4}}}}, {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0},
                                  {3, 1, 0, 0, 0.001f, 0.001f, 0, 0, 0, 1e-30f, 0, 0});
    const SceneMesh mesh = load(gltf).scene.meshes.at(0);
    expect_near(mesh.positions[0], {0, 0, 1});
    expect_near(mesh.positions[1], {1, 0, 2});
    expect_near(mesh.positions[2], {0, 1, 4});
}

TEST(Skins, AllSetsCount) {
    TestGltf gltf = skinned({json::object(), {{"translation", {0, 0, 4}}}}, std::vector<std::uint8_t>(12, 0),
                            {1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    attributes_of(gltf)["JOINTS_1"] = add_joints(gltf, std::vector<std::uint8_t>(12, 1));
    attributes_of(gltf)["WEIGHTS_1"] = gltf.add_floats("VEC4", {0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0});
    const SceneMesh mesh = load(gltf).scene.meshes.at(0);
    expect_near(mesh.positions[0], {0, 0, 1});
    expect_near(mesh.positions[1], {1, 0, 2});
    expect_near(mesh.positions[2], {0, 1, 0});
}

TEST(Skins, WithoutInverseBindMatricesJointsMoveTheMeshAsItIs) {
    const Loaded loaded = load(skinned({{"translation", {0, 0, 7}}}));
    expect_near(loaded.scene.meshes.at(0).positions[1], {1, 0, 7});
    EXPECT_TRUE(loaded.messages.warnings.empty()) << loaded.messages.warnings[0].second;
}

TEST(Skins, VerticesWithoutWeightFollowTheirFirstJointWithAWarning) {
    const Loaded loaded = load(skinned({json::object(), {{"translation", {0, 0, 4}}}},
                                       {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}));
    expect_near(loaded.scene.meshes.at(0).positions[0], {0, 0, 4});
    ASSERT_TRUE(loaded.messages.warned("skin-weights"));
    EXPECT_TRUE(contains(loaded.messages.warnings[0].second, "1 vertices"));
}

TEST(Skins, AMirroringJointKeepsTheFrontInFront) {
    TestGltf gltf = skinned({{"scale", {-2, 1, 1}}});
    attributes_of(gltf)["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    const SceneMesh mesh = load(gltf).scene.meshes.at(0);
    expect_near(cross_of(mesh, 0), {0, 0, 2});
    expect_near(mesh.normals[0], {0, 0, 1});
}

TEST(Skins, JointsWithoutASkinAreOfNoAccount) {
    TestGltf gltf = skinned({{"translation", {0, 0, 7}}});
    gltf.json["nodes"][0].erase("skin");
    expect_near(load(gltf).scene.meshes.at(0).positions[1], {1, 0, 0});
}

// The line of a skin that has been damaged.
std::string line_of(const std::function<void(TestGltf&)>& damage) {
    TestGltf gltf = skinned(json::object());
    damage(gltf);
    const Failure failure = failure_of_loading(gltf);
    EXPECT_EQ(failure.code, ExitCode::BadData) << failure.message;
    return failure.message;
}

TEST(Skins, BadJointsAreRefused) {
    EXPECT_TRUE(contains(line_of([](TestGltf& g) { g.json["nodes"][0]["skin"] = 3; }), "skin 3 is used, of 1"));
    EXPECT_TRUE(contains(line_of([](TestGltf& g) { g.json["skins"][0]["joints"] = json::array(); }),
                         "skin 0 (Bar) has no joints"));
    EXPECT_TRUE(contains(line_of([](TestGltf& g) { g.json["skins"][0]["joints"] = {9}; }), "node 9 is used, of 2"));
    EXPECT_TRUE(contains(line_of([](TestGltf& g) { g.json["scenes"][0]["nodes"] = {0}; }),
                         "skin 0 (Bar): its joint, node 1, is not in the scene"));
    EXPECT_TRUE(contains(line_of([](TestGltf& g) {
                             attributes_of(g)["JOINTS_0"] = add_joints(g, {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
                         }),
                         "JOINTS_0 names joint 1, and skin 0 (Bar) has 1 joints"));
    EXPECT_TRUE(contains(
        line_of([](TestGltf& g) { attributes_of(g)["JOINTS_0"] = g.add_floats("VEC4", std::vector<float>(12, 0.0f)); }),
        "not unsigned integers"));
    EXPECT_TRUE(contains(
        line_of([](TestGltf& g) { attributes_of(g)["JOINTS_0"] = add_joints(g, std::vector<std::uint8_t>(8, 0)); }),
        "JOINTS_0 has 2 elements, and there are 3 vertices"));
}

TEST(Skins, BadWeightsAreRefused) {
    const auto with = [](const std::vector<float>& weights) {
        return line_of([&](TestGltf& g) { attributes_of(g)["WEIGHTS_0"] = g.add_floats("VEC4", weights); });
    };
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(contains(with({1, 0, 0, 0, 1, 0, 0, 0}), "WEIGHTS_0 has 2 elements, and there are 3 vertices"));
    for (const float bad : {nan, inf, -0.5f})
        EXPECT_TRUE(contains(with({1, 0, 0, 0, 1, 0, 0, 0, 1, bad, 0, 0}), "not a number from 0 on")) << bad;
    EXPECT_TRUE(contains(line_of([](TestGltf& g) { attributes_of(g).erase("WEIGHTS_0"); }),
                         "1 sets of joints and 0 of weights"));
    EXPECT_TRUE(contains(line_of([](TestGltf& g) { attributes_of(g)["JOINTS_1"] = attributes_of(g)["JOINTS_0"]; }),
                         "2 sets of joints and 1 of weights"));
    EXPECT_TRUE(contains(line_of([](TestGltf& g) {
                             attributes_of(g).erase("JOINTS_0");
                             attributes_of(g).erase("WEIGHTS_0");
                         }),
                         "0 sets of joints and 0 of weights"));
    EXPECT_TRUE(contains(
        line_of([](TestGltf& g) { attributes_of(g)["WEIGHTS_0"] = g.add_floats("VEC3", std::vector<float>(9, 1.0f)); }),
        "another number of components"));
}

TEST(Skins, BadInverseBindMatricesAreRefused) {
    const auto with = [](const std::string& type, const std::vector<float>& numbers) {
        return line_of([&](TestGltf& g) { g.json["skins"][0]["inverseBindMatrices"] = g.add_floats(type, numbers); });
    };
    EXPECT_TRUE(contains(with("VEC4", kIdentity), "not 4x4 matrices of floats"));
    EXPECT_TRUE(contains(with("MAT4", {}), "inverse bind matrices are 0, and there are 1 joints"));
    std::vector<float> bad = kIdentity;
    bad[5] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(contains(with("MAT4", bad), "not finite"));
    bad = kIdentity;
    bad[3] = 0.5f;
    EXPECT_TRUE(contains(with("MAT4", bad), "last row is not 0 0 0 1"));
    EXPECT_TRUE(contains(line_of([](TestGltf& g) { g.json["skins"][0]["inverseBindMatrices"] = 99; }), "99 is used"));
    EXPECT_TRUE(contains(line_of([](TestGltf& g) {
                             const int accessor = g.add_floats("MAT4", kIdentity);
                             g.json["accessors"][static_cast<std::size_t>(accessor)]["componentType"] = 5125;
                             g.json["skins"][0]["inverseBindMatrices"] = accessor;
                         }),
                         "not 4x4 matrices of floats"));
    EXPECT_TRUE(contains(line_of([](TestGltf& g) {  // 2^60 matrices of which none is there
                             g.json["skins"][0]["inverseBindMatrices"] =
                                 g.add("accessors", {{"componentType", 5126},
                                                     {"count", std::uint64_t{1} << 60},
                                                     {"type", "MAT4"},
                                                     {"sparse",
                                                      {{"count", 0},
                                                       {"indices", {{"bufferView", 0}, {"componentType", 5123}}},
                                                       {"values", {{"bufferView", 0}}}}}});
                         }),
                         "have no data"));
}

// A scene that its triangles alone would fit into the memory for.
TEST(Skins, WhatTheyNeedIsJudgedBeforeItIsAllocated) {
    constexpr std::uint64_t kVertices = 3'000'000;
    TestGltf gltf = skinned(json::object());
    const int view = gltf.add_view(std::string(16, '\0'));
    for (json& accessor : gltf.json["accessors"]) {  // all 0, but for one element
        accessor.erase("bufferView");
        accessor["count"] = kVertices;
        accessor["sparse"] = {{"count", 1},
                              {"indices", {{"bufferView", view}, {"componentType", 5123}}},
                              {"values", {{"bufferView", view}}}};
    }
    const TempFolder folder;
    constexpr std::uint64_t kTriangles = kVertices / 3 * (12 + 150) + kVertices * 32, kMore = 1 << 20;
    const auto code = [&] {
        gltf.write_glb(folder / "scene.glb");
        return failure_of([&] { load_file(folder / "scene.glb", 0.0, kTriangles + kMore); }).code;
    };
    EXPECT_EQ(code(), ExitCode::Temporary);
    gltf.json["nodes"][0].erase("skin");
    EXPECT_EQ(code(), ExitCode::Success) << "nothing is claimed for a skin that is not used";
}

}  // namespace
}  // namespace brisance::testing
