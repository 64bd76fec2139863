// From accessors and nodes to triangles in local space.
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

// What `mesh` says is left: its corners in the order of its triangles.
std::vector<dvec3> corners_of(const SceneMesh& mesh) {
    std::vector<dvec3> corners;
    for (const glm::uvec3& t : mesh.triangles)
        for (int c = 0; c < 3; ++c)
            corners.emplace_back(mesh.positions[t[c]]);
    return corners;
}

Loaded load_placed(const TestGltf& gltf, SceneFile file, const dvec3& origin = dvec3(0.0)) {
    const TempFolder folder;
    gltf.write_glb(folder / "scene.glb");
    file.file = "scene.glb";
    SceneSettings settings;
    settings.files.push_back(file);
    return load_settings(settings, folder.path(), 0.0, kPlenty, origin);
}

TEST(Meshes, OneTriangle) {
    const Loaded loaded = load(one_triangle());
    ASSERT_EQ(loaded.scene.meshes.size(), 1u);
    const SceneMesh& mesh = loaded.scene.meshes[0];
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_TRUE(mesh.normals.empty()) << "flat where the file has no normals";
    EXPECT_TRUE(mesh.uv.empty());
    expect_near(cross_of(mesh, 0), {0, 0, 1});
    ASSERT_EQ(loaded.scene.materials.size(), 1u);
    EXPECT_EQ(loaded.scene.materials[0].surface.metallic, 1.0f) << "glTF's default material";
    EXPECT_EQ(loaded.scene.triangle_count(), 1u);
    EXPECT_GE(loaded.scene.bytes(), 3 * sizeof(vec3) + sizeof(glm::uvec3));
    EXPECT_TRUE(loaded.messages.warnings.empty());
}

TEST(Meshes, YUpAndZUp) {
    TestGltf gltf;
    gltf.add_mesh({1, 2, 3, 2, 2, 3, 1, 3, 3});
    expect_near(corners_of(load_placed(gltf, {"", 'y'}).scene.meshes[0])[0], {1, 2, 3});
    const Loaded turned = load_placed(gltf, {"", 'z'});
    expect_near(corners_of(turned.scene.meshes[0])[0], {1, -3, 2});
    expect_near(corners_of(turned.scene.meshes[0])[2], {1, -3, 3});
    EXPECT_EQ(failure_of([&] { load_placed(gltf, {"", 'x'}); }).code, ExitCode::Usage);
}

TEST(Meshes, WorldFromFileComesAfterUp) {
    TestGltf gltf;
    gltf.add_mesh({1, 2, 3, 2, 2, 3, 1, 3, 3});
    dmat4 moved(2.0);
    moved[3] = {10, 20, 30, 1};
    expect_near(corners_of(load_placed(gltf, {"", 'z', moved}).scene.meshes[0])[0], {12, 14, 34});
}

TEST(Meshes, FarFromTheOriginNoDigitsAreLost) {
    TestGltf gltf = one_triangle();
    gltf.json["nodes"][0]["translation"] = {1e7 + 0.125, -3e6, 0.0};
    const dvec3 origin(1e7, -3e6, 0.0);
    const Loaded loaded = load_placed(gltf, {""}, origin);
    EXPECT_EQ(loaded.scene.origin, origin);
    expect_near(corners_of(loaded.scene.meshes[0])[1], {1.125, 0, 0}, 1e-7);
}

TEST(Meshes, StripsAndFans) {
    TestGltf strip;
    strip.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0})["mode"] = 5;
    const Loaded striped = load(strip);
    ASSERT_EQ(striped.scene.triangle_count(), 3u);
    for (std::size_t t = 0; t < 3; ++t)
        expect_near(cross_of(striped.scene.meshes[0], t), {0, 0, 1});
    TestGltf fan;
    fan.add_mesh({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 1, 2, 3})["mode"] = 6;
    const Loaded fanned = load(fan);
    ASSERT_EQ(fanned.scene.triangle_count(), 2u);
    for (std::size_t t = 0; t < 2; ++t)
        expect_near(cross_of(fanned.scene.meshes[0], t), {0, 0, 1});
}

TEST(Meshes, PointsAndLinesAreSkippedWithANotice) {
    for (const int mode : {0, 1, 2, 3}) {
        TestGltf gltf = one_triangle();
        gltf.add_mesh(kTriangle)["mode"] = mode;
        const Loaded loaded = load(gltf);
        EXPECT_EQ(loaded.scene.triangle_count(), 1u);
        EXPECT_TRUE(loaded.messages.noticed("points and lines"));
    }
}

TEST(Meshes, IndicesOfAllSizes) {
    for (const int type : {5121, 5123, 5125}) {
        TestGltf gltf;
        gltf.add_mesh({9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 2, 3});
        auto& accessor = gltf.json["accessors"][1];
        accessor["componentType"] = type;
        const std::size_t bytes = type == 5121 ? 1 : type == 5123 ? 2 : 4;
        std::string indices;
        for (const char i : {1, 2, 3})
            indices += std::string(1, i) + std::string(bytes - 1, '\0');
        accessor["bufferView"] = gltf.add_view(indices);
        const Loaded loaded = load(gltf);
        ASSERT_EQ(loaded.scene.triangle_count(), 1u) << type;
        expect_near(cross_of(loaded.scene.meshes[0], 0), {0, 0, 1});
    }
}

TEST(Meshes, InterleavedAttributes) {
    TestGltf gltf;
    auto& primitive = gltf.add_mesh(kTriangle);
    primitive["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 0, 0, 0, 5, 1, 0, 0, 0, 0, 5, 0, 1, 0, 0, 0, 5});
    gltf.json["bufferViews"][1]["byteStride"] = 24;
    gltf.json["accessors"][1]["count"] = 3;
    gltf.json["accessors"][0]["bufferView"] = 1;
    gltf.json["accessors"][1]["byteOffset"] = 12;
    const Loaded loaded = load(gltf);
    const SceneMesh& mesh = loaded.scene.meshes[0];
    expect_near(cross_of(mesh, 0), {0, 0, 1});
    ASSERT_EQ(mesh.normals.size(), 3u);
    for (const vec3& n : mesh.normals)
        expect_near(n, {0, 0, 1});
}

TEST(Meshes, SparseAccessorsReplaceElements) {
    TestGltf gltf;
    gltf.add_mesh({0, 0, 0, 1, 0, 0, 7, 7, 7});
    const int indices = gltf.add_view(std::string("\2\0", 2));
    const int values = gltf.json["accessors"][gltf.add_floats("VEC3", {0, 3, 0})]["bufferView"];
    gltf.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", values}}}};
    expect_near(cross_of(load(gltf).scene.meshes[0], 0), {0, 0, 3});
    gltf.json["accessors"][0].erase("bufferView");  // zeros, but for the third corner
    EXPECT_EQ(load(gltf).scene.triangle_count(), 0u);
    gltf.json["accessors"][0]["count"] = 2;
    EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData) << "sparse index beyond the elements";
}

TEST(Meshes, QuantisedPositions) {
    TestGltf gltf = one_triangle();
    gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const std::vector<std::int8_t> bytes = {0, 0, 0, 0, 127, 0, 0, 0, 0, -127, 0, 0};
    auto& accessor = gltf.json["accessors"][0];
    accessor["bufferView"] = gltf.add_view({bytes.begin(), bytes.end()});
    gltf.json["bufferViews"][1]["byteStride"] = 4;
    accessor["componentType"] = 5120;
    expect_near(cross_of(load(gltf).scene.meshes[0], 0), {0, 0, -127.0 * 127.0});
    accessor["normalized"] = true;
    expect_near(cross_of(load(gltf).scene.meshes[0], 0), {0, 0, -1});
}

TEST(Meshes, ANegativeScaleKeepsTheFrontInFront) {
    TestGltf gltf = one_triangle();
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    gltf.json["nodes"][0]["scale"] = {-2, 1, 1};
    const Loaded mirrored = load(gltf);
    expect_near(cross_of(mirrored.scene.meshes[0], 0), {0, 0, 2});
    expect_near(mirrored.scene.meshes[0].normals[0], {0, 0, 1});
    gltf.json["nodes"][0]["scale"] = {1, 1, -1};
    const Loaded turned = load(gltf);
    expect_near(cross_of(turned.scene.meshes[0], 0), {0, 0, -1});
    expect_near(turned.scene.meshes[0].normals[0], {0, 0, -1});
}

TEST(Meshes, NormalsStayPerpendicularUnderUnevenScale) {
    TestGltf gltf;
    const float h = std::sqrt(0.5f);
    gltf.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 1})["attributes"]["NORMAL"] =
        gltf.add_floats("VEC3", {0, -h, h, 0, -h, h, 0, -h, h});
    gltf.json["nodes"][0]["scale"] = {3, 0.25, -4};
    gltf.json["nodes"][0]["rotation"] = {0.5, 0.5, 0.5, 0.5};
    const SceneMesh mesh = load(gltf).scene.meshes[0];
    expect_near(mesh.normals[1], glm::normalize(cross_of(mesh, 0)));
}

TEST(Meshes, NormalsWithoutDirectionAreReplaced) {
    TestGltf gltf = one_triangle();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        gltf.add_floats("VEC3", {0, 0, 0, nan, 0, 1, 0, 0, 1});
    const Loaded loaded = load(gltf);
    EXPECT_TRUE(loaded.messages.warned("normals"));
    for (const vec3& n : loaded.scene.meshes[0].normals)
        expect_near(n, {0, 0, 1});
}

TEST(Meshes, TrianglesWithoutAreaAreCountedAndLeftOut) {
    TestGltf gltf;
    gltf.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0}, {0, 1, 2, 0, 1, 3, 2, 2, 1});
    const Loaded loaded = load(gltf);
    EXPECT_EQ(loaded.scene.triangle_count(), 1u);
    ASSERT_TRUE(loaded.messages.warned("no-area"));
    EXPECT_TRUE(contains(loaded.messages.warnings[0].second, "2 triangles"));
}

TEST(Meshes, PositionsThatAreNotFiniteAreCountedAndLeftOut) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    TestGltf gltf;
    gltf.add_mesh({nan, 0, 0, 0, 0, 0, 1, 0, 0, 0, inf, 0, 0, 1, 0},
                  {0, 1, 2, 1, 2, 4, 1, 2, 3})["attributes"]["NORMAL"] =
        gltf.add_floats("VEC3", {1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 1});
    const Loaded loaded = load(gltf);
    ASSERT_TRUE(loaded.messages.warned("not-finite"));
    EXPECT_TRUE(contains(loaded.messages.warnings[0].second, "2 triangles"));
    const SceneMesh& mesh = loaded.scene.meshes[0];
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions.size(), 3u) << "nothing that is not finite is left behind";
    expect_near(cross_of(mesh, 0), {0, 0, 1});
    ASSERT_EQ(mesh.normals.size(), 3u);
    for (const vec3& n : mesh.normals)
        expect_near(n, {0, 0, 1});
}

TEST(Meshes, AMeshOfWhichNothingIsLeftIsLeftOut) {
    TestGltf gltf = one_triangle();
    gltf.add_mesh({0, 0, 0, 1, 0, 0, 2, 0, 0})["material"] =
        gltf.add("materials", {{"emissiveFactor", {1, 1, 1}}, {"name", "Lamp"}});
    const Loaded loaded = load(gltf);
    EXPECT_EQ(loaded.scene.meshes.size(), 1u);
    EXPECT_TRUE(loaded.messages.warned("empty-mesh")) << "also where it would have emitted";
    TestGltf none = one_triangle();
    none.json["accessors"][0]["count"] = 0;
    EXPECT_TRUE(load(none).messages.warned("empty-mesh"));
    TestGltf collapsed = one_triangle();
    collapsed.json["nodes"][0]["scale"] = {0, 0, 0};
    EXPECT_TRUE(load(collapsed).messages.warned("empty-mesh"));
    TestGltf no_primitives;
    no_primitives.add_node({{"mesh", no_primitives.add("meshes", {{"primitives", nlohmann::json::array()}})}});
    EXPECT_EQ(load(no_primitives).scene.triangle_count(), 0u);
    TestGltf no_positions = one_triangle();
    no_positions.json["meshes"][0]["primitives"][0]["attributes"] = {{"NORMAL", 0}};
    EXPECT_TRUE(load(no_positions).messages.warned("no-positions"));
}

TEST(Meshes, CornersBeyondTheLastTriangleAreLeftOut) {
    TestGltf gltf;
    gltf.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    const Loaded loaded = load(gltf);
    EXPECT_EQ(loaded.scene.triangle_count(), 1u);
    EXPECT_TRUE(loaded.messages.warned("odd-corners"));
}

TEST(Meshes, ColoursOfVerticesAreLeftOutWithANotice) {
    TestGltf gltf = one_triangle();
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 0;
    const Loaded loaded = load(gltf);
    EXPECT_TRUE(loaded.messages.noticed("colours of vertices"));
    expect_near(cross_of(loaded.scene.meshes[0], 0), {0, 0, 1});
}

TEST(Meshes, OneMeshOnSeveralNodes) {
    TestGltf gltf = one_triangle();
    gltf.add_node({{"mesh", 0}, {"translation", {0, 0, 5}}, {"name", "Second"}});
    const Loaded loaded = load(gltf);
    ASSERT_EQ(loaded.scene.meshes.size(), 2u);
    EXPECT_EQ(loaded.scene.meshes[1].name, "Second");
    EXPECT_EQ(loaded.scene.materials.size(), 1u) << "shared";
    expect_near(corners_of(loaded.scene.meshes[1])[0], {0, 0, 5});
}

TEST(Meshes, SeveralFiles) {
    const TempFolder folder;
    one_triangle().write_glb(folder / "a.glb");
    TestGltf other = one_triangle();
    other.json["meshes"][0]["primitives"][0]["material"] = other.add("materials", {{"name", "Other"}});
    other.write_glb(folder / "b.glb");
    SceneSettings settings;
    settings.files = {{"a.glb"}, {(folder / "b.glb").string()}};
    const Loaded loaded = load_settings(settings, folder.path());
    ASSERT_EQ(loaded.scene.meshes.size(), 2u);
    EXPECT_EQ(loaded.scene.materials.at(static_cast<std::size_t>(loaded.scene.meshes[1].material)).name, "Other");
}

}  // namespace
}  // namespace brisance::testing
