// Morph targets of glTF meshes (glTF 2.0, section 3.7.2.2).
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/gltf/gltf_nodes.h"
#include "scene/scene.h"

namespace brisance {

// Of each primitive of a mesh; rejects the file where its primitives disagree.
std::size_t morph_target_count(const GltfFile& file, int mesh);

// The weights of a node's mesh, one for each target: of an animation, else the node's, else the mesh's, else 0. Rejects
// the file where they are not as many as the targets, or not finite.
std::vector<double> morph_weights(const GltfFile& file, const PlacedNode& placed);

// Adds the targets' displacements of POSITION and NORMAL, times their weights, to a mesh in the space of its node.
// Targets of weight 0 are not read. Targets that move texture coordinates leave them where they are, with a notice;
// normals are not of unit length afterwards. `name` is the primitive's. Rejects the file where a displacement is not
// finite, or where there are not as many as positions.
void morph(const GltfFile& file, const tinygltf::Primitive& primitive, const std::vector<double>& weights,
           const std::string& name, SceneMesh& mesh, Progress& progress);

// What morph() takes for a vertex while it reads a target.
constexpr double kMorphBytes = 2 * sizeof(vec3);

}  // namespace brisance
