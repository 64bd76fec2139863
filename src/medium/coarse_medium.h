// A medium on a coarser lattice, and fields between the two lattices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "medium/lattice/extinction_pyramid.h"

namespace brisance {

// The medium of a pyramid level: coarse nodes at every 2^level-th index, mean extinction, mean albedo by extinction.
// Without emission.
Medium coarse_medium(const ExtinctionPyramid& fine, int level);
Medium coarse_medium(const Medium& fine, int level);

// Averages node values (`channels` interleaved) to the lattice 2^levels coarser, with a pyramid's weights.
struct Averages {
    BrickLattice lattice;
    std::vector<float> values;
};
Averages averaged_down(const BrickLattice& lattice, std::span<const float> values, int channels, int levels);

// Splats node values (`channels` interleaved) to the lattice 2^levels coarser; keeps their sum.
std::vector<float> splat_down(const BrickLattice& lattice, std::span<const float> values, int channels, int levels);

// The nodes of the lattice twice as coarse, which becomes `coarse`, with a share in the interpolation at some node with
// `mask`.
std::vector<std::uint8_t> parents(const BrickLattice& fine, const std::vector<std::uint8_t>& mask,
                                  BrickLattice& coarse);

// Colours as interleaved channels, for splat_down(): a view.
std::span<const float> flattened(const std::vector<Rgb>& colours);

// Coarse node values at fine nodes, trilinearly.
struct CoarseSampler {
    const BrickLattice& lattice;
    int level;

    template <class Add>
    void at(const ivec3& fine_node, const Add& add) const {
        const ivec3 base = fine_node >> level;
        const vec3 f = vec3(fine_node - (base << level)) / float(1 << level);
        for (int k = 0; k < 8; ++k) {
            const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
            const float w = (d.x ? f.x : 1 - f.x) * (d.y ? f.y : 1 - f.y) * (d.z ? f.z : 1 - f.z);
            const std::int64_t i = w > 0.0f ? lattice.find_node(base + d) : -1;
            if (i >= 0)
                add(std::size_t(i), w);
        }
    }
};

}  // namespace brisance
