// The channels of a glTF file's animations at one moment (glTF 2.0, section 3.11).
#pragma once

#include <optional>
#include <vector>

#include "core/vec.h"
#include "scene/gltf/gltf_file.h"

namespace brisance {

// What animations may change of a node. Its own transform comes before its parents'; `matrix` replaces the rest of it
// (glTF 2.0, section 3.5.3).
struct Pose {
    dvec3 translation{0.0}, scale{1.0};
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};  // quaternion x y z w
    std::optional<dmat4> matrix;
    std::vector<double> weights;         // of morph targets, one each; empty: not animated
    bool moves = false, morphs = false;  // whether a channel gives other values, or other weights, at other moments
};

// Sets what channels give at `seconds`, of poses[node of the file]; of all animations, the later over the earlier. A
// channel holds its first and last values before and after its keys. Rejects the file where a channel cannot be used.
// Leaves out with a notice or a warning: unknown properties, weights without morph targets, nodes with a matrix.
void apply_animations(const GltfFile& file, double seconds, std::vector<Pose>& poses, Progress& progress);

}  // namespace brisance
