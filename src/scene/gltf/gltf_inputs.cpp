#include "scene/gltf/gltf_inputs.h"

#include <limits>

#include "scene/gltf/gltf_file.h"

namespace brisance {

std::vector<std::filesystem::path> files_of_gltf(const std::filesystem::path& path) {
    MemoryBudget unlimited(std::numeric_limits<std::uint64_t>::max());
    Progress silent;
    const GltfFile file = read_gltf(path, unlimited, silent);
    std::vector<std::filesystem::path> files = {path};
    const auto add = [&](const std::string& uri) {
        if (!uri.empty() && !uri.starts_with("data:"))
            files.push_back(file.resolved(uri));
    };
    for (const tinygltf::Buffer& buffer : file.model.buffers)
        add(buffer.uri);
    for (const tinygltf::Image& image : file.model.images)
        add(image.uri);
    return files;
}

}  // namespace brisance
