#include "medium_lighting/levels/coarse_lighting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/coarse_medium.h"

namespace brisance {

namespace {

constexpr int kMostParents = BrickLattice::kSize / 2 + 2;  // along one side of a brick, at level 1

Rgb eighth_root(const Rgb& v) {
    return glm::sqrt(glm::sqrt(glm::sqrt(v)));
}

Rgb eighth_power(const Rgb& v) {
    const Rgb square = v * v, fourth = square * square;
    return fourth * fourth;
}

// Coarse values around one brick, as planes.
class Parents {
public:
    Parents(const BrickLattice& lattice, std::span<const float> values, const ivec3& first_fine, int level)
        : level_(level), low_(first_fine >> level), wide_(((BrickLattice::kSize - 1) >> level) + 2) {
        copy_box(lattice, values, 3, low_, ivec3(wide_), box_);
    }

    Rgb at(const ivec3& fine) const {
        const ivec3 base = fine >> level_, cell = base - low_;
        const vec3 f = vec3(fine - (base << level_)) / float(1 << level_);
        const int plane = wide_ * wide_ * wide_;
        Rgb sum(0.0f);
        for (int k = 0; k < 8; ++k) {
            const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
            const vec3 w = glm::mix(1.0f - f, f, vec3(d));
            const int i = ((cell.x + d.x) * wide_ + cell.y + d.y) * wide_ + cell.z + d.z;
            for (int c = 0; c < 3; ++c)
                sum[c] += w.x * w.y * w.z * box_[c * plane + i];
        }
        return sum;
    }

private:
    int level_;
    ivec3 low_;
    int wide_;
    std::array<float, 3 * kMostParents * kMostParents * kMostParents> box_;
};

std::vector<float> emission_of(const Medium& medium) {
    std::vector<float> emission(medium.extinction.size() * 3, 0.0f);
    parallel_for(
        medium.extinction.size(),
        [&](std::size_t i) {
            for (int c = 0; c < 3; ++c) {
                if (!medium.source.empty())
                    emission[3 * i + c] = medium.extinction[i] * medium.source[i][c];
                if (!medium.emission.empty())
                    emission[3 * i + c] += medium.emission[i][c];
            }
        },
        4096);
    return emission;
}

}  // namespace

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
    if (!fine.emits())
        return coarse;
    const std::vector<float> mean = averaged_down(fine.lattice, emission_of(fine), 3, level);
    coarse.emission.resize(coarse.extinction.size());
    for (std::size_t i = 0; i < coarse.emission.size(); ++i)
        coarse.emission[i] = {mean[3 * i], mean[3 * i + 1], mean[3 * i + 2]};
    return coarse;
}

Medium medium_to_light_smoke(const Medium& fine, int level) {
    Medium coarse = medium_to_light(fine, level);
    const float blur = (2.0f - std::exp2(-2.0f * float(level))) / 6.0f;
    std::vector<float>& extinction = coarse.extinction;
    sharpen_nodes(coarse.lattice, extinction, 1, 0.5f * blur);
    coarse.max_extinction = extinction.empty() ? 0.0f : *std::max_element(extinction.begin(), extinction.end());
    return coarse;
}

std::vector<Rgb> light_at_fine_nodes(const BrickLattice& coarse, std::vector<Rgb> light, int level,
                                     const BrickLattice& fine, Interpolation how) {
    const bool roots = how == Interpolation::EighthRoots;
    if (roots)
        parallel_for(
            light.size(), [&](std::size_t i) { light[i] = eighth_root(light[i]); }, 4096);
    const std::span<const float> values(reinterpret_cast<const float*>(light.data()), light.size() * 3);
    std::vector<Rgb> out(fine.node_count());
    parallel_for(
        fine.brick_count(),
        [&](std::size_t b) {
            const ivec3 first = fine.first_node(b);
            const Parents parents(coarse, values, first, level);
            for (int k = 0; k < BrickLattice::kNodes; ++k) {
                const Rgb value = parents.at(first + BrickLattice::node_in_brick(k));
                out[b * BrickLattice::kNodes + k] = roots ? eighth_power(value) : value;
            }
        },
        16);
    return out;
}

}  // namespace brisance
