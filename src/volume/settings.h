// Which file and which grids a shot reads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"

namespace brisance {

enum class MappingPreset { Automatic, Houdini, EmberGen, Mantaflow };

// Names a grid as "name" or "name[index]". An absent optional means automatic mapping, an empty string no grid.
struct GridRoles {
    std::optional<std::string> density;
    std::optional<std::string> temperature;
    std::optional<std::string> flame;
    std::optional<std::string> colour;
    // One grid of three channels or three of one; empty: no grid.
    std::optional<std::vector<std::string>> velocity;
};

// Homogeneous fog of density 1 instead of a file.
struct FogBox {
    dvec3 low{0.0}, high{0.0};  // [m], in the file's space: `up` and `world_from_file` transform it
    double voxel_metres = 0.0;  // 0: a 32nd of its longest side
};

struct VolumeSettings {
    std::optional<FogBox> box;  // of further volumes
    std::string file;           // may hold a frame token: ####, @@@, %04d, $F4, $F, <frame04>
    MappingPreset preset = MappingPreset::Automatic;
    GridRoles grids;
    bool half_voxel_shift = false;  // true: the sample of index i lies at i + 1/2 (what Blender means)
    char up = 'y';  // the world's axis that the file's y becomes: 'y' as it is, 'z': (x, y, z) -> (x, -z, y)
    dmat4 world_from_file{1.0};  // affine; applied after `up`
    std::string node;  // of the shot's glTF files, which carries the volume: its place at a frame is applied last
};

// Returns `up` and `world_from_file` as one matrix. Throws Error Usage, beginning with `where`, when the matrix is not
// affine or cannot be inverted.
dmat4 placement(const VolumeSettings& settings, const std::string& where);

}  // namespace brisance
