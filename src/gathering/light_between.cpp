#include "gathering/light_between.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/rng.h"
#include "gathering/between_parents.h"
#include "gathering/light_roots.h"
#include "gathering/near_depth.h"

namespace brisance {

namespace {

constexpr float kMostDepth = 20.0f;  // of the smoke around a node: beyond it is night, and its inverse no number

float transmittance(float depth) {
    return std::exp(-std::min(depth, kMostDepth));
}

// One of 16 rows along z in every box of 4 x 4 x 16 nodes.
bool in_compared_row(const ivec3& node) {
    const auto part = [](int c) { return std::uint64_t(std::uint32_t(c) & 0x1fffffu); };
    const std::uint64_t box = part(node.x >> 2) << 42 | part(node.y >> 2) << 21 | part(node.z >> 4);
    const int row = static_cast<int>(Rng(stream_of("light between nodes"), box).next() * 16.0f);
    return row == ((node.x & 3) << 2 | (node.y & 3));
}

}  // namespace

LightBetween::LightBetween(const ExtinctionPyramid& pyramid, const std::vector<float>& mean_extinction,
                           const NodeReceivers& coarser, float reach)
    : medium_(pyramid.medium()),
      coarser_(coarser),
      depth_(near_depths(medium_.lattice, medium_.extinction, medium_.local_from_index, reach)),
      mean_depth_(near_depths(coarser.lattice, mean_extinction, 2.0f * medium_.local_from_index, reach)) {}

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

template <class Take>
void LightBetween::for_each_between(const Gathered& sum, const std::vector<std::uint8_t>& marked,
                                    const Take& take) const {
    Gathered roots = sum;
    const std::size_t nodes = coarser_.needed.size();
    take_roots(roots, nodes);
    for_each_between_parents(coarser_.lattice, std::as_const(roots).planes(), medium_.lattice, marked,
                             [&](std::size_t node, std::span<float> light) {
                                 raise_roots(light, planes_of_light(sum, nodes));
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
    for_each_between(sum, marked, [&](std::size_t node, std::span<const float> light) {
        for (std::size_t c = 0; c < to.size(); ++c)
            to[c][node] = light[c];
    });
}

LocalRatios LightBetween::ratios_of_own(const Gathered& sum, const std::vector<std::uint8_t>& compared,
                                        const Gathered& out) const {
    const std::size_t nodes = medium_.lattice.node_count();
    LocalRatios ratios(medium_.lattice);
    for_each_between(sum, compared, [&](std::size_t node, std::span<const float> light) {
        const Rgb own(out.fluence[node], out.fluence[nodes + node], out.fluence[2 * nodes + node]);
        ratios.add(node, medium_.extinction[node] * own, medium_.extinction[node] * Rgb(light[0], light[1], light[2]));
    });
    return ratios;
}

void LightBetween::mix(const Gathered& sum, const LocalRatios& ratios, const std::vector<std::uint8_t>& marked,
                       float own_share, Gathered& out) const {
    const auto to = out.planes();
    const std::vector<LocalRatios::Corners> corners = ratios.at_corners();
    for_each_between(sum, marked, [&](std::size_t node, std::span<const float> light) {
        const Rgb ratio = LocalRatios::at_node(corners[node / BrickLattice::kNodes],
                                               BrickLattice::node_in_brick(int(node % BrickLattice::kNodes)));
        for (std::size_t c = 0; c < to.size(); ++c)
            to[c][node] = glm::mix(ratio[int(c % 3)] * light[c], to[c][node], own_share);
    });
}

}  // namespace brisance
