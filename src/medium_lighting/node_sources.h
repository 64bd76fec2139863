// Source functions at the medium's nodes: what lighting hands to the camera.
#pragma once

#include <vector>

#include "core/vec.h"

namespace brisance {

// Albedo times in-scattered radiance toward the camera, per node of the medium's lattice [W/(m^2 sr)], by ledger cell;
// an empty one is left out.
struct NodeSources {
    std::vector<Rgb> single;         // MV
    std::vector<Rgb> multiple;       // MM
    std::vector<Rgb> from_surfaces;  // MS
    std::vector<Rgb> from_emitters;  // MA
    // The share of MA that is theirs; the rest is sampled along the camera's rays, which they guide.
    float emitters_at_nodes = 1.0f;
};

struct NodeLighting : NodeSources {
    std::vector<std::vector<Rgb>> orders;  // of `multiple`, where orders are kept apart; the last is the tail
};

}  // namespace brisance
