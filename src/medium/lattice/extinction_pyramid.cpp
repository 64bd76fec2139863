#include "medium/lattice/extinction_pyramid.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr int kAveraged = 2 * BrickLattice::kSize + 1;  // fine nodes per axis that one coarse brick averages

// Averages over one axis of `groups` boxes of kAveraged slabs, each of `slab` values: kSize slabs remain of each.
void average_slabs(const float* values, int groups, int slab, std::vector<float>& out) {
    out.resize(std::size_t(groups) * BrickLattice::kSize * slab);
    for (int g = 0; g < groups; ++g)
        for (int k = 0; k < BrickLattice::kSize; ++k) {
            const float* v = values + (std::size_t(g) * kAveraged + 2 * k) * slab;
            float* to = &out[(std::size_t(g) * BrickLattice::kSize + k) * slab];
            for (int i = 0; i < slab; ++i)
                to[i] = 0.25f * (v[i] + v[i + 2 * slab]) + 0.5f * v[i + slab];
        }
}

}  // namespace

void coarsen(const BrickLattice& fine, std::span<const float> values, int channels, BrickLattice& coarse,
             std::vector<float>& coarse_values) {
    coarse = coarse_lattice(fine);
    coarse_values.assign(coarse.node_count() * channels, 0.0f);
    const std::size_t plane = std::size_t(kAveraged) * kAveraged * kAveraged;
    parallel_blocks(coarse.brick_count(), 4, [&](std::size_t begin, std::size_t end) {
        std::vector<float> box(plane * channels), along_x, along_y;
        for (std::size_t b = begin; b < end; ++b) {
            copy_box(fine, values, channels, coarse.first_node(b) * 2 - 1, ivec3(kAveraged), box);
            for (int c = 0; c < channels; ++c) {
                average_slabs(&box[plane * c], 1, kAveraged * kAveraged, along_x);
                average_slabs(along_x.data(), BrickLattice::kSize, kAveraged, along_y);
                for (int n = 0; n < BrickLattice::kNodes; ++n) {
                    const float* v = &along_y[std::size_t(n / BrickLattice::kSize) * kAveraged +
                                              std::size_t(2 * (n % BrickLattice::kSize))];
                    coarse_values[(b * BrickLattice::kNodes + n) * channels + c] = 0.25f * (v[0] + v[2]) + 0.5f * v[1];
                }
            }
        }
    });
}

ExtinctionPyramid::ExtinctionPyramid(const Medium& medium, int levels) : medium_(&medium) {
    lattices_.push_back(medium.lattice);
    nodes_.push_back(medium.extinction);
    levels = std::min(levels, kMaxLevels);
    while (static_cast<int>(lattices_.size()) < levels && !lattices_.back().empty()) {
        const ivec3 e = lattices_.back().brick_extent();
        if (std::max({e.x, e.y, e.z}) <= 1)
            break;
        BrickLattice coarse;
        std::vector<float> values;
        coarsen(lattices_.back(), nodes_.back(), 1, coarse, values);
        lattices_.push_back(std::move(coarse));
        nodes_.push_back(std::move(values));
    }
    for (std::size_t l = 0; l < lattices_.size(); ++l)
        packed_.emplace_back(lattices_[l], nodes_[l], medium.reference_node >> int(l));
}

std::uint64_t ExtinctionPyramid::bytes() const {
    std::uint64_t sum = 0;
    for (std::size_t l = 0; l < packed_.size(); ++l)
        sum += packed_[l].bytes() + nodes_[l].size() * 4 + lattices_[l].bytes();
    return sum;
}

float ExtinctionPyramid::extinction_at(const vec3& local) const {
    const vec3 p = medium_->index_from_local * local;
    const vec3 base = glm::floor(p);
    const vec3 f = p - base;
    float sum = 0.0f;
    for (int k = 0; k < 8; ++k) {
        const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
        const std::int64_t i = lattices_[0].find_node(ivec3(base) + d + medium_->reference_node);
        if (i >= 0)
            sum += (d.x ? f.x : 1 - f.x) * (d.y ? f.y : 1 - f.y) * (d.z ? f.z : 1 - f.z) * nodes_[0][i];
    }
    return sum;
}

float ExtinctionPyramid::optical_depth(const vec3& from, const vec3& to) const {
    const float nodes = glm::length(medium_->index_from_local * (to - from));
    const int steps = std::max(1, static_cast<int>(std::ceil(2.0f * nodes)));
    double sum = 0.0;
    for (int s = 0; s < steps; ++s)
        sum += extinction_at(glm::mix(from, to, (s + 0.5f) / steps));
    return static_cast<float>(sum * glm::length(to - from) / steps);
}

}  // namespace brisance
