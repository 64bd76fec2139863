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

// The resolution of each light's map, at least kLeastResolution and at most twice the layout's. Null: the layout's.
//
// A map whose texels are too large lets light through, more often than not, so that errors of maps add up. They fall as
// the resolution's power -4/3. With w the light's intensity times the importance of the receivers in its reach, the sum
// of w times the error is least for a number of texels where resolutions go as w^(3/10). They are scaled such that this
// sum is that of maps with the layout's resolution. What nobody sees thus costs little, and nothing is cut off.
constexpr int kLeastResolution = 4;
std::vector<std::uint8_t> map_resolutions(const GridLevel& level, const ShadowMapLayout& layout,
                                          const ReceiverImportance* importance);

// Lowers the resolution, then the number of distances, until at least kLeastBatch lights (or all) fit the limit. Says
// so as a notice.
void fit_to_memory(ShadowMapLayout& layout, std::size_t lights, std::uint64_t limit, int level, Progress& progress);

}  // namespace brisance
