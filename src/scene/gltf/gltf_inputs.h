// The files that a glTF file refers to.
#pragma once

#include <filesystem>
#include <vector>

namespace brisance {

// The file itself, then its buffers and its pictures, those within the file left out. A picture that no material uses
// is among them. Throws Error as read_gltf.
std::vector<std::filesystem::path> files_of_gltf(const std::filesystem::path& path);

}  // namespace brisance
