// Cameras (glTF 2.0, section 3.10) and lights of a glTF file.
#pragma once

#include <vector>

#include "scene/gltf/gltf_nodes.h"
#include "scene/scene.h"

namespace brisance {

// Returns cameras in the order of the nodes. Leaves out orthographic cameras with a notice, and cameras whose node has
// shrunk to a point or a plane with a warning.
std::vector<SceneCamera> read_cameras(const GltfFile& file, const std::vector<PlacedNode>& nodes, Progress& progress);

// KHR_lights_punctual. As with materials that emit, a file's numbers are taken as radiometric: 1 cd is 1 W/sr, 1 lx is
// 1 W/m^2. Ranges, which would cut light off, are left out with a notice.
std::vector<LightSettings> read_lights(const GltfFile& file, const std::vector<PlacedNode>& nodes, Progress& progress);

// Whether an animation moves a node with a camera or a light.
bool moves_camera_or_light(const GltfFile& file, const std::vector<PlacedNode>& nodes);

}  // namespace brisance
