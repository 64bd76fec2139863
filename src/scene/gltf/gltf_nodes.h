// The transforms of a glTF file's nodes at one moment (glTF 2.0, sections 3.5 and 3.11).
#pragma once

#include <vector>

#include "core/vec.h"
#include "scene/gltf/gltf_file.h"

namespace brisance {

struct PlacedNode {
    int node = 0;
    dmat4 world_from_node{1.0};
    bool moves = false;           // whether an animation moves it or one of its ancestors
    bool morphs = false;          // whether an animation changes `weights`
    std::vector<double> weights;  // of morph targets, by an animation; empty: not animated
};

// Every node of the default scene, else of the first, else of the file; parents before children. All animations of the
// file play together, since some exporters write one for each object; a channel holds its first and last values before
// and after its keys, and where two move the same the later one counts.
std::vector<PlacedNode> place_nodes(const GltfFile& file, const dmat4& world_from_file, double seconds,
                                    Progress& progress);

}  // namespace brisance
