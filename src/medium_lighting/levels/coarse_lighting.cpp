#include "medium_lighting/levels/coarse_lighting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/parallel.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/coarse_medium.h"

namespace brisance {

namespace {

constexpr int kMostParents = BrickLattice::kSize / 2 + 2;  // along one side of a brick, at level 1

// Coarse values around one brick, as planes.
template <int channels>
class Parents {
public:
    Parents(const BrickLattice& lattice, std::span<const float> values, const ivec3& first_fine, int level)
        : level_(level), low_(first_fine >> level), wide_(((BrickLattice::kSize - 1) >> level) + 2) {
        copy_box(lattice, values, channels, low_, ivec3(wide_), box_);
    }

    // `seen`: the corners that count (corners_seen.h); the others count for nothing. Where all are hidden, as between
    // walls that are nearer to each other than nodes are, all count.
    void at(const ivec3& fine, std::uint8_t seen, float* out) const {
        const ivec3 base = fine >> level_, cell = base - low_;
        const vec3 f = vec3(fine - (base << level_)) / float(1 << level_);
        const int plane = wide_ * wide_ * wide_;
        std::fill_n(out, channels, 0.0f);
        float all = 0.0f;
        for (int k = 0; k < 8; ++k) {
            if (!(seen >> k & 1))
                continue;
            const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
            const vec3 w = glm::mix(1.0f - f, f, vec3(d));
            const int i = ((cell.x + d.x) * wide_ + cell.y + d.y) * wide_ + cell.z + d.z;
            for (int c = 0; c < channels; ++c)
                out[c] += w.x * w.y * w.z * box_[c * plane + i];
            all += w.x * w.y * w.z;
        }
        if (all == 0.0f)
            return at(fine, CornersSeen::kAll, out);
        for (int c = 0; c < channels && seen != CornersSeen::kAll; ++c)
            out[c] /= all;
    }

    // At all nodes of the brick, from all corners: along one axis after the other, a row of nodes at once.
    void at_all(const ivec3& first_fine, float* out) const {
        constexpr int kSide = BrickLattice::kSize, kPlane = kSide * kSide;
        const std::array<Axis, 3> axes = {axis(first_fine.x, low_.x), axis(first_fine.y, low_.y),
                                          axis(first_fine.z, low_.z)};
        std::array<float, kMostParents * kMostParents * kSide> along_z;
        std::array<float, kMostParents * kPlane> along_yz;
        for (int c = 0; c < channels; ++c) {
            const float* const box = &box_[std::size_t(c * wide_ * wide_ * wide_)];
            for (int row = 0; row < wide_ * wide_; ++row)
                for (int z = 0; z < kSide; ++z)
                    along_z[row * kSide + z] =
                        axes[2].between(z, box[row * wide_ + axes[2].cell[z]], box[row * wide_ + axes[2].cell[z] + 1]);
            for (int x = 0; x < wide_; ++x)
                for (int y = 0; y < kSide; ++y) {
                    const float* const from = &along_z[std::size_t((x * wide_ + axes[1].cell[y]) * kSide)];
                    for (int z = 0; z < kSide; ++z)
                        along_yz[x * kPlane + y * kSide + z] = axes[1].between(y, from[z], from[kSide + z]);
                }
            for (int x = 0; x < kSide; ++x) {
                const float* const from = &along_yz[std::size_t(axes[0].cell[x] * kPlane)];
                for (int i = 0; i < kPlane; ++i)
                    out[(x * kPlane + i) * channels + c] = axes[0].between(x, from[i], from[kPlane + i]);
            }
        }
    }

private:
    // Of the nodes of a brick along one axis: the parent below, counted from the box's first, and how far beyond it.
    struct Axis {
        std::array<int, BrickLattice::kSize> cell;
        std::array<float, BrickLattice::kSize> beyond;
        float between(int node, float below, float above) const { return below + beyond[node] * (above - below); }
    };
    Axis axis(int first_fine, int low) const {
        Axis out;
        for (int k = 0; k < BrickLattice::kSize; ++k) {
            const int base = (first_fine + k) >> level_;
            out.cell[k] = base - low;
            out.beyond[k] = float(first_fine + k - (base << level_)) / float(1 << level_);
        }
        return out;
    }

    int level_;
    ivec3 low_;
    int wide_;
    std::array<float, channels * kMostParents * kMostParents * kMostParents> box_;
};

template <int channels>
void at_fine_nodes(const BrickLattice& coarse, std::span<const float> values, int level, const BrickLattice& fine,
                   const CornersSeen* seen, float* out) {
    parallel_for(
        fine.brick_count(),
        [&](std::size_t b) {
            const ivec3 first = fine.first_node(b);
            const Parents<channels> parents(coarse, values, first, level);
            float* const here = out + b * BrickLattice::kNodes * channels;
            const CornersSeen::OfBrick* const corners = seen ? seen->of_brick(b) : nullptr;
            if (!corners)
                return parents.at_all(first, here);
            for (int k = 0; k < BrickLattice::kNodes; ++k)
                parents.at(first + BrickLattice::node_in_brick(k), (*corners)[k], here + k * channels);
        },
        16);
}

}  // namespace

std::vector<Rgb> emission_of(const Medium& medium) {
    std::vector<Rgb> emission(medium.extinction.size(), Rgb(0.0f));
    parallel_for(
        emission.size(),
        [&](std::size_t i) {
            if (!medium.source.empty())
                emission[i] = medium.extinction[i] * medium.source[i];
            if (!medium.emission.empty())
                emission[i] += medium.emission[i];
        },
        4096);
    return emission;
}

std::vector<float> emission_luminance(const Medium& medium) {
    std::vector<float> emission(medium.extinction.size(), 0.0f);
    parallel_for(
        emission.size(),
        [&](std::size_t i) {
            if (!medium.source.empty())
                emission[i] = medium.extinction[i] * luminance(medium.source[i]);
            if (!medium.emission.empty())
                emission[i] += luminance(medium.emission[i]);
        },
        4096);
    return emission;
}

Medium medium_to_light(const Medium& fine, int level) {
    Medium coarse = coarse_medium(fine, level);
    const float blur = (2.0f - std::exp2(-2.0f * float(level))) / 6.0f;
    std::vector<float>& extinction = coarse.extinction;
    sharpen_nodes(coarse.lattice, extinction, 1, 0.5f * blur);
    coarse.max_extinction = extinction.empty() ? 0.0f : *std::max_element(extinction.begin(), extinction.end());
    if (!fine.emits())
        return coarse;
    std::vector<float> mean = averaged_down(fine.lattice, flattened(emission_of(fine)), 3, level).values;
    sharpen_nodes(coarse.lattice, mean, 3, 0.5f * blur);
    coarse.emission.resize(extinction.size());
    for (std::size_t i = 0; i < coarse.emission.size(); ++i)
        coarse.emission[i] = {mean[3 * i], mean[3 * i + 1], mean[3 * i + 2]};
    return coarse;
}

std::vector<Rgb> light_at_fine_nodes(const BrickLattice& coarse, const std::vector<Rgb>& light, int level,
                                     const BrickLattice& fine, const CornersSeen* seen) {
    std::vector<Rgb> out(fine.node_count());
    at_fine_nodes<3>(coarse, flattened(light), level, fine, seen, reinterpret_cast<float*>(out.data()));
    return out;
}

std::vector<float> scalars_at_fine_nodes(const BrickLattice& coarse, const std::vector<float>& values, int level,
                                         const BrickLattice& fine) {
    std::vector<float> out(fine.node_count());
    at_fine_nodes<1>(coarse, values, level, fine, nullptr, out.data());
    return out;
}

void scalars_at_fine_nodes(const BrickLattice& coarse, std::span<const float> values, int level,
                           const BrickLattice& fine, std::size_t brick, std::span<float, BrickLattice::kNodes> out) {
    const ivec3 first = fine.first_node(brick);
    Parents<1>(coarse, values, first, level).at_all(first, out.data());
}

}  // namespace brisance
