// Resolution, range and number of distances of the shadow maps of one level.
#pragma once

#include "core/progress.h"
#include "gathering/gather.h"
#include "shadows/shadow_maps.h"

namespace brisance {

// Texels along one side of the maps of the finest level that has some, and samples along each texel's ray: as given, or
// from the error asked for.
int shadow_resolution(const LightingSettings& settings);
int shadow_distances(const LightingSettings& settings);

// Lights with maps at once; resolution is reduced rather than fewer lights.
constexpr std::size_t kLeastBatch = 2048;

// `top`: no level is coarser.
ShadowMapLayout map_layout(const LightField& field, const GridLevel& level, bool top);

// Of the maps of all levels, as they are laid out.
std::uint64_t map_bytes(const LightField& field);

// Lowers the resolution, then the number of distances, until at least kLeastBatch lights (or all) fit the limit. Says
// so as a notice.
void fit_to_memory(ShadowMapLayout& layout, std::size_t lights, std::uint64_t limit, int level, Progress& progress);

}  // namespace brisance
