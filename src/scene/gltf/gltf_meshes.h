// Triangles of a glTF file (glTF 2.0, section 3.7).
#pragma once

#include <cstdint>
#include <vector>

#include "scene/gltf/gltf_materials.h"
#include "scene/gltf/gltf_nodes.h"

namespace brisance {

// Counts of triangles left out of a file or a quick shape, by reason.
struct LeftOut {
    std::size_t without_area = 0, not_finite = 0;
    void warn(const std::string& where, Progress& progress) const;
};

// Takes triangles without area or with positions that are not finite out of a mesh, and vertices that are not finite.
// Without area: too small for the square of twice the area in single precision, some 5e-20 m^2.
void leave_out_unusable(SceneMesh& mesh, LeftOut& left_out);

// What `triangles` and their vertices take, with an estimate of the tree by which rays find them.
double bytes_with_tree(double triangles, double vertices);

// Adds the triangles of all nodes to a scene, a mesh for each primitive of each node, moved by morph targets, then by
// its skin or else its node (gltf_morph.h, gltf_skins.h). Claims what they take before anything is allocated. Sets
// scene.animated where an animation moves any of them. Takes textures from `same_pictures` where it is given
// (load_scene.h).
void read_meshes(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene, MemoryBudget& budget,
                 Progress& progress, const Scene* same_pictures);

}  // namespace brisance
