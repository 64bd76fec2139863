#define TINYGLTF_IMPLEMENTATION
#include "scene/gltf/gltf_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <fstream>
#include <new>
#include <set>
#include <span>
#include <sstream>

#include "core/error.h"
#include "core/input_file.h"
#include "core/printable.h"

namespace brisance {
namespace {

constexpr std::array kKnownExtensions = {
    "KHR_lights_punctual",  "KHR_materials_emissive_strength", "KHR_materials_ior",    "KHR_materials_specular",
    "KHR_materials_unlit",  "KHR_materials_transmission",      "KHR_materials_volume", "KHR_mesh_quantization",
    "KHR_texture_transform"};
constexpr std::size_t kDeepestJson = 256;
constexpr std::size_t kBeyond = 8;  // bytes that tinygltf may read after the end: a chunk's header

using Bytes = std::vector<unsigned char>;

Bytes read_bytes(const std::filesystem::path& path, const std::string& whose, MemoryBudget& budget) {
    const std::uint64_t size = size_of_input(path, ExitCode::BadData, whose);
    budget.claim(path.string(), static_cast<double>(size));
    Bytes bytes;
    bytes.reserve(size + kBeyond);
    bytes.resize(size);
    std::ifstream in(path, std::ios::binary);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!in)
        throw Error(ExitCode::BadData,
                    fmt::format("{}: it cannot be read; check the disk and copy it again", path.string()));
    return bytes;
}

std::uint64_t u32_at(const Bytes& bytes, std::uint64_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

bool is_binary(const Bytes& bytes) {
    return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

// The lengths that a .glb claims, and its JSON.
std::span<const unsigned char> json_of_binary(const GltfFile& file, const Bytes& bytes) {
    if (bytes.size() >= 8 && u32_at(bytes, 4) != 2)
        file.reject(fmt::format("it is glTF {}, only glTF 2 can be read", u32_at(bytes, 4)), "convert it to glTF 2");
    constexpr std::uint64_t kJson = 20, kChunkHeader = 8;
    if (bytes.size() < kJson || u32_at(bytes, 8) > bytes.size())
        file.reject(fmt::format("truncated: it ends after {} of {} bytes", bytes.size(),
                                bytes.size() < 12 ? kJson : u32_at(bytes, 8)));
    const std::uint64_t length = u32_at(bytes, 8), json = u32_at(bytes, 12);
    if (length < kJson || json > length - kJson)
        file.reject("damaged: its JSON claims more bytes than it has");
    const std::uint64_t after_json = length - kJson - json;
    if (after_json >= kChunkHeader && u32_at(bytes, kJson + json) > after_json - kChunkHeader)
        file.reject("damaged: its binary chunk claims more bytes than it has");
    return {bytes.data() + kJson, json};
}

// tinygltf follows nested values by recursion, and a file must not be able to exhaust the stack.
void check_depth(const GltfFile& file, std::span<const unsigned char> json) {
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const unsigned char c = json[i];
        if (in_string && c == '\\')
            ++i;
        else if (c == '"')
            in_string = !in_string;
        else if (!in_string && (c == '{' || c == '['))
            ++depth;
        else if (!in_string && depth > 0 && (c == '}' || c == ']'))
            --depth;
        if (depth > kDeepestJson)
            file.reject("its JSON is nested too deeply to be glTF");
    }
}

// What tinygltf's callbacks need.
struct Reading {
    const GltfFile& file;
    MemoryBudget& budget;
};

// tinygltf has decoded '+' to a space, which only the queries of URIs do: the file with the plus signs is meant where
// none has the spaces.
std::filesystem::path found(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::exists(path, error) || path.filename().string().find(' ') == std::string::npos)
        return path;
    for (const auto& entry : std::filesystem::directory_iterator(path.parent_path(), error)) {
        std::string name = entry.path().filename().string();
        std::replace(name.begin(), name.end(), '+', ' ');
        if (name == path.filename().string())
            return entry.path();
    }
    return path;
}

bool read_buffer(Bytes* bytes, std::string*, const std::string& name, void* user) {
    const auto& reading = *static_cast<const Reading*>(user);
    if (name.starts_with("data:"))
        reading.file.reject(
            "a buffer is a data: URI of a kind that is not known (application/octet-stream in base64 "
            "is)");
    *bytes = read_bytes(found(reading.file.path.parent_path() / name),
                        "it is a buffer of " + reading.file.path.string(), reading.budget);
    return true;
}

// Encoded pictures: those of buffers stay there, those of data: URIs are kept as they are.
bool keep_image(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes, int size,
                void*) {
    if (image->bufferView < 0)
        image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

void check_version_and_extensions(const GltfFile& file, Progress& progress) {
    const tinygltf::Model& model = file.model;
    if (!model.asset.version.starts_with("2."))
        file.reject(fmt::format("it is glTF {}, only glTF 2 can be read", printable(model.asset.version, 16)),
                    "convert it to glTF 2");
    const auto known = [](const std::string& name) {
        return std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) != kKnownExtensions.end();
    };
    for (const std::string& name : model.extensionsRequired)
        if (!known(name))
            file.reject(fmt::format("it requires {}, which is not supported", printable(name, 60)),
                        "export it without");
    std::set<std::string> unknown;
    for (const std::string& name : model.extensionsUsed)
        if (!known(name))
            unknown.insert(printable(name, 60));
    if (!unknown.empty())
        progress.notice(fmt::format("{}: extensions left out: {}", file.path.string(), fmt::join(unknown, ", ")));
}

// What tinygltf says is wrong, without what is not: glTF 2.0 lets skins be without inverse bind matrices.
std::string without_false_alarm(const std::string& error) {
    std::istringstream lines(error);
    std::string kept;
    for (std::string line; std::getline(lines, line);)
        if (!line.starts_with("'inverseBindMatrices' property is missing"))
            kept += line + '\n';
    return kept;
}

// Runs tinygltf.
void parse(GltfFile& file, Bytes& bytes, MemoryBudget& budget, Progress& progress) {
    const auto size = static_cast<unsigned int>(bytes.size());
    const bool binary = is_binary(bytes);
    Reading reading{file, budget};
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(keep_image, nullptr);
    reader.SetFsCallbacks({[](const std::string& name, void*) { return !name.empty(); },
                           [](const std::string& name, void*) { return name; }, read_buffer, nullptr, &reading});
    bytes.resize(bytes.size() + kBeyond);
    std::string error, warning;
    const bool read = binary ? reader.LoadBinaryFromMemory(&file.model, &error, &warning, bytes.data(), size, "")
                             : reader.LoadASCIIFromString(&file.model, &error, &warning,
                                                          reinterpret_cast<const char*>(bytes.data()), size, "");
    check_version_and_extensions(file, progress);  // first: they may be why tinygltf could not go on
    error = without_false_alarm(error);
    if (!read)
        file.reject("not glTF, or damaged: " + printable(error, 160));
    if (!error.empty())
        progress.warning("gltf-part",
                         fmt::format("{}: left out what is not glTF: {}", file.path.string(), printable(error, 160)));
}

}  // namespace

void GltfFile::reject(const std::string& why, const std::string& remedy) const {
    throw Error(ExitCode::BadData, fmt::format("{}: {}; {}", path.string(), why, remedy));
}

std::filesystem::path GltfFile::resolved(const std::string& uri) const {
    const auto digit = [&](std::size_t i) {
        const int c = i < uri.size() ? std::tolower(static_cast<unsigned char>(uri[i])) : 0;
        return std::isdigit(c) ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
    };
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool escaped = uri[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0;
        decoded += escaped ? static_cast<char>(16 * digit(i + 1) + digit(i + 2)) : uri[i];
        i += escaped ? 2 : 0;
    }
    return path.parent_path() / decoded;
}

GltfFile read_gltf(const std::filesystem::path& path, MemoryBudget& budget, Progress& progress) {
    GltfFile file{path, {}};
    try {
        Bytes bytes = read_bytes(path, "", budget);
        if (bytes.size() > 0xfffffff0u)
            file.reject("it is larger than 4 GiB", "keep its buffers in files of their own");
        check_depth(file, is_binary(bytes) ? json_of_binary(file, bytes) : std::span<const unsigned char>(bytes));
        parse(file, bytes, budget, progress);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::Temporary, fmt::format("{}: there is not enough memory to read it", path.string()));
    } catch (const std::exception& error) {
        file.reject("damaged: " + printable(error.what(), 160));
    }
    return file;
}

std::string label(const char* kind, int index, const std::string& name) {
    return name.empty() ? fmt::format("{} {}", kind, index)
                        : fmt::format("{} {} ({})", kind, index, printable(name, 60));
}

}  // namespace brisance
