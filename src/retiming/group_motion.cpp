#include "retiming/group_motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"

namespace brisance {

namespace {

constexpr double kFarthest = 4.0;  // widths of the smoke: more than an explosion's first frames

}  // namespace

Motion motion_of(const FieldGroup& group, const VelocityPair& velocity, const VelocitySettings& settings, int frames) {
    // A frame without velocity, as the first of many simulations is, moves as the other.
    const int first = velocity[0]->empty() ? 1 : 0, second = velocity[1]->empty() ? 0 : 1;
    const std::array<MovingFrame, 2> moving = {
        {{*velocity[first], group.occupied(first)}, {*velocity[second], group.occupied(second)}}};
    return motion_between(moving, group.lattice, group.world_from_index, settings, frames);
}

void check_speed(const FieldGroup& group, const VelocityPair& velocity, const VelocitySettings& settings, int frames,
                 const std::string& where) {
    for (const CentredVelocity* v : velocity) {
        const dmat3 m = voxels_per_frame(settings, v->grid.info.world_from_index, group.world_from_index);
        const double size = std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
        const double voxels = frames * v->typical * size;
        const double width = glm::length(dvec3(group.lattice.brick_extent() * BrickLattice::kSize));
        if (voxels > kFarthest * width)
            throw Error(ExitCode::BadData,
                        fmt::format("{}: as velocity.unit and velocity.scale read its velocity, the smoke moves {:.3g} "
                                    "voxels between two frames, and is {:.0f} wide; set velocity.unit to auto, or a "
                                    "smaller velocity.scale",
                                    where, voxels, width));
    }
}

std::vector<vec3> moved_nodes(const BrickLattice& lattice, const std::vector<std::uint8_t>& wanted,
                              const Motion& motion, double from, double to) {
    std::vector<vec3> at(lattice.node_count(), vec3(0.0f));
    parallel_for(lattice.brick_count(), [&](std::size_t b) {
        if (!wanted.empty() && !wanted[b])
            return;
        for (std::size_t i = b * kNodesPerBrick; i < (b + 1) * kNodesPerBrick; ++i) {
            const dvec3 node(lattice.node(i));
            at[i] = vec3(motion.moved(node, from, to) - node);
        }
    });
    return at;
}

}  // namespace brisance
