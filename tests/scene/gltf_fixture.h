// glTF files that tests make, and the messages of loading them.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scene/load_scene.h"
#include "volume/temp_folder.h"

namespace brisance::testing {

// JSON, and one buffer that views and accessors are added to.
class TestGltf {
public:
    TestGltf();  // an asset without anything in it

    int add_view(const std::string& bytes);
    int add_floats(const std::string& type, const std::vector<float>& numbers);  // "SCALAR", "VEC3", "MAT4", ...
    int add_indices(const std::vector<std::uint16_t>& indices);
    int add(const std::string& list, const nlohmann::json& item);  // its index
    int add_node(const nlohmann::json& node);                      // of the scene
    // A mesh of one primitive on a node of its own.
    nlohmann::json& add_mesh(const std::vector<float>& positions, const std::vector<std::uint16_t>& indices = {});

    // An animation of one channel of a node; times in seconds.
    void animate(const std::string& path, const std::string& interpolation, const std::vector<float>& times,
                 const std::vector<float>& values, int node = 0);

    std::string glb() const;
    void write_glb(const std::filesystem::path& file) const;
    void write_gltf(const std::filesystem::path& file, const std::string& uri = "buffer.bin") const;

    nlohmann::json json;
    std::string buffer;
};

std::string glb_of(const std::string& json, const std::string& binary);

TestGltf one_triangle();  // (0 0 0) (1 0 0) (0 1 0), facing +z

// Records notices and warnings.
class Listener : public Progress {
public:
    void notice(const std::string& line) override { notices.push_back(line); }
    void warning(const std::string& code, const std::string& line) override { warnings.emplace_back(code, line); }
    bool warned(const std::string& code) const;
    bool noticed(const std::string& part) const;

    std::vector<std::string> notices;
    std::vector<std::pair<std::string, std::string>> warnings;
};

constexpr std::uint64_t kPlenty = std::uint64_t{4} << 30;

struct Loaded {
    Scene scene;
    Listener messages;
};
Loaded load_settings(const SceneSettings& settings, const std::filesystem::path& folder = ".", double seconds = 0.0,
                     std::uint64_t memory_limit = kPlenty, const dvec3& origin = dvec3(0.0));
Loaded load_file(const std::filesystem::path& file, double seconds = 0.0, std::uint64_t memory_limit = kPlenty);
Loaded load(const TestGltf& gltf, double seconds = 0.0);  // as .glb, in a folder of its own
Failure failure_of_loading(const std::filesystem::path& file);
Failure failure_of_loading(const TestGltf& gltf);

// A picture of 8 or 16 bits as a PNG's bytes, or with ".jpg" a JPEG's.
std::string encoded(const std::string& extension, int width, int height, int channels,
                    const std::vector<std::uint8_t>& pixels);
void write_float_picture(const std::filesystem::path& file, int width, int height, const std::vector<float>& rgb);
std::string encoded_png16(int width, int height, int channels, const std::vector<std::uint16_t>& pixels);

void expect_near(const dvec3& a, const dvec3& b, double tolerance = 1e-6);

dvec3 cross_of(const SceneMesh& mesh, std::size_t triangle);  // twice the area, along the normal
double area_of(const SceneMesh& mesh);

// For data: URIs; of lengths that 3 divides.
std::string base64(const std::string& bytes);

}  // namespace brisance::testing
