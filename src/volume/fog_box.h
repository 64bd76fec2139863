// Homogeneous fog without a file.
#pragma once

#include "volume/settings.h"
#include "volume/vdb_file.h"

namespace brisance {

// Returns density 1 at all nodes of the box, faces included, and 0 beyond. Outside of its faces it fades over one
// voxel. Throws Error Temporary, beginning with `where`, when it needs more than `memory_limit_bytes`.
BlockGrid fog_grid(const FogBox& box, std::uint64_t memory_limit_bytes, const std::string& where);

}  // namespace brisance
