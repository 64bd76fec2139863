// The vector kernel of the near field processes rows of eight nodes for all separations.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "near_field/near_field.h"

namespace brisance {

// A separation whose nodes are given as offsets in a brick's box.
struct FlatSeparation {
    int offset;
    float kernel;
    vec3 direction;
    float basis[8];
    int first_tap, last_tap;  // into FlatStencil::taps
};

struct FlatTap {
    int offset;
    float length;  // [m]
};

struct FlatStencil {
    std::vector<FlatSeparation> separations;
    std::vector<FlatTap> taps;
    std::array<int, 6> beside;  // the separations one node down and up each axis; -1: it has none
};

// One brick and `margin` nodes all round, planar, z fastest.
struct NearBrick {
    int wide, margin;
    std::size_t plane;
    const float* extinction;
    const float* intensity;     // 3 planes
    const float* directional;   // 24 planes or null
    const vec3* toward_camera;  // of the brick's 512 nodes, or null
    // Of each row and separation a byte: bit k tells whether the row's node k sees the node at that separation
    // (LinesOfSight). Null: all do.
    const std::uint8_t* seen;
    float mean_cosine;
    std::size_t out_plane;
    float* fluence;
    float* scattered;
    float* moments;
};

FlatStencil flatten(const NearField& field, int wide);
void gather_near(const NearField& field, const FlatStencil& stencil, const NearBrick& brick);

}  // namespace brisance
