// Points with properties as PLY files, which Blender, MeshLab and CloudCompare read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace brisance {

struct PlyProperty {
    enum class Type { Double, Float, Int, Byte };  // written as 64 and 32 bit IEEE, 32 bit signed, 8 bit unsigned
    std::string name;
    Type type = Type::Float;
    std::vector<double> values;  // one for every vertex
};

// Binary, little endian: vertices alone, properties in their order. `comments`: one line each. Written as a whole file;
// throws Error CannotCreate or OutputFailed as write_whole_file, and RenderFailed where properties are not equally
// long.
void write_ply(const std::filesystem::path& file, const std::vector<PlyProperty>& properties,
               const std::vector<std::string>& comments);

}  // namespace brisance
