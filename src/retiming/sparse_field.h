// Trilinear samples of values at the nodes of a sparse lattice.
#pragma once

#include <array>
#include <vector>

#include "medium/lattice/brick_lattice.h"

namespace brisance {

// The eight nodes around a point, x slowest: where each has its index in a field's array, or -1 outside of all bricks.
struct Cell {
    std::array<std::int64_t, 8> node;
    vec3 part;  // of the way from the lowest node, per axis
};

inline Cell cell_at(const BrickLattice& lattice, const dvec3& p) {
    const dvec3 low = glm::floor(p);
    const ivec3 base(low);
    Cell cell;
    cell.part = vec3(p - low);
    const ivec3 in = base & 7;
    if (in.x < 7 && in.y < 7 && in.z < 7) {
        const std::int64_t first = lattice.find_node(base);
        for (int k = 0; k < 8; ++k)
            cell.node[k] = first < 0 ? -1 : first + (k >> 2) * 64 + (k >> 1 & 1) * 8 + (k & 1);
        return cell;
    }
    for (int k = 0; k < 8; ++k)
        cell.node[k] = lattice.find_node(base + ivec3(k >> 2, k >> 1 & 1, k & 1));
    return cell;
}

inline float weight_of(const Cell& cell, int k) {
    const vec3& f = cell.part;
    return (k & 4 ? f.x : 1.0f - f.x) * (k & 2 ? f.y : 1.0f - f.y) * (k & 1 ? f.z : 1.0f - f.z);
}

// `Channels` interleaved values, 0 outside of all bricks.
template <int Channels>
std::array<float, Channels> sample(const Cell& cell, const float* values) {
    std::array<float, Channels> sum{};
    for (int k = 0; k < 8; ++k) {
        if (cell.node[k] < 0)
            continue;
        const float w = weight_of(cell, k);
        const float* const at = values + cell.node[k] * Channels;
        for (int c = 0; c < Channels; ++c)
            sum[c] += w * at[c];
    }
    return sum;
}

// One channel of several.
inline float sample_channel(const Cell& cell, const float* values, int channels, int channel) {
    float sum = 0.0f;
    for (int k = 0; k < 8; ++k)
        if (cell.node[k] >= 0)
            sum += weight_of(cell, k) * values[cell.node[k] * channels + channel];
    return sum;
}

}  // namespace brisance
