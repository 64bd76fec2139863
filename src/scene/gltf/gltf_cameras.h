// Cameras and lights of a glTF file.
#pragma once

#include <vector>

#include "scene/gltf/gltf_nodes.h"
#include "scene/scene.h"

namespace brisance {

// In the order of the nodes. Orthographic ones are left out with a notice, and so is a camera whose node has shrunk to
// a point or a plane, with a warning.
std::vector<SceneCamera> read_cameras(const GltfFile& file, const std::vector<PlacedNode>& nodes, Progress& progress);

// KHR_lights_punctual. As with materials that emit, a file's numbers are taken as radiometric: 1 cd is 1 W/sr, 1 lx is
// 1 W/m^2. Ranges, which would cut light off, are left out with a notice.
std::vector<LightSettings> read_lights(const GltfFile& file, const std::vector<PlacedNode>& nodes, Progress& progress);

}  // namespace brisance
