// Which file and which grids a shot reads.
#pragma once

#include <optional>
#include <string>

namespace brisance {

enum class MappingPreset { Automatic, Houdini, EmberGen, Mantaflow };

// Names a grid as "name" or "name[index]". An absent optional asks for automatic mapping, an empty string for no grid.
struct GridRoles {
    std::optional<std::string> density;
    std::optional<std::string> temperature;
    std::optional<std::string> flame;
    std::optional<std::string> colour;
};

struct VolumeSettings {
    std::string file;  // may hold a frame token: ####, @@@, %04d, $F4, $F, <frame04>
    MappingPreset preset = MappingPreset::Automatic;
    GridRoles grids;
    bool half_voxel_shift = false;  // true: the sample of index i lies at i + 1/2 (what Blender means)
};

}  // namespace brisance
