// Three scalar grids that hold the parts of one colour or vector: "color_r", "color_g", "color_b"; "Cd.x", ...
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "volume/vdb_file.h"

namespace brisance {

using VectorParts = std::array<const GridInfo*, 3>;

// The first of `stems` (lower case) of which all three parts are there as usable numbers, whatever their case.
// Endings: _r _g _b, .r .g .b, _x _y _z, .x .y .z, X Y Z.
std::optional<VectorParts> find_vector_parts(const std::vector<GridInfo>& grids, std::span<const std::string> stems);

// One grid of three channels; where only some parts have a block, the others are 0. The census is that of the first.
// Throws Error BadData, beginning with `where`, when the parts are not scalars on one lattice.
BlockGrid join_vector_parts(const std::array<BlockGrid, 3>& parts, const std::string& where);

}  // namespace brisance
