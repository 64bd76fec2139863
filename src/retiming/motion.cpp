#include "retiming/motion.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "retiming/common_lattice.h"
#include "retiming/sparse_field.h"

namespace brisance {
namespace {

constexpr int kLayers = 24;  // as far as the bricks around the smoke reach, corners included

BrickLattice with_neighbours(const BrickLattice& lattice) {
    std::vector<ivec3> bricks;
    bricks.reserve(lattice.brick_count() * 27);
    for (std::size_t b = 0; b < lattice.brick_count(); ++b)
        for (int k = 0; k < 27; ++k)
            bricks.push_back(lattice.brick(b) + ivec3(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1));
    return BrickLattice(std::move(bricks));
}

// The six nodes beside a node, or -1.
std::array<std::int64_t, 6> beside(const BrickLattice& lattice, std::size_t i) {
    constexpr std::array<int, 3> stride = {64, 8, 1};
    const ivec3 in = BrickLattice::node_in_brick(static_cast<int>(i % kNodesPerBrick));
    std::array<std::int64_t, 6> out;
    for (int n = 0; n < 6; ++n) {
        const int axis = n / 2, step = n % 2 == 0 ? -1 : 1;
        const int there = in[axis] + step;
        if (there >= 0 && there < BrickLattice::kSize) {
            out[n] = static_cast<std::int64_t>(i) + step * stride[axis];
            continue;
        }
        ivec3 node = lattice.node(i);
        node[axis] += step;
        out[n] = lattice.find_node(node);
    }
    return out;
}

// Gives a layer of unknown nodes the mean of their known neighbours. Returns those that are still unknown.
std::vector<std::size_t> extend_once(const BrickLattice& lattice, const std::vector<std::size_t>& unknown,
                                     std::vector<vec3>& velocity, std::vector<std::uint8_t>& known) {
    std::vector<vec3> mean(unknown.size());
    std::vector<std::uint8_t> found(unknown.size());
    parallel_for(
        unknown.size(),
        [&](std::size_t u) {
            vec3 sum(0.0f);
            int count = 0;
            for (const std::int64_t n : beside(lattice, unknown[u]))
                if (n >= 0 && known[static_cast<std::size_t>(n)]) {
                    sum += velocity[static_cast<std::size_t>(n)];
                    ++count;
                }
            found[u] = count > 0;
            mean[u] = count > 0 ? sum / static_cast<float>(count) : vec3(0.0f);
        },
        1024);
    std::vector<std::size_t> left;
    for (std::size_t u = 0; u < unknown.size(); ++u) {
        if (!found[u]) {
            left.push_back(unknown[u]);
            continue;
        }
        velocity[unknown[u]] = mean[u];
        known[unknown[u]] = 1;
    }
    return left;
}

void extend(const BrickLattice& lattice, std::vector<vec3>& velocity, std::vector<std::uint8_t>& known) {
    std::vector<std::size_t> unknown;
    for (std::size_t i = 0; i < known.size(); ++i)
        if (!known[i])
            unknown.push_back(i);
    for (int layer = 0; layer < kLayers && !unknown.empty(); ++layer) {
        const std::size_t before = unknown.size();
        unknown = extend_once(lattice, unknown, velocity, known);
        if (unknown.size() == before)
            return;
    }
}

// Velocity of one frame at all nodes of `lattice`, in voxels over the way between the frames.
std::vector<vec3> velocity_on(const BrickLattice& lattice, const MovingFrame& frame, const BrickLattice& smoke,
                              const dmat4& world_from_index, const dmat3& voxels_of) {
    std::vector<vec3> velocity(lattice.node_count(), vec3(0.0f));
    std::vector<std::uint8_t> known(lattice.node_count(), 0);
    const BlockGrid grid = on_lattice(frame.velocity.grid, world_from_index);
    const std::vector<float> values = values_on(lattice, grid.empty() ? nullptr : &grid, 3);
    for (std::size_t i = 0; i < velocity.size(); ++i) {
        const vec3 v(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
        known[i] = v != vec3(0.0f);
        velocity[i] = vec3(voxels_of * dvec3(v));
    }
    for (std::size_t i = 0; i < frame.smoke.size(); ++i)
        if (frame.smoke[i])
            known[static_cast<std::size_t>(lattice.find_node(smoke.node(i)))] = 1;
    extend(lattice, velocity, known);
    return velocity;
}

}  // namespace

dvec3 Motion::moved(dvec3 p, double from, double to, double scale) const {
    const double direction = to < from ? -1.0 : 1.0;
    double left = std::abs(to - from), at = from;
    const auto velocity = [&](const dvec3& q, double t) {
        const std::array<float, 6> both = sample<6>(cell_at(lattice, q), voxels.data());
        const dvec3 first(both[0], both[1], both[2]), second(both[3], both[4], both[5]);
        return scale * ((1.0 - t) * first + t * second);
    };
    while (left > 0.0) {
        const dvec3 here = velocity(p, at);
        double step = left, speed = glm::length(here);
        if (speed * step > 1.0)
            step = 1.0 / speed;
        const dvec3 middle = velocity(p + 0.5 * step * direction * here, at + 0.5 * step * direction);
        speed = glm::length(middle);
        if (speed * step > 1.0)
            step = 1.0 / speed;
        p += step * direction * middle;
        at += step * direction;
        left -= step;
    }
    return p;
}

Motion motion_between(const std::array<MovingFrame, 2>& frames, const BrickLattice& smoke,
                      const dmat4& world_from_index, const VelocitySettings& settings, int frame_count) {
    Motion motion;
    motion.lattice = with_neighbours(smoke);
    motion.voxels.resize(motion.lattice.node_count() * 6);
    for (std::size_t f = 0; f < 2; ++f) {
        const dmat4& world_from_velocity = frames[f].velocity.grid.info.world_from_index;
        const dmat3 voxels_of =
            static_cast<double>(frame_count) * voxels_per_frame(settings, world_from_velocity, world_from_index);
        const std::vector<vec3> velocity = velocity_on(motion.lattice, frames[f], smoke, world_from_index, voxels_of);
        for (std::size_t i = 0; i < velocity.size(); ++i)
            for (int c = 0; c < 3; ++c)
                motion.voxels[6 * i + 3 * f + c] = velocity[i][c];
    }
    return motion;
}

}  // namespace brisance
