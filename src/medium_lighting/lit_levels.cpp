#include "medium_lighting/lit_levels.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "gathering/point_depths.h"
#include "lighting_grid/voxel_lights.h"

namespace brisance {

namespace {

// Level of the pyramid that rays to the camera march.
constexpr int kCameraRayLevel = 2;

// From the needed nodes to the eye.
std::vector<float> depths_to_eye(const LitLevel& level, const PointDepths& depths, const vec3& eye) {
    std::vector<std::uint32_t> nodes;
    for (std::size_t i = 0; i < level.needed.size(); ++i)
        if (level.needed[i])
            nodes.push_back(static_cast<std::uint32_t>(i));
    std::vector<float> out(level.needed.size(), 0.0f);
    parallel_for((nodes.size() + PointDepths::kRays - 1) / PointDepths::kRays,
                 [&](std::size_t group) {
                     std::array<vec3, PointDepths::kRays> to;
                     std::array<float, PointDepths::kRays> depth;
                     const std::size_t first = group * PointDepths::kRays;
                     for (std::size_t k = 0; k < to.size(); ++k)
                         to[k] = level.medium.local_of_node(
                             level.medium.lattice.node(nodes[std::min(first + k, nodes.size() - 1)]));
                     depths.between(eye, to.data(), depth.data());
                     for (std::size_t k = 0; k < to.size() && first + k < nodes.size(); ++k)
                         out[nodes[first + k]] = depth[k];
                 },
                 64);
    return out;
}

// Length of a voxel's longest edge [m].
float longest_edge(const Medium& medium) {
    float longest = 0.0f;
    for (int a = 0; a < 3; ++a)
        longest = std::max(longest, glm::length(medium.local_from_index[a]));
    return longest;
}

// Mean extinction under each node's hat [1/m].
std::vector<float> extinction_under_hats(const Medium& medium) {
    const std::vector<Rgb> integral =
        project_extinction_times(medium, std::vector<Rgb>(medium.extinction.size(), Rgb(1.0f)));
    std::vector<float> mean(integral.size());
    std::transform(integral.begin(), integral.end(), mean.begin(),
                   [&](const Rgb& i) { return i.x / medium.voxel_volume; });
    return mean;
}

void weigh_by_camera(LitLevel& level, const PointDepths& depths, const LightingCamera& camera) {
    const std::vector<float> depth = depths_to_eye(level, depths, camera.eye);
    const float width = longest_edge(level.medium);
    // Light at a node beside the smoke is that of the smoke between it and the next.
    const std::vector<float> around = extinction_under_hats(level.medium);
    level.importance.assign(depth.size(), 0.0f);
    level.visible.assign(depth.size(), 0.0f);
    parallel_for(
        depth.size(),
        [&](std::size_t i) {
            if (!level.needed[i])
                return;
            const float own = around[i] * width;
            const float distance =
                std::max(glm::length(level.medium.local_of_node(level.medium.lattice.node(i)) - camera.eye), width);
            // A voxel is seen from its near side on.
            const float seen = std::exp(-std::max(0.0f, depth[i] - 0.5f * own)) * -std::expm1(-own);
            level.importance[i] = seen * std::min(1.0f, width / (distance * camera.pixel_angle));
            level.visible[i] = seen * (width / distance) * (width / distance);
        },
        4096);
}

}  // namespace

std::vector<LitLevel> make_lit_levels(const ExtinctionPyramid& pyramid, const std::vector<std::uint8_t>& needed,
                                      const LightingCamera& camera, int count) {
    std::vector<LitLevel> levels;
    const PointDepths depths(pyramid, kCameraRayLevel);
    for (int l = 1; l <= std::min(count, pyramid.level_count() - 1); ++l) {
        LitLevel level;
        level.level = l;
        level.medium = coarse_medium(pyramid, l);
        BrickLattice lattice;  // that of the coarse medium
        level.needed = parents(pyramid.lattice(l - 1), l == 1 ? needed : levels.back().needed, lattice);
        assert(level.needed.size() == level.medium.lattice.node_count());
        weigh_by_camera(level, depths, camera);
        levels.push_back(std::move(level));
    }
    for (LitLevel& level : levels) {
        level.pyramid = std::make_unique<ExtinctionPyramid>(level.medium, ExtinctionPyramid::kMaxLevels);
        level.pyramid->set_occluders(pyramid.occluders());
    }
    return levels;
}

}  // namespace brisance
