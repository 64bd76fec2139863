// Node hierarchies and animations.
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

using nlohmann::json;

// Where the triangle's corner (1 0 0) is.
dvec3 corner_at(const TestGltf& gltf, double seconds = 0.0) {
    return load(gltf, seconds).scene.meshes.at(0).positions.at(1);
}

TEST(Nodes, TranslationRotationScaleInThatOrder) {
    TestGltf gltf = one_triangle();
    const double h = std::sqrt(0.5);  // a quarter turn about z
    gltf.json["nodes"][0].update({{"translation", {1, 2, 3}}, {"rotation", {0, 0, h, h}}, {"scale", {5, 6, 7}}});
    expect_near(corner_at(gltf), {1, 7, 3});
}

TEST(Nodes, MatricesAreColumnByColumn) {
    TestGltf gltf = one_triangle();
    gltf.json["nodes"][0]["matrix"] = {0, 5, 0, 0, -6, 0, 0, 0, 0, 0, 7, 0, 1, 2, 3, 1};
    expect_near(corner_at(gltf), {1, 7, 3});
}

TEST(Nodes, ParentsMoveTheirChildren) {
    TestGltf gltf = one_triangle();
    const int parent = gltf.add("nodes", {{"children", {0}}, {"scale", {2, 2, 2}}});
    const int grandparent = gltf.add("nodes", {{"children", {parent}}, {"translation", {0, 0, 1}}});
    gltf.json["scenes"][0]["nodes"] = {grandparent};
    gltf.json["nodes"][0]["translation"] = {1, 0, 0};
    expect_near(corner_at(gltf), {4, 0, 1});
}

TEST(Nodes, TheDefaultSceneElseTheFirstElseAllRoots) {
    TestGltf gltf = one_triangle();
    gltf.add("nodes", {{"mesh", 0}});
    gltf.add("nodes", {{"mesh", 0}, {"children", {1}}});
    gltf.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {0, 2}}}};
    gltf.json["scene"] = 1;
    EXPECT_EQ(load(gltf).scene.meshes.size(), 3u);
    gltf.json.erase("scene");
    EXPECT_EQ(load(gltf).scene.meshes.size(), 1u);
    gltf.json.erase("scenes");
    EXPECT_EQ(load(gltf).scene.meshes.size(), 3u);
}

TEST(Nodes, CirclesAndSecondParentsAreRefused) {
    TestGltf circle = one_triangle();
    circle.json["nodes"][0]["children"] = {circle.add("nodes", {{"children", {0}}})};
    const Failure failure = failure_of_loading(circle);
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "ancestor")) << failure.message;
    TestGltf own_child = one_triangle();
    own_child.json["nodes"][0]["children"] = {0};
    EXPECT_EQ(failure_of_loading(own_child).code, ExitCode::BadData);
    TestGltf twice = one_triangle();
    twice.add_node({{"children", {0}}});
    EXPECT_EQ(failure_of_loading(twice).code, ExitCode::BadData);
}

TEST(Nodes, BadNumbersAreRefused) {
    const json bad[] = {{{"rotation", {0, 0, 0, 0}}}, {{"rotation", {0, 0, 1}}}, {{"matrix", {1, 2, 3}}},
                        {{"children", {77}}},         {{"children", {-1}}},      {{"mesh", 77}},
                        {{"translation", {1, 2}}}};
    for (const json& node : bad) {
        TestGltf gltf = one_triangle();
        gltf.json["nodes"][0].update(node);
        EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData) << node;
    }
    TestGltf scene = one_triangle();
    scene.json["scene"] = 3;
    EXPECT_EQ(failure_of_loading(scene).code, ExitCode::BadData);
    scene.json["scene"] = 0;
    scene.json["scenes"][0]["nodes"] = {12};
    EXPECT_EQ(failure_of_loading(scene).code, ExitCode::BadData);
}

TEST(Nodes, AChainOfManyNodesDoesNotExhaustTheStack) {
    TestGltf gltf = one_triangle();
    constexpr int kMany = 50000;
    json nodes = {{{"mesh", 0}}};
    for (int i = 1; i < kMany; ++i)
        nodes.push_back({{"children", {i - 1}}});
    gltf.json["nodes"] = nodes;
    gltf.json["scenes"][0]["nodes"] = {kMany - 1};
    EXPECT_EQ(load(gltf).scene.triangle_count(), 1u);
}

TEST(Animations, LinearIsClampedAtItsEnds) {
    TestGltf gltf = one_triangle();
    gltf.animate("translation", "LINEAR", {1, 3}, {0, 0, 0, 4, 0, 8});
    expect_near(corner_at(gltf, 0.0), {1, 0, 0});
    expect_near(corner_at(gltf, 1.0), {1, 0, 0});
    expect_near(corner_at(gltf, 1.5), {2, 0, 2});
    expect_near(corner_at(gltf, 3.0), {5, 0, 8});
    expect_near(corner_at(gltf, 1e9), {5, 0, 8});
}

TEST(Animations, StepHolds) {
    TestGltf gltf = one_triangle();
    gltf.animate("scale", "STEP", {1, 3}, {1, 1, 1, 4, 1, 1});
    expect_near(corner_at(gltf, 2.999), {1, 0, 0});
    expect_near(corner_at(gltf, 3.0), {4, 0, 0});
}

TEST(Animations, RotationsTakeTheShorterArc) {
    TestGltf gltf = one_triangle();
    const float h = std::sqrt(0.5f);
    gltf.animate("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, -h, -h});  // a quarter turn, by its negative
    const double angle = 0.25 * 1.5707963267948966;
    expect_near(corner_at(gltf, 0.25), {std::cos(angle), std::sin(angle), 0});
    expect_near(corner_at(gltf, 1.0), {0, 1, 0});
}

TEST(Animations, CubicSplines) {
    TestGltf gltf = one_triangle();
    // x(t) = t^3 on [0, 2]: tangents 0 and 12.
    gltf.animate("translation", "CUBICSPLINE", {0, 2}, {9, 9, 9, 0, 0, 0, 0, 0, 0, 12, 0, 0, 8, 0, 0, 9, 9, 9});
    for (const double t : {0.0, 0.5, 1.3, 2.0})
        expect_near(corner_at(gltf, t), {1 + t * t * t, 0, 0});
    expect_near(corner_at(gltf, -1.0), {1, 0, 0});
    expect_near(corner_at(gltf, 5.0), {9, 0, 0});
}

TEST(Animations, CubicRotationsAreNormalised) {
    TestGltf gltf = one_triangle();
    const float h = std::sqrt(0.5f);
    gltf.animate("rotation", "CUBICSPLINE", {0, 1},
                 {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, h, h, 0, 0, 0, 0});
    expect_near(corner_at(gltf, 0.5), {h, h, 0});
}

TEST(Animations, AllOfAFilePlayTogether) {
    TestGltf gltf = one_triangle();
    gltf.animate("translation", "LINEAR", {0, 1}, {0, 0, 0, 0, 0, 2});
    gltf.animate("scale", "LINEAR", {0, 1}, {1, 1, 1, 3, 1, 1});
    expect_near(corner_at(gltf, 1.0), {3, 0, 2});
}

TEST(Animations, OfANodeWithAMatrixAreLeftOutWithAWarning) {
    TestGltf gltf = one_triangle();
    gltf.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    gltf.animate("translation", "LINEAR", {0, 1}, {0, 0, 0, 0, 0, 2});
    const Loaded loaded = load(gltf, 1.0);
    EXPECT_TRUE(loaded.messages.warned("animated-matrix"));
    expect_near(loaded.scene.meshes.at(0).positions.at(1), {1, 0, 0});
}

TEST(Animations, BadOnesAreRefused) {
    const auto failure = [](const std::vector<float>& times, const std::vector<float>& values,
                            const std::string& interpolation = "LINEAR", int node = 0) {
        TestGltf gltf = one_triangle();
        gltf.animate("translation", interpolation, times, values, node);
        return failure_of_loading(gltf).code;
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(failure({0, 1}, {0, 0, 0}), ExitCode::BadData) << "too few values";
    EXPECT_EQ(failure({0, 1}, {0, 0, 0, 1, 1, 1}, "CUBICSPLINE"), ExitCode::BadData) << "no tangents";
    EXPECT_EQ(failure({1, 1}, {0, 0, 0, 1, 1, 1}), ExitCode::BadData) << "times that do not increase";
    EXPECT_EQ(failure({0, nan}, {0, 0, 0, 1, 1, 1}), ExitCode::BadData);
    EXPECT_EQ(failure({0, 1}, {0, 0, 0, 1, 1, nan}), ExitCode::BadData);
    EXPECT_EQ(failure({0}, {0, 0, 0}, "BOUNCE"), ExitCode::BadData);
    EXPECT_EQ(failure({0}, {0, 0, 0}, "LINEAR", 9), ExitCode::BadData) << "no such node";
    TestGltf no_data = one_triangle();
    no_data.animate("translation", "LINEAR", {0}, {0, 0, 0});
    no_data.json["accessors"][2].erase("bufferView");
    no_data.json["accessors"][2]["sparse"] = {
        {"count", 0}, {"indices", {{"bufferView", 0}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}};
    EXPECT_EQ(failure_of_loading(no_data).code, ExitCode::BadData);
    TestGltf no_sampler = one_triangle();
    no_sampler.animate("translation", "LINEAR", {0}, {0, 0, 0});
    no_sampler.json["animations"][0]["channels"][0]["sampler"] = 4;
    EXPECT_EQ(failure_of_loading(no_sampler).code, ExitCode::BadData);
}

}  // namespace
}  // namespace brisance::testing
