#include "gathering/light_between.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/rng.h"
#include "gathering/between_parents.h"
#include "gathering/light_roots.h"
#include "gathering/near_depth.h"
#include "medium/lattice/node_key.h"
#include "medium/voxel_size.h"

namespace brisance {

namespace {

// The cubic interpolant of roots over the linear one, and the inverse: at kinks it would swing.
constexpr float kLeastOfLinear = 0.9f;
constexpr float kMostDepth = 20.0f;  // of the smoke around a node: beyond it is night, and its inverse no number

float transmittance(float depth) {
    return std::exp(-std::min(depth, kMostDepth));
}

// One of 16 rows along z in every box of 4 x 4 x 16 nodes.
bool in_compared_row(const ivec3& node) {
    const std::uint64_t box = node_key({node.x >> 2, node.y >> 2, node.z >> 4});
    const int row = static_cast<int>(Rng(stream_of("light between nodes"), box).next() * 16.0f);
    return row == ((node.x & 3) << 2 | (node.y & 3));
}

// The axes along which a node lies between two that gather: 1, or 0.
ivec3 odd_axes(std::size_t node) {
    return BrickLattice::node_in_brick(int(node % BrickLattice::kNodes)) & 1;
}

float count_of_odd_axes(std::size_t node) {
    const ivec3 odd = odd_axes(node);
    return float(odd.x + odd.y + odd.z);
}

}  // namespace

LightBetween::LightBetween(const ExtinctionPyramid& pyramid, const std::vector<float>& mean_extinction,
                           const NodeReceivers& coarser, float reach, const Occluders* surfaces)
    : medium_(pyramid.medium()),
      coarser_(coarser),
      depth_(near_depths(medium_.lattice, medium_.extinction, medium_.local_from_index, reach)),
      mean_depth_(near_depths(coarser.lattice, mean_extinction, 2.0f * medium_.local_from_index, reach)),
      smooth_(coarser.lattice.brick_count(), 1) {
    if (!surfaces)
        return;
    const float spacing = 2.0f * longest_diagonal(medium_);  // to nodes beyond the brick, and to those between them
    parallel_for(smooth_.size(), [&](std::size_t b) {
        const vec3 middle = vec3(coarser.lattice.first_node(b)) + 0.5f * float(BrickLattice::kSize - 1);
        smooth_[b] = !surfaces->any_within(medium_.local_from_index * (2.0f * middle - vec3(medium_.reference_node)),
                                           (0.5f * float(BrickLattice::kSize - 1) + 2.0f) * spacing);
    });
}

void LightBetween::add(const Gathered& values, bool in_mean_extinction, Gathered& sum) const {
    const auto from = values.planes();
    const auto to = sum.planes();
    parallel_for(
        mean_depth_.size(),
        [&](std::size_t i) {
            if (!coarser_.needed[i])
                return;
            float depth = mean_depth_[i];
            if (!in_mean_extinction) {
                const std::int64_t node = medium_.lattice.find_node(coarser_.lattice.node(i) * 2);
                depth = node >= 0 ? depth_[std::size_t(node)] : 0.0f;
            }
            const float before = 1.0f / transmittance(depth);
            for (std::size_t c = 0; c < from.size(); ++c)
                to[c][i] += before * from[c][i];
        },
        4096);
}

std::vector<std::vector<float>> LightBetween::second_differences(std::span<const float> values) const {
    const BrickLattice& lattice = coarser_.lattice;
    std::vector<std::vector<float>> out(3, std::vector<float>(values.size(), 0.0f));
    parallel_for(
        lattice.brick_count(),
        [&](std::size_t b) {
            if (!smooth_[b])
                return;
            for (int k = 0; k < BrickLattice::kNodes; ++k) {
                const std::size_t i = b * BrickLattice::kNodes + std::size_t(k);
                if (!coarser_.needed[i])
                    continue;
                for (int axis = 0; axis < 3; ++axis) {
                    ivec3 step(0);
                    step[axis] = 1;
                    const std::int64_t before = lattice.find_node(lattice.node(i) - step),
                                       after = lattice.find_node(lattice.node(i) + step);
                    if (before >= 0 && after >= 0 && coarser_.needed[std::size_t(before)] &&
                        coarser_.needed[std::size_t(after)])
                        out[std::size_t(axis)][i] =
                            values[std::size_t(before)] - 2.0f * values[i] + values[std::size_t(after)];
                }
            }
        },
        16);
    return out;
}

LightBetween::Interpolant LightBetween::interpolant_of(const Gathered& sum) const {
    const std::size_t nodes = coarser_.needed.size();
    Interpolant out{sum, {}, planes_of_light(sum, nodes)};
    take_roots(out.roots, nodes);
    const auto planes = std::as_const(out.roots).planes();
    for (std::size_t c = 0; c < out.lights; ++c)
        for (std::vector<float>& along : second_differences(planes[c]))
            out.curvature.push_back(std::move(along));
    return out;
}

template <class Take>
void LightBetween::for_each_between(const Interpolant& of, const std::vector<std::uint8_t>& marked,
                                    const Take& take) const {
    auto planes = of.roots.planes();
    const std::size_t count = planes.size();
    planes.insert(planes.end(), of.curvature.begin(), of.curvature.end());
    for_each_between_parents(
        coarser_.lattice, planes, medium_.lattice, marked, [&](std::size_t node, std::span<float> values) {
            const ivec3 odd = odd_axes(node);
            for (std::size_t c = 0; c < of.lights; ++c) {
                const float* const along = &values[count + 3 * c];
                // Through the nodes at -1, 0, 1 and 2, half way: a sixteenth of both second differences less.
                const float cubic = values[c] - 0.125f * (odd.x * along[0] + odd.y * along[1] + odd.z * along[2]);
                values[c] = std::clamp(cubic, kLeastOfLinear * values[c], values[c] / kLeastOfLinear);
            }
            const std::span<float> light = values.first(count);
            raise_roots(light, of.lights);
            const float passes = transmittance(depth_[node]);
            for (float& l : light)
                l *= passes;
            take(node, std::span<const float>(light));
        });
}

std::vector<std::uint8_t> LightBetween::compared_nodes(const std::vector<std::uint8_t>& needed) const {
    std::vector<std::uint8_t> compared(needed.size(), 0);
    parallel_for(
        needed.size(), [&](std::size_t i) { compared[i] = needed[i] && in_compared_row(medium_.lattice.node(i)); },
        4096);
    return compared;
}

void LightBetween::set(const Gathered& sum, const std::vector<std::uint8_t>& marked, Gathered& out) const {
    const auto to = out.planes();
    for_each_between(interpolant_of(sum), marked, [&](std::size_t node, std::span<const float> light) {
        for (std::size_t c = 0; c < to.size(); ++c)
            to[c][node] = light[c];
    });
}

// What collides by the compared nodes' own light beyond what does by the light between, over the latter and for each
// axis along which a node lies between two.
LocalRatios LightBetween::excess_of_own(const Interpolant& between, const std::vector<std::uint8_t>& compared,
                                        const Gathered& out) const {
    const std::size_t nodes = medium_.lattice.node_count();
    LocalRatios excess(medium_.lattice);
    for_each_between(between, compared, [&](std::size_t node, std::span<const float> light) {
        const Rgb own(out.fluence[node], out.fluence[nodes + node], out.fluence[2 * nodes + node]);
        const Rgb collides = medium_.extinction[node] * Rgb(light[0], light[1], light[2]);
        excess.add(node, medium_.extinction[node] * own - collides, count_of_odd_axes(node) * collides);
    });
    return excess;
}

void LightBetween::mix(const Gathered& sum, const std::vector<std::uint8_t>& compared,
                       const std::vector<std::uint8_t>& marked, float own_share, Gathered& out) const {
    const Interpolant between = interpolant_of(sum);
    const std::vector<LocalRatios::Corners> corners = excess_of_own(between, compared, out).at_corners();
    const auto to = out.planes();
    for_each_between(between, marked, [&](std::size_t node, std::span<const float> light) {
        const Rgb part = LocalRatios::at_node(corners[node / BrickLattice::kNodes],
                                              BrickLattice::node_in_brick(int(node % BrickLattice::kNodes)));
        const Rgb factor = glm::max(1.0f + count_of_odd_axes(node) * part, 0.0f);
        for (std::size_t c = 0; c < to.size(); ++c)
            to[c][node] = glm::mix(factor[int(c % 3)] * light[c], to[c][node], own_share);
    });
}

}  // namespace brisance
