#include "gathering/node_receivers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "gathering/between_parents.h"
#include "medium/coarse_medium.h"
#include "medium/lattice/brick_masks.h"
#include "medium/lattice/corners_seen.h"
#include "medium/voxel_size.h"

namespace brisance {

namespace {

// The distance between the nodes at which a level's light is gathered, over its blending radius. An interpolant errs as
// the square of that distance where light is smooth, and by more at the rims of dense smoke, where it has kinks: below
// the usual error the distance falls faster than as the square root.
constexpr float kShareOfRadius = 0.125f, kErrorOfShare = 0.02f;

// `error`: over the usual one.
float power_of_share(float error) {
    return std::pow(error, error < 1.0f ? 1.5f : 0.5f);
}

// The k-th node of a brick, in sub-blocks of 4 x 2 x 2 so that groups of 16 are compact.
ivec3 node_in_sub_blocks(int k) {
    const int sub = k >> 4, in = k & 15;
    return {(sub >> 4) * 4 + (in >> 2), (sub >> 2 & 3) * 2 + (in >> 1 & 1), (sub & 3) * 2 + (in & 1)};
}

std::size_t needed_in_brick(const NodeReceivers& nodes, std::size_t brick) {
    const auto first = nodes.needed.begin() + std::ptrdiff_t(brick * BrickLattice::kNodes);
    return std::size_t(std::count_if(first, first + BrickLattice::kNodes, [](std::uint8_t n) { return n != 0; }));
}

// Fills in block `block` of the receivers from the needed nodes of a brick.
void place_brick(const Medium& medium, const LatticeRequest& request, int coarsening, std::size_t brick,
                 std::size_t block, NodeReceivers& out) {
    std::vector<vec3> points, directions;
    std::vector<std::uint32_t> nodes;
    for (int k = 0; k < BrickLattice::kNodes; ++k) {
        const ivec3 p = node_in_sub_blocks(k);
        const std::size_t node = brick * BrickLattice::kNodes + BrickLattice::offset_in_brick(p);
        if (!out.needed[node])
            continue;
        nodes.push_back(static_cast<std::uint32_t>(node));
        points.push_back(medium.local_of_node((out.lattice.first_node(brick) + p) * (1 << coarsening)));
        if (request.eye)
            directions.push_back(direction_toward(*request.eye, points.back()));
    }
    const ReceiverBlock& all = out.receivers.blocks()[block];
    nodes.resize(all.group_count * Receivers::kGroup, nodes.back());  // as the receivers themselves are padded
    std::copy(nodes.begin(), nodes.end(), out.node_of.begin() + std::ptrdiff_t(all.first_group * Receivers::kGroup));
    out.receivers.set_block(block, points, directions);
}

// Fills in the receivers from the lattice and its needed nodes.
void place_receivers(const Medium& medium, const LatticeRequest& request, int coarsening, NodeReceivers& out) {
    std::vector<std::size_t> bricks, counts;
    for (std::size_t b = 0; b < out.lattice.brick_count(); ++b)
        if (const std::size_t count = needed_in_brick(out, b); count > 0) {
            bricks.push_back(b);
            counts.push_back(count);
        }
    out.receivers = Receivers(counts, request.eye.has_value());
    out.node_of.resize(out.receivers.size());
    parallel_for(
        bricks.size(), [&](std::size_t i) { place_brick(medium, request, coarsening, bricks[i], i, out); }, 64);
}

}  // namespace

NodeReceivers node_receivers(const Medium& medium, const LatticeRequest& request) {
    return marked_receivers(medium, request, *request.needed);
}

NodeReceivers marked_receivers(const Medium& medium, const LatticeRequest& request,
                               const std::vector<std::uint8_t>& marked) {
    NodeReceivers out{medium.lattice, marked, {}, {}};
    place_receivers(medium, request, 0, out);
    return out;
}

NodeReceivers coarser_receivers(const Medium& medium, const LatticeRequest& request, const NodeReceivers& fine,
                                int coarsening) {
    NodeReceivers out;
    out.needed = parents(fine.lattice, fine.needed, out.lattice);
    place_receivers(medium, request, coarsening, out);
    return out;
}

NodesBesideSurfaces part_beside_surfaces(const Medium& medium, const LatticeRequest& request, const NodeReceivers& fine,
                                         int coarsening, const Occluders& occluders) {
    const CornersSeen seen(medium, fine.lattice, coarsening, fine.needed, 1, occluders);
    NodesBesideSurfaces out{{fine.lattice, fine.needed, {}, {}}, {fine.lattice, {}, {}, {}}};
    out.beside.needed.resize(fine.needed.size(), 0);
    parallel_for(
        fine.lattice.brick_count(),
        [&](std::size_t b) {
            const CornersSeen::OfBrick* const corners = seen.of_brick(b);
            for (std::size_t k = 0; corners && k < BrickLattice::kNodes; ++k)
                if ((*corners)[k] != CornersSeen::kAll)
                    std::swap(out.in_the_open.needed[b * BrickLattice::kNodes + k],
                              out.beside.needed[b * BrickLattice::kNodes + k]);
        },
        64);
    place_receivers(medium, request, coarsening, out.beside);
    return out;
}

NodesBesideSurfaces part_within_reach(const Medium& medium, const LatticeRequest& request, const NodeReceivers& nodes,
                                      int coarsening, float reach, const Occluders& occluders) {
    NodesBesideSurfaces out{{nodes.lattice, nodes.needed, {}, {}}, {nodes.lattice, {}, {}, {}}};
    out.beside.needed.resize(nodes.needed.size(), 0);
    const auto near_surface = [&](const ivec3& first, int size) {
        const vec3 middle = vec3(first) + 0.5f * float(size - 1);
        const float half = 0.5f * float((size - 1) << coarsening) * longest_diagonal(medium);
        return occluders.any_within(
            medium.local_from_index * (middle * float(1 << coarsening) - vec3(medium.reference_node)), half + reach);
    };
    constexpr int kPart = BrickLattice::kSize / 2;  // of a brick, tested alone
    parallel_for(nodes.lattice.brick_count(), [&](std::size_t b) {
        const ivec3 first = nodes.lattice.first_node(b);
        if (!any_in_brick(nodes.needed, b) || !near_surface(first, BrickLattice::kSize))
            return;
        std::array<bool, 8> near;
        for (int k = 0; k < 8; ++k)
            near[k] = near_surface(first + kPart * ivec3(k >> 2, k >> 1 & 1, k & 1), kPart);
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const ivec3 part = BrickLattice::node_in_brick(n) / kPart;
            const std::size_t i = b * BrickLattice::kNodes + n;
            if (near[part.x << 2 | part.y << 1 | part.z])
                std::swap(out.in_the_open.needed[i], out.beside.needed[i]);
        }
    });
    place_receivers(medium, request, coarsening, out.beside);
    return out;
}

int coarsening_of(const LightField& field, const GridLevel& level) {
    // Without maps nothing is smoothed. Light of the finest level comes from within a voxel.
    if (field.settings.shadows != ShadowMethod::Maps || level.level == field.bottom)
        return 0;
    const float share = kShareOfRadius * power_of_share(field.settings.error / kErrorOfShare);
    const float lengths = share * field.alpha * level.spacing / field.pyramid->medium().spacing;
    return std::clamp(static_cast<int>(std::floor(std::log2(lengths))), 0, std::max(0, level.level - 1));
}

void add_at_nodes(const NodeReceivers& from, const Gathered& values, Gathered& out) {
    const auto source = values.planes();
    const auto sum = out.planes();
    const auto& blocks = from.receivers.blocks();
    parallel_for(
        blocks.size(),
        [&](std::size_t b) {
            const std::size_t first = blocks[b].first_group * Receivers::kGroup,
                              end = first + blocks[b].group_count * Receivers::kGroup;
            for (std::size_t c = 0; c < source.size(); ++c)
                for (std::size_t i = first; i < end; ++i)
                    if (i == first || from.node_of[i] != from.node_of[i - 1])  // padding repeats a block's last node
                        sum[c][from.node_of[i]] += source[c][i];
        },
        16);
}

void add_interpolated(const NodeReceivers& from, const Gathered& values, const NodeReceivers& to, Gathered& out) {
    const auto sum = out.planes();
    for_each_between_parents(from.lattice, values.planes(), to.lattice, to.needed,
                             [&](std::size_t node, std::span<const float> light) {
                                 for (std::size_t c = 0; c < sum.size(); ++c)
                                     sum[c][node] += light[c];
                             });
}

}  // namespace brisance
