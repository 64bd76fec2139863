#include "gltf_fixture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace brisance::testing {
namespace {

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string u32(std::size_t value) {
    return bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(value)});
}

std::string padded(std::string text, char with) {
    while (text.size() % 4 != 0)
        text += with;
    return text;
}

int components_of(const std::string& type) {
    const int n = type.back() - '0';
    return type == "SCALAR" ? 1 : type.starts_with("MAT") ? n * n : n;
}

std::string encoded_by_oiio(const std::string& extension, int width, int height, int channels,
                            const OIIO::TypeDesc& type, const void* pixels) {
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    OIIO::ImageSpec spec(width, height, channels, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const std::string name = "picture" + extension;
    const auto output = OIIO::ImageOutput::create(name);
    EXPECT_TRUE(output && output->set_ioproxy(&memory) && output->open(name, spec) &&
                output->write_image(type, pixels) && output->close());
    return {bytes.begin(), bytes.end()};
}

}  // namespace

TestGltf::TestGltf() {
    json["asset"]["version"] = "2.0";
    json["scene"] = 0;
    json["scenes"] = {{{"nodes", nlohmann::json::array()}}};
}

int TestGltf::add(const std::string& list, const nlohmann::json& item) {
    json[list].push_back(item);
    return static_cast<int>(json[list].size()) - 1;
}

int TestGltf::add_node(const nlohmann::json& node) {
    const int index = add("nodes", node);
    json["scenes"][0]["nodes"].push_back(index);
    return index;
}

int TestGltf::add_view(const std::string& bytes) {
    buffer = padded(buffer, '\0');
    const int view = add("bufferViews", {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}});
    buffer += bytes;
    return view;
}

int TestGltf::add_floats(const std::string& type, const std::vector<float>& numbers) {
    const int view = add_view(bytes_of(numbers));
    return add("accessors", {{"bufferView", view},
                             {"componentType", 5126},
                             {"count", numbers.size() / static_cast<std::size_t>(components_of(type))},
                             {"type", type}});
}

int TestGltf::add_indices(const std::vector<std::uint16_t>& indices) {
    const int view = add_view(bytes_of(indices));
    return add("accessors",
               {{"bufferView", view}, {"componentType", 5123}, {"count", indices.size()}, {"type", "SCALAR"}});
}

nlohmann::json& TestGltf::add_mesh(const std::vector<float>& positions, const std::vector<std::uint16_t>& indices) {
    nlohmann::json primitive = {{"attributes", {{"POSITION", add_floats("VEC3", positions)}}}};
    if (!indices.empty())
        primitive["indices"] = add_indices(indices);
    const int mesh = add("meshes", {{"primitives", nlohmann::json::array({primitive})}});
    add_node({{"mesh", mesh}});
    return json["meshes"].back()["primitives"][0];
}

void TestGltf::animate(const std::string& path, const std::string& interpolation, const std::vector<float>& times,
                       const std::vector<float>& values, int node) {
    const int input = add_floats("SCALAR", times);
    const int output = add_floats(path == "weights" ? "SCALAR" : path == "rotation" ? "VEC4" : "VEC3", values);
    add("animations", {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
                       {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
}

std::string glb_of(const std::string& json, const std::string& binary) {
    const std::string text = padded(json, ' '), data = padded(binary, '\0');
    std::string chunks = u32(text.size()) + "JSON" + text;
    if (!data.empty())
        chunks += u32(data.size()) + std::string("BIN\0", 4) + data;
    return "glTF" + u32(2) + u32(12 + chunks.size()) + chunks;
}

std::string TestGltf::glb() const {
    nlohmann::json whole = json;
    if (!buffer.empty())
        whole["buffers"] = {{{"byteLength", buffer.size()}}};
    return glb_of(whole.dump(), buffer);
}

void TestGltf::write_glb(const std::filesystem::path& file) const {
    write_bytes(file, glb());
}

void TestGltf::write_gltf(const std::filesystem::path& file, const std::string& uri) const {
    nlohmann::json whole = json;
    if (!buffer.empty() && !whole.contains("buffers"))
        whole["buffers"] = {{{"byteLength", buffer.size()}, {"uri", uri}}};
    write_bytes(file, whole.dump());
    write_bytes(file.parent_path() / "buffer.bin", buffer);
}

TestGltf one_triangle() {
    TestGltf gltf;
    gltf.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0});
    return gltf;
}

bool Listener::warned(const std::string& code) const {
    return std::any_of(warnings.begin(), warnings.end(), [&](const auto& w) { return w.first == code; });
}

bool Listener::noticed(const std::string& part) const {
    return std::any_of(notices.begin(), notices.end(), [&](const std::string& n) { return contains(n, part); });
}

Loaded load_settings(const SceneSettings& settings, const std::filesystem::path& folder, double seconds,
                     std::uint64_t memory_limit, const dvec3& origin) {
    Loaded loaded;
    loaded.scene = load_scene(settings, folder, seconds, origin, memory_limit, loaded.messages);
    return loaded;
}

Loaded load_file(const std::filesystem::path& file, double seconds, std::uint64_t memory_limit) {
    SceneSettings settings;
    settings.files.push_back({file.filename().string()});
    return load_settings(settings, file.parent_path(), seconds, memory_limit);
}

Loaded load(const TestGltf& gltf, double seconds) {
    const TempFolder folder;
    gltf.write_glb(folder / "scene.glb");
    return load_file(folder / "scene.glb", seconds);
}

Failure failure_of_loading(const std::filesystem::path& file) {
    Failure failure = failure_of([&] { load_file(file); });
    EXPECT_TRUE(failure.message.empty() || contains(failure.message, file.parent_path().string())) << failure.message;
    EXPECT_FALSE(contains(failure.message, "\n")) << failure.message;
    return failure;
}

Failure failure_of_loading(const TestGltf& gltf) {
    const TempFolder folder;
    gltf.write_glb(folder / "scene.glb");
    return failure_of_loading(folder / "scene.glb");
}

std::string encoded(const std::string& extension, int width, int height, int channels,
                    const std::vector<std::uint8_t>& pixels) {
    return encoded_by_oiio(extension, width, height, channels, OIIO::TypeDesc::UINT8, pixels.data());
}

std::string encoded_png16(int width, int height, int channels, const std::vector<std::uint16_t>& pixels) {
    return encoded_by_oiio(".png", width, height, channels, OIIO::TypeDesc::UINT16, pixels.data());
}

void write_float_picture(const std::filesystem::path& file, int width, int height, const std::vector<float>& rgb) {
    const auto output = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(output && output->open(file.string(), OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT)) &&
                output->write_image(OIIO::TypeDesc::FLOAT, rgb.data()) && output->close());
}

void expect_near(const dvec3& a, const dvec3& b, double tolerance) {
    EXPECT_NEAR(glm::length(a - b), 0.0, tolerance) << a.x << " " << a.y << " " << a.z;
}

dvec3 cross_of(const SceneMesh& mesh, std::size_t triangle) {
    const glm::uvec3 t = mesh.triangles[triangle];
    const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    return glm::cross(b - a, c - a);
}

double area_of(const SceneMesh& mesh) {
    double area = 0.0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        area += 0.5 * glm::length(cross_of(mesh, i));
    return area;
}

std::string base64(const std::string& bytes) {
    static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t triple = 0;
        for (std::size_t k = 0; k < 3; ++k)
            triple = triple << 8 | static_cast<unsigned char>(bytes[i + k]);
        for (int shift = 18; shift >= 0; shift -= 6)
            text += kDigits[triple >> shift & 63];
    }
    return text;
}

}  // namespace brisance::testing
