#include <algorithm>

#include "core/parallel.h"
#include "retiming/group_motion.h"
#include "retiming/sparse_field.h"

namespace brisance {
namespace {

// One of both frames on its way to the time between them.
struct Side {
    int frame = 0;
    std::vector<std::uint8_t> bricks;  // of the group's, whether this frame has anything there
    std::vector<vec3> there;           // where nodes of those bricks move to, relative to themselves
    std::vector<vec3> from;            // where nodes of the result come from, relative to themselves
};

std::vector<std::uint8_t> occupied_bricks(const std::vector<std::uint8_t>& nodes) {
    std::vector<std::uint8_t> bricks(nodes.size() / kNodesPerBrick, 0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        bricks[i / kNodesPerBrick] |= nodes[i];
    return bricks;
}

// Bricks that hold a node beside a place to which something moves.
void add_destinations(const BrickLattice& lattice, const std::vector<std::uint8_t>& occupied, const Side& side,
                      std::vector<ivec3>& bricks) {
    std::vector<std::vector<ivec3>> reached(lattice.brick_count());
    parallel_for(lattice.brick_count(), [&](std::size_t b) {
        if (!side.bricks[b])
            return;
        for (std::size_t i = b * kNodesPerBrick; i < (b + 1) * kNodesPerBrick; ++i) {
            if (!occupied[i])
                continue;
            const ivec3 low(glm::floor(dvec3(lattice.node(i)) + dvec3(side.there[i])));
            for (int k = 0; k < 8; ++k) {
                const ivec3 brick = (low + ivec3(k & 4 ? 2 : -1, k & 2 ? 2 : -1, k & 1 ? 2 : -1)) >> 3;
                if (std::find(reached[b].begin(), reached[b].end(), brick) == reached[b].end())
                    reached[b].push_back(brick);
            }
        }
    });
    for (const std::vector<ivec3>& some : reached)
        bricks.insert(bricks.end(), some.begin(), some.end());
}

Cell cell_from(const BrickLattice& of, const BrickLattice& in, std::size_t i, const vec3& offset) {
    return cell_at(of, dvec3(in.node(i)) + dvec3(offset));
}

template <class Body>
void for_nodes(const BrickLattice& lattice, const Body& body) {
    parallel_for(lattice.brick_count(), [&](std::size_t b) {
        for (std::size_t i = b * kNodesPerBrick; i < (b + 1) * kNodesPerBrick; ++i)
            body(i);
    });
}

// One channel of one frame, moved.
class MovedChannel {
public:
    MovedChannel(const FieldGroup& group, const BrickLattice& result, const Side& side, const FieldPair& field,
                 int channel)
        : group_(group), result_(result), side_(side), values_(group.lattice.node_count()) {
        const std::vector<float>& all = field.values[side.frame];
        for (std::size_t i = 0; i < values_.size(); ++i)
            values_[i] = all[i * field.channels + channel];
    }

    std::vector<float> moved() const {
        std::vector<float> first(result_.node_count());
        for_nodes(result_, [&](std::size_t i) { first[i] = sample_channel(cell(i), values_.data(), 1, 0); });
        const std::vector<float> lost = half_of_what_is_lost(first);
        for_nodes(result_, [&](std::size_t i) {
            const Cell from = cell(i);
            float low = from.node[0] < 0 ? 0.0f : values_[from.node[0]], high = low;
            for (const std::int64_t node : from.node) {
                const float value = node < 0 ? 0.0f : values_[node];
                low = std::min(low, value);
                high = std::max(high, value);
            }
            first[i] = std::clamp(first[i] + sample_channel(from, lost.data(), 1, 0), low, high);
        });
        return first;
    }

private:
    Cell cell(std::size_t i) const { return cell_from(group_.lattice, result_, i, side_.from[i]); }

    std::vector<float> half_of_what_is_lost(const std::vector<float>& first) const {
        std::vector<float> lost(values_.size(), 0.0f);
        for_nodes(group_.lattice, [&](std::size_t i) {
            if (!side_.bricks[i / kNodesPerBrick])
                return;
            const Cell back = cell_from(result_, group_.lattice, i, side_.there[i]);
            lost[i] = 0.5f * (values_[i] - sample_channel(back, first.data(), 1, 0));
        });
        return lost;
    }

    const FieldGroup& group_;
    const BrickLattice& result_;
    const Side& side_;
    std::vector<float> values_;
};

Side make_side(const FieldGroup& group, const Motion& motion, int frame, double time, std::vector<ivec3>& bricks) {
    const std::vector<std::uint8_t> occupied = group.occupied(frame);
    Side side{frame, occupied_bricks(occupied), {}, {}};
    side.there = moved_nodes(group.lattice, side.bricks, motion, frame, time);
    add_destinations(group.lattice, occupied, side, bricks);
    return side;
}

void advect_group(const FieldGroup& group, const Motion& motion, double time, Fields& out) {
    std::vector<ivec3> bricks;
    std::array<Side, 2> sides = {make_side(group, motion, 0, time, bricks), make_side(group, motion, 1, time, bricks)};
    const BrickLattice result(std::move(bricks));
    for (Side& side : sides)
        side.from = moved_nodes(result, {}, motion, time, side.frame);
    for (const FieldPair& field : group.fields) {
        std::vector<float> values(result.node_count() * field.channels, 0.0f);
        for (int channel = 0; channel < field.channels; ++channel)
            for (const Side& side : sides) {
                const auto share = static_cast<float>(side.frame == 0 ? 1.0 - time : time);
                const std::vector<float> moved = MovedChannel(group, result, side, field, channel).moved();
                for (std::size_t i = 0; i < moved.size(); ++i)
                    values[i * field.channels + channel] += share * moved[i];
            }
        const auto address = [&](int f) { return field.grid[f] ? &*field.grid[f] : nullptr; };
        out[field.role] = grid_of(result, values, address(0), address(1));
    }
}

}  // namespace

Fields advected(const BetweenFrames& pair, const VelocitySettings& velocity) {
    const VelocityPair velocities = {&pair.first.velocity, &pair.second.velocity};
    Fields out(pair.first.fields.size());
    for (const FieldGroup& group : group_fields(pair.first, pair.second)) {
        check_speed(group, velocities, velocity, pair.frames, pair.where);
        advect_group(group, motion_of(group, velocities, velocity, pair.frames), pair.weight, out);
    }
    return out;
}

}  // namespace brisance
