// Skins of glTF meshes (glTF 2.0, section 3.7.3).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/gltf/affine.h"
#include "scene/gltf/gltf_nodes.h"
#include "scene/memory_budget.h"
#include "scene/scene.h"

namespace brisance {

// From a mesh in its bind pose to local space, by each joint of a skin.
struct Skin {
    std::string name;  // for messages: "skin 0 (Bar)"
    std::vector<Affine> joints;
    bool moves = false;  // whether an animation moves one of its joints
};

// The skins of a file at the moment for which its nodes have been placed.
class GltfSkins {
public:
    // Keeps references to what it is given.
    GltfSkins(const GltfFile& file, const std::vector<PlacedNode>& nodes, const dvec3& origin, MemoryBudget& budget);

    // One of the file, read once. Rejects the file where a joint is not in the scene, and where the inverse bind
    // matrices are fewer than the joints, not affine or not finite.
    const Skin& skin(int index);

private:
    Skin read(int index) const;
    std::vector<dmat4> inverse_bind_matrices(int accessor, std::size_t joints, const std::string& name) const;

    const GltfFile& file_;
    const std::vector<PlacedNode>& nodes_;
    dvec3 origin_;
    MemoryBudget& budget_;
    std::map<int, int> placed_;  // node of the file to place in nodes_
    std::map<int, Skin> skins_;
};

// The sets JOINTS_n and WEIGHTS_n of a primitive; rejects the file, with the primitive's name, where there are none, or
// where one lacks the other.
std::size_t skin_set_count(const GltfFile& file, const tinygltf::Primitive& primitive, const std::string& name);

// Moves a mesh of that primitive from its bind pose to local space: each vertex by the mean of its joints' maps by its
// weights, which are divided by their sum. Vertices without weight follow their first joint, with a warning. Triangles
// that are mirrored turn around, so that their front stays in front. Rejects the file where the primitive has not as
// many joints or weights as positions, joints that the skin has not, or weights that are negative or not finite.
void pose_by_skin(const GltfFile& file, const tinygltf::Primitive& primitive, const Skin& skin, const std::string& name,
                  SceneMesh& mesh, Progress& progress);

// What pose_by_skin() takes for a vertex while it works.
inline double skin_bytes(std::size_t sets) {
    return static_cast<double>(4 * sets * (sizeof(float) + sizeof(std::uint32_t)) + 1);
}

}  // namespace brisance
