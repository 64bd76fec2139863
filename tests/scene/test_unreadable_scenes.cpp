// Files that cannot be used are rejected with one line, whatever their headers claim.
#include <gtest/gtest.h>

#include <cstring>

#include "core/rng.h"
#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

using nlohmann::json;

ExitCode code_of_bytes(const std::string& bytes, const std::string& name = "scene.glb") {
    const TempFolder folder;
    write_bytes(folder / name, bytes);
    return failure_of_loading(folder / name).code;
}

// A .gltf whose positions claim to be as many as `count`, and whose buffer has 36 bytes.
TestGltf claiming(std::uint64_t count) {
    TestGltf gltf = one_triangle();
    gltf.json["accessors"][0]["count"] = count;
    return gltf;
}

TEST(UnreadableScenes, NoSuchFile) {
    const TempFolder folder;
    const Failure failure = failure_of_loading(folder / "none.glb");
    EXPECT_EQ(failure.code, ExitCode::MissingInput);
    EXPECT_TRUE(contains(failure.message, "none.glb")) << failure.message;
    EXPECT_EQ(failure_of([&] { load_cameras({"none.glb"}, folder.path(), 0.0); }).code, ExitCode::MissingInput);
}

TEST(UnreadableScenes, AFolderIsNoFile) {
    const TempFolder folder;
    std::filesystem::create_directory(folder / "scene.glb");
    EXPECT_EQ(failure_of_loading(folder / "scene.glb").code, ExitCode::BadData);
}

TEST(UnreadableScenes, TruncatedAnywhere) {
    const std::string whole = one_triangle().glb();
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_EQ(code_of_bytes(whole.substr(0, length)), ExitCode::BadData) << length;
    const TempFolder folder;
    write_bytes(folder / "scene.glb", whole.substr(0, whole.size() / 2));
    EXPECT_TRUE(contains(failure_of_loading(folder / "scene.glb").message, "truncated"));
}

TEST(UnreadableScenes, ChunksLongerThanTheFile) {
    const std::string whole = one_triangle().glb();
    std::uint32_t json_length = 0;
    std::memcpy(&json_length, whole.data() + 12, 4);
    for (const std::size_t at : {std::size_t{8}, std::size_t{12}, std::size_t{20 + json_length}})
        for (const std::uint32_t length : {0u, 1u, 40u, 44u, 0x7ffffffcu, 0xfffffffcu, 0xffffffffu}) {
            std::string bytes = whole;
            std::memcpy(bytes.data() + at, &length, 4);
            const ExitCode code = code_of_bytes(bytes);
            EXPECT_TRUE(code == ExitCode::BadData || bytes == whole) << at << " " << length;
        }
}

TEST(UnreadableScenes, NoJson) {
    for (const std::string text :
         {"", "x", "hello, I am a text", "{\"asset\":", "[1, 2]", "null", "{}", "{\"asset\": 3}",
          "\xff\xfe{\"asset\": {\"version\": \"2.0\"}}", "{\"asset\": {\"version\": \"2.0\xff\"}}"})
        EXPECT_EQ(code_of_bytes(text, "scene.gltf"), ExitCode::BadData) << text;
}

TEST(UnreadableScenes, JsonNestedWithoutEnd) {
    const std::string deep = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": ";
    EXPECT_EQ(code_of_bytes(deep + std::string(1000000, '[') + std::string(1000000, ']') + "}", "scene.gltf"),
              ExitCode::BadData);
    EXPECT_EQ(code_of_bytes(deep + "\"" + std::string(1000, '[') + "\\\"\"}", "scene.gltf"), ExitCode::Success)
        << "brackets in text do not count";
}

TEST(UnreadableScenes, OtherVersions) {
    for (const std::string version : {"1.0", "3.0", ""}) {
        TestGltf gltf = one_triangle();
        gltf.json["asset"]["version"] = version;
        EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData) << version;
    }
    std::string bytes = one_triangle().glb();
    bytes[4] = 1;
    EXPECT_EQ(code_of_bytes(bytes), ExitCode::BadData);
}

TEST(UnreadableScenes, ListsOfOtherThings) {
    for (const char* list : {"buffers", "bufferViews", "accessors", "meshes", "nodes", "scenes", "materials", "images",
                             "textures", "animations", "skins", "samplers", "cameras"}) {
        TestGltf gltf = one_triangle();
        gltf.json[list] = {1, "two", nullptr};
        const TempFolder folder;
        gltf.write_gltf(folder / "scene.gltf");
        EXPECT_EQ(failure_of_loading(folder / "scene.gltf").code, ExitCode::BadData) << list;
    }
}

TEST(UnreadableScenes, ARequiredExtensionThatIsNotKnownIsNamed) {
    TestGltf gltf = one_triangle();
    gltf.json["extensionsRequired"] = {"KHR_texture_transform", "KHR_draco_mesh_compression"};
    gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"];
    const Failure failure = failure_of_loading(gltf);
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "KHR_draco_mesh_compression")) << failure.message;
}

TEST(UnreadableScenes, CompressedMeshesNameTheirCompression) {
    TestGltf gltf;
    gltf.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2});
    for (json& accessor : gltf.json["accessors"])
        accessor.erase("bufferView");  // the data are in the extension
    gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const Failure failure = failure_of_loading(gltf);
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "KHR_draco_mesh_compression")) << failure.message;
}

TEST(UnreadableScenes, OptionalExtensionsThatAreNotKnownCostOneNotice) {
    TestGltf gltf = one_triangle();
    gltf.json["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_sheen", "EXT_other"};
    const Loaded loaded = load(gltf);
    ASSERT_EQ(loaded.messages.notices.size(), 1u);
    EXPECT_TRUE(contains(loaded.messages.notices[0], "EXT_other, KHR_materials_sheen"));
}

TEST(UnreadableScenes, AMissingBufferIsNamed) {
    const TempFolder folder;
    one_triangle().write_gltf(folder / "scene.gltf", "gone.bin");
    const Failure failure = failure_of_loading(folder / "scene.gltf");
    EXPECT_EQ(failure.code, ExitCode::MissingInput);
    EXPECT_TRUE(contains(failure.message, "gone.bin")) << failure.message;
    EXPECT_TRUE(contains(failure.message, "scene.gltf")) << failure.message;
}

TEST(UnreadableScenes, ABufferShorterThanItsLength) {
    const TempFolder folder;
    one_triangle().write_gltf(folder / "scene.gltf");
    write_bytes(folder / "buffer.bin", "short");
    const Failure failure = failure_of_loading(folder / "scene.gltf");
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "buffer.bin")) << failure.message;
    TestGltf embedded = one_triangle();
    const std::string data = "data:application/octet-stream;base64," + base64(embedded.buffer);
    embedded.json["buffers"] = {{{"byteLength", 1u << 31}, {"uri", data}}};
    embedded.write_gltf(folder / "scene.gltf");
    EXPECT_EQ(failure_of_loading(folder / "scene.gltf").code, ExitCode::BadData);
}

TEST(UnreadableScenes, AccessorsBeyondTheirBuffers) {
    const std::uint64_t huge = std::uint64_t{1} << 63;
    const std::pair<const char*, json> wrong[] = {
        {"count", 4},           {"count", huge},         {"count", ~std::uint64_t{0}},
        {"byteOffset", 1},      {"byteOffset", huge},    {"byteOffset", ~std::uint64_t{0} - 10},
        {"bufferView", 7},      {"componentType", 5130}, {"componentType", 5124},
        {"componentType", 999}, {"type", "MAT4"},        {"type", "VEC5"},
        {"type", "VEC2"},       {"count", -3},           {"count", 2.5}};
    for (const auto& [key, value] : wrong) {
        TestGltf gltf = one_triangle();
        gltf.json["accessors"][0][key] = value;
        EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData) << key << " " << value;
    }
    const std::pair<const char*, json> wrong_view[] = {
        {"byteLength", 37}, {"byteLength", 35},   {"byteLength", ~std::uint64_t{0}},
        {"byteOffset", 4},  {"byteOffset", huge}, {"byteStride", 4},
        {"byteStride", 16}, {"byteStride", 1024}, {"buffer", 3},
        {"buffer", -1}};
    for (const auto& [key, value] : wrong_view) {
        TestGltf gltf = one_triangle();
        gltf.json["bufferViews"][0][key] = value;
        EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData) << key << " " << value;
    }
}

TEST(UnreadableScenes, IndicesBeyondTheVertices) {
    TestGltf gltf;
    gltf.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 3});
    const Failure failure = failure_of_loading(gltf);
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "index of 3, and 3 vertices")) << failure.message;
    TestGltf floats = one_triangle();
    floats.json["meshes"][0]["primitives"][0]["indices"] = floats.add_floats("SCALAR", {0, 1, 2});
    EXPECT_EQ(failure_of_loading(floats).code, ExitCode::BadData);
}

TEST(UnreadableScenes, ReferencesBeyondTheLists) {
    const std::pair<const char*, json> wrong[] = {{"material", 5},
                                                  {"indices", 9},
                                                  {"mode", 7},
                                                  {"mode", -1},
                                                  {"attributes", {{"POSITION", 9}}},
                                                  {"attributes", {{"POSITION", 0}, {"NORMAL", 4}}}};
    for (const auto& [key, value] : wrong) {
        TestGltf gltf = one_triangle();
        gltf.json["meshes"][0]["primitives"][0][key] = value;
        EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData) << key << " " << value;
    }
    TestGltf few_normals = one_triangle();
    few_normals.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        few_normals.add_floats("VEC3", {0, 0, 1, 0, 0, 1});
    EXPECT_EQ(failure_of_loading(few_normals).code, ExitCode::BadData);
}

TEST(UnreadableScenes, ClaimsOfManyTrianglesAreJudgedBeforeAnythingIsAllocated) {
    const TempFolder folder;
    TestGltf indexed = one_triangle();
    indexed.json["meshes"][0]["primitives"][0]["indices"] = indexed.add(
        "accessors", {{"bufferView", 0}, {"componentType", 5125}, {"count", 150000000}, {"type", "SCALAR"}});
    indexed.write_gltf(folder / "scene.gltf");
    EXPECT_EQ(failure_of_loading(folder / "scene.gltf").code, ExitCode::BadData) << "the buffer is too short";
    std::filesystem::remove(folder / "buffer.bin");
    EXPECT_EQ(failure_of_loading(folder / "scene.gltf").code, ExitCode::MissingInput);
    EXPECT_EQ(failure_of_loading(claiming(150000000)).code, ExitCode::BadData);
}

TEST(UnreadableScenes, TooManyTrianglesForTheMemoryAreToldWithTheirNumber) {
    const TempFolder folder;
    TestGltf gltf = claiming(150000000);  // without data, but for one element: 50 million triangles all the same
    gltf.json["accessors"][0].erase("bufferView");
    const int value = gltf.add_view(std::string(12, '\0'));
    gltf.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", value}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", value}}}};
    gltf.write_glb(folder / "scene.glb");
    const Failure failure = failure_of([&] { load_file(folder / "scene.glb", 0.0, std::uint64_t{8} << 30); });
    EXPECT_EQ(failure.code, ExitCode::Temporary);
    EXPECT_TRUE(contains(failure.message, "50000000 triangles")) << failure.message;
    EXPECT_TRUE(contains(failure.message, "8.00 GiB")) << failure.message;
    gltf.json["accessors"][0]["count"] = ~std::uint64_t{0};
    gltf.write_glb(folder / "scene.glb");
    EXPECT_EQ(failure_of_loading(folder / "scene.glb").code, ExitCode::Temporary);
}

TEST(UnreadableScenes, MoreThanAnyMemoryHoldsIsToldWithoutALimitToo) {
    const TempFolder folder;
    TestGltf gltf = claiming(std::uint64_t{1} << 62);
    gltf.json["accessors"][0].erase("bufferView");
    gltf.json["accessors"][0]["sparse"] = {
        {"count", 0}, {"indices", {{"bufferView", 0}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}};
    gltf.write_glb(folder / "scene.glb");
    const Failure failure =
        failure_of([&] { load_file(folder / "scene.glb", 0.0, std::numeric_limits<std::uint64_t>::max()); });
    EXPECT_EQ(failure.code, ExitCode::Temporary) << failure.message;
}

TEST(UnreadableScenes, AFileWithNothingInItCostsAWarning) {
    EXPECT_TRUE(load(TestGltf()).messages.warned("empty-file"));
    TestGltf circle = one_triangle();
    circle.json["nodes"][0]["children"] = {0};
    circle.json.erase("scenes");
    circle.json.erase("scene");
    EXPECT_TRUE(load(circle).messages.warned("empty-file")) << "nodes without a root";
}

TEST(UnreadableScenes, ABufferLargerThanTheMemoryIsNotRead) {
    const TempFolder folder;
    TestGltf gltf = one_triangle();
    gltf.json["buffers"] = {{{"byteLength", std::uint64_t{1} << 40}, {"uri", "buffer.bin"}}};
    gltf.write_gltf(folder / "scene.gltf");
    std::filesystem::resize_file(folder / "buffer.bin", std::uint64_t{1} << 40);  // sparse: takes no space
    const Failure failure = failure_of_loading(folder / "scene.gltf");
    EXPECT_EQ(failure.code, ExitCode::Temporary);
    EXPECT_TRUE(contains(failure.message, "buffer.bin")) << failure.message;
}

TEST(UnreadableScenes, PartsThatAreNotGltfAreLeftOutWithAWarning) {
    TestGltf gltf = one_triangle();
    gltf.json["meshes"][0]["primitives"].push_back(json::object());  // no attributes
    const Loaded loaded = load(gltf);
    EXPECT_EQ(loaded.scene.triangle_count(), 1u);
    EXPECT_TRUE(loaded.messages.warned("gltf-part"));
}

// A morph target and a skin of one joint for a mesh of four vertices on node 0.
void add_shape(TestGltf& gltf, json& primitive) {
    primitive["targets"] = {{{"POSITION", gltf.add_floats("VEC3", {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0})}}};
    const int joints = gltf.add_view(std::string(16, '\0'));
    primitive["attributes"]["JOINTS_0"] =
        gltf.add("accessors", {{"bufferView", joints}, {"componentType", 5121}, {"count", 4}, {"type", "VEC4"}});
    primitive["attributes"]["WEIGHTS_0"] = gltf.add_floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    const int matrix = gltf.add_floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    gltf.json["nodes"][0]["skin"] = gltf.add("skins", {{"joints", {0}}, {"inverseBindMatrices", matrix}});
    gltf.json["nodes"][0]["weights"] = {0.5};
    gltf.animate("weights", "LINEAR", {0, 1}, {0, 1});
}

// Something of everything.
TestGltf rich() {
    TestGltf gltf;
    auto& primitive = gltf.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, {0, 1, 2, 1, 3, 2});
    primitive["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    primitive["attributes"]["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 0, 1, 0, 0, 1, 1, 1});
    const int view = gltf.add_view(encoded(".jpg", 8, 8, 3, std::vector<std::uint8_t>(8 * 8 * 3, 77)));
    gltf.add("images", {{"bufferView", view}});
    gltf.add("textures", {{"source", 0}});
    primitive["material"] = gltf.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    const int times = gltf.add_floats("SCALAR", {0, 1});
    const int positions = gltf.add_floats("VEC3", {0, 0, 0, 1, 1, 1});
    gltf.add("animations", {{"samplers", {{{"input", times}, {"output", positions}}}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
    add_shape(gltf, primitive);
    gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}, {"aspectRatio", 1}}}});
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", {{"innerConeAngle", 0}}}}};
    gltf.add_node({{"camera", 0},
                   {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    gltf.json["nodes"][0]["children"] = {gltf.add("nodes", {{"mesh", 0}, {"rotation", {0, 0, 0, 1}}})};
    const int indices = gltf.add_view(std::string("\3\0", 2));
    const int values = gltf.add_view(std::string(12, '\0'));
    gltf.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", indices}, {"byteOffset", 0}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}, {"byteOffset", 0}}}};
    gltf.json["bufferViews"][0]["byteStride"] = 12;
    gltf.json["accessors"][0]["byteOffset"] = 0;
    return gltf;
}

// Either it loads or it says why it does not.
void expect_no_accident(const std::filesystem::path& folder, const std::string& bytes, const std::string& what) {
    write_bytes(folder / "damaged.glb", bytes);
    SceneSettings settings;
    settings.files.push_back({"damaged.glb"});
    const Failure failure = failure_of([&] { load_settings(settings, folder, 0.5, 1 << 26); });
    EXPECT_TRUE(failure.code == ExitCode::Success || failure.code == ExitCode::BadData ||
                failure.code == ExitCode::Temporary || failure.code == ExitCode::MissingInput)
        << what;
}

TEST(UnreadableScenes, DamagedBytes) {
    const std::string whole = rich().glb();
    ASSERT_EQ(code_of_bytes(whole), ExitCode::Success);
    const TempFolder folder;
    Rng rng(Stream::Path, 7);
    const auto below = [&](std::size_t n) {
        return static_cast<std::size_t>(rng.next_double() * static_cast<double>(n));
    };
    for (int i = 0; i < 500; ++i) {
        std::string damaged = whole;
        for (std::size_t k = 1 + below(3); k > 0; --k)
            damaged[below(damaged.size())] =
                below(2) == 0 ? "0123456789-.eE[]{},:\"9"[below(22)] : static_cast<char>(below(256));
        expect_no_accident(folder.path(), damaged, std::to_string(i));
    }
}

// Every value of the JSON that is no list, replaced by what it should not be.
TEST(UnreadableScenes, DamagedValues) {
    TestGltf gltf = rich();
    gltf.json["buffers"] = {{{"byteLength", gltf.buffer.size()}}};
    const json flat = gltf.json.flatten();
    const json wrong[] = {-1, 0, 3, 255, 0.5, 1e300, 2147483647, 4294967295u, ~std::uint64_t{0}, "x", nullptr, {}};
    const TempFolder folder;
    for (const auto& [path, value] : flat.items())
        for (const json& replacement : wrong) {
            json damaged = gltf.json;
            damaged[json::json_pointer(path)] = replacement;
            expect_no_accident(folder.path(), glb_of(damaged.dump(), gltf.buffer), path + " " + replacement.dump());
        }
}

}  // namespace
}  // namespace brisance::testing
