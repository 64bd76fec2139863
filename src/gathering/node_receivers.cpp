#include "gathering/node_receivers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "medium/coarse_medium.h"

namespace brisance {

namespace {

// The distance between the nodes at which a level's light is gathered, over its blending radius. A cubic errs as the
// fourth power of that distance.
constexpr float kShareOfRadius = 0.125f, kErrorOfShare = 0.02f;

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

// Coarse nodes around one brick of the fine lattice: it reaches from the first node's to beyond the last one's. Second
// differences want one more to either side.
constexpr int kParents = BrickLattice::kSize / 2 + 1, kWide = kParents + 2;
constexpr std::size_t kBox = std::size_t{kWide} * kWide * kWide;

// Where a correction is larger than this part of the value that it corrects, the light changes by a factor from node to
// node, and a cubic would swing.
constexpr float kMostCorrected = 0.5f;

// One channel at the parents of a brick's nodes.
class Parents {
public:
    // `gathered`: per coarse node, 1 where light was gathered.
    Parents(const BrickLattice& lattice, std::span<const float> gathered, const ivec3& first) : lattice_(lattice) {
        low_ = (first >> 1) - 1;
        copy_box(lattice, gathered, 1, low_, ivec3(kWide), gathered_);
    }

    void load(std::span<const float> values) {
        copy_box(lattice_, values, 1, low_, ivec3(kWide), value_);
        for (int a = 0; a < 3; ++a)
            for (std::size_t i = kStride[a]; i + kStride[a] < kBox; ++i) {
                const bool known = gathered_[i - kStride[a]] * gathered_[i] * gathered_[i + kStride[a]] != 0.0f;
                second_[a][i] = known ? value_[i - kStride[a]] + value_[i + kStride[a]] - 2.0f * value_[i] : 0.0f;
            }
    }

    // At node `p` of the brick: the cubic through four parents along each axis on which it lies between two, as far as
    // terms of fourth order; the straight line where one of the four is missing.
    float between(const ivec3& p) const {
        const float linear = mean(value_, p);
        float second = 0.0f;
        for (int a = 0; a < 3; ++a)
            if (p[a] & 1)
                second += mean(second_[a], p);
        const float most = kMostCorrected * std::abs(linear);
        return linear - std::clamp(0.125f * second, -most, most);
    }

private:
    using Values = std::array<float, kBox>;
    static constexpr std::size_t kStride[3] = {kWide * kWide, kWide, 1};

    // Of the parents between which the node lies.
    static float mean(const Values& box, const ivec3& p) {
        const ivec3 low = (p >> 1) + 1, high = ((p + 1) >> 1) + 1;
        const auto along_z = [&](int x, int y) {
            const float* row = &box[std::size_t(x * kWide + y) * kWide];
            return 0.5f * (row[low.z] + row[high.z]);
        };
        const auto along_y = [&](int x) { return 0.5f * (along_z(x, low.y) + along_z(x, high.y)); };
        return 0.5f * (along_y(low.x) + along_y(high.x));
    }

    const BrickLattice& lattice_;
    ivec3 low_;
    Values gathered_, value_;
    std::array<Values, 3> second_{};
};

}  // namespace

NodeReceivers node_receivers(const Medium& medium, const LatticeRequest& request) {
    NodeReceivers out{medium.lattice, *request.needed, {}, {}};
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

int coarsening_of(const LightField& field, const GridLevel& level) {
    // Without maps nothing is smoothed. Light of the finest level comes from within a voxel. Behind surfaces light ends
    // at once.
    if (field.settings.shadows != ShadowMethod::Maps || level.level == field.bottom || field.occluders)
        return 0;
    const float share = kShareOfRadius * std::sqrt(field.settings.error / kErrorOfShare);
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
    const auto source = values.planes();
    const auto sum = out.planes();
    const std::vector<float> gathered(from.needed.begin(), from.needed.end());
    parallel_for(
        to.lattice.brick_count(),
        [&](std::size_t b) {
            const auto needed = to.needed.begin() + std::ptrdiff_t(b * BrickLattice::kNodes);
            if (std::none_of(needed, needed + BrickLattice::kNodes, [](std::uint8_t n) { return n != 0; }))
                return;
            Parents parents(from.lattice, gathered, to.lattice.first_node(b));
            for (std::size_t c = 0; c < source.size(); ++c) {
                parents.load(source[c]);
                float* const node = &sum[c][b * BrickLattice::kNodes];
                for (int k = 0; k < BrickLattice::kNodes; ++k)
                    if (needed[k])
                        node[k] += parents.between(BrickLattice::node_in_brick(k));
            }
        },
        16);
}

}  // namespace brisance
