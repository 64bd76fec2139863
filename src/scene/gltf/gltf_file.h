// A glTF file in memory. The only door to tinygltf, which checks little: no index, no length and no count in `model`
// may be trusted. gltf_accessor.h reads buffers with all bounds checked.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/memory_budget.h"

// Pictures are decoded by read_texture, from files that are found as buffers are.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

namespace brisance {

struct GltfFile {
    std::filesystem::path path;
    tinygltf::Model model;  // images hold the encoded bytes of data: URIs

    // Throws Error BadData: the path, `why`, and what would help.
    [[noreturn]] void reject(const std::string& why, const std::string& remedy = "export or copy the file again") const;
    // `path` of a URI of this file, percent signs decoded.
    std::filesystem::path resolved(const std::string& uri) const;
};

// Reads .glb or .gltf, distinguished by their first bytes, with all buffers, whose bytes are claimed from `budget`
// first. Throws Error MissingInput, BadData (also for an unknown required extension) or Temporary.
GltfFile read_gltf(const std::filesystem::path& path, MemoryBudget& budget, Progress& progress);

// "material 3 (Floor)": for messages. Names come from files: what cannot be printed is left out.
std::string label(const char* kind, int index, const std::string& name);

// values[index] of a list that a file's index points into, e.g. file.model.meshes; rejects the file when it is beyond.
template <class T>
const T& checked(const GltfFile& file, const std::vector<T>& values, int index, const char* kind) {
    if (index < 0 || static_cast<std::size_t>(index) >= values.size())
        file.reject(std::string(kind) + " " + std::to_string(index) + " is used, of " + std::to_string(values.size()));
    return values[static_cast<std::size_t>(index)];
}

}  // namespace brisance
