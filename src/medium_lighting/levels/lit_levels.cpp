#include "medium_lighting/levels/lit_levels.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/voxel_size.h"
#include "medium_lighting/levels/coarse_lighting.h"
#include "optical_depths/point_depths.h"
#include "shadows/shadow_kernels.h"

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

// Raises `kept` to the lattice twice as coarse. A node counts in full as soon as one that is interpolated from it does.
void weigh_by_what_is_kept(const BrickLattice& fine, std::vector<float>& kept, LitLevel& level) {
    constexpr float kLeastShare = 1.0f / 64.0f;  // of a node in the mean around the coarser one
    BrickLattice lattice;
    std::vector<float> coarse;
    coarsen(fine, kept, 1, lattice, coarse);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        coarse[i] = std::min(1.0f, coarse[i] / kLeastShare);
        level.importance[i] *= coarse[i];
    }
    kept = std::move(coarse);
}

// Averages the emission to the lattice twice as coarse, and makes it the source functions of a level.
std::vector<float> coarser_emission(const BrickLattice& fine, std::vector<float>& emission,
                                    const std::vector<float>& extinction) {
    BrickLattice lattice;
    std::vector<float> coarse;
    coarsen(fine, emission, 1, lattice, coarse);
    emission = coarse;
    for (std::size_t i = 0; i < coarse.size(); ++i)
        coarse[i] = extinction[i] > 0.0f ? coarse[i] / extinction[i] : 0.0f;
    return coarse;
}

// Lines from an eye through points and on to the far end of a medium, in nodes from its reference.
class LinesOfSight {
public:
    LinesOfSight(const Medium& medium, const vec3& eye) : medium_(medium), eye_(medium.index_from_local * eye) {
        const ivec3 low = medium.lattice.min_brick() * BrickLattice::kSize - medium.reference_node;
        low_ = vec3(low - 1);
        high_ = vec3(low + medium.lattice.brick_extent() * BrickLattice::kSize);
    }

    // Part of the line through a node [nodes from the reference] that lies in the medium's box.
    void clip(const vec3& node, vec3& begin, vec3& end) const {
        const vec3 direction = node - eye_;
        float enter = 0.0f, leave = 1e30f;
        for (int a = 0; a < 3; ++a)
            if (direction[a] != 0.0f) {
                const float one = (low_[a] - eye_[a]) / direction[a], other = (high_[a] - eye_[a]) / direction[a];
                enter = std::max(enter, std::min(one, other));
                leave = std::min(leave, std::max(one, other));
            }
        leave = leave < 1e30f ? std::max(enter, leave) : enter;  // the eye itself has no line through it
        begin = eye_ + enter * direction;
        end = eye_ + leave * direction;
    }
    float metres(const vec3& begin, const vec3& end) const {
        return glm::length(medium_.local_from_index * (end - begin));
    }

private:
    const Medium& medium_;
    vec3 eye_, low_, high_;
};

}  // namespace

std::vector<float> radiance_through_nodes(const LitLevel& level, const std::vector<float>& scattered, const vec3& eye) {
    constexpr std::size_t kRun = 256;
    const Medium& medium = level.medium;
    std::vector<float> source = scattered;
    for (std::size_t i = 0; i < level.emitted.size(); ++i)
        source[i] += level.emitted[i];
    const PackedField packed(medium.lattice, source, medium.reference_node);
    const PackedExtinction extinction = level.pyramid->view(0), sources = packed.view();
    const LinesOfSight lines(medium, eye);
    std::vector<std::uint32_t> nodes;
    for (std::size_t i = 0; i < level.needed.size(); ++i)
        if (level.needed[i])
            nodes.push_back(static_cast<std::uint32_t>(i));
    std::vector<float> radiance(level.needed.size(), 0.0f);
    parallel_for((nodes.size() + kRun - 1) / kRun, [&](std::size_t run) {
        std::array<std::array<float, kRun>, 8> planes{};  // begin, end, length, result
        const std::size_t first = run * kRun, count = std::min(kRun, nodes.size() - first);
        for (std::size_t k = 0; k < count; ++k) {
            vec3 begin, end;
            lines.clip(vec3(medium.lattice.node(nodes[first + k]) - medium.reference_node), begin, end);
            for (int a = 0; a < 3; ++a)
                planes[a][k] = begin[a], planes[3 + a][k] = end[a];
            planes[6][k] = lines.metres(begin, end);
        }
        const Segments segments{{planes[0].data(), planes[1].data(), planes[2].data()},
                                {planes[3].data(), planes[4].data(), planes[5].data()},
                                planes[6].data(),
                                kRun};
        segment_collisions(extinction, sources, segments, 1.0f, planes[7].data());
        for (std::size_t k = 0; k < count; ++k)
            radiance[nodes[first + k]] = planes[7][k];
    });
    return radiance;
}

std::vector<LitLevel> make_lit_levels(const ExtinctionPyramid& pyramid, const std::vector<std::uint8_t>& needed,
                                      const std::vector<float>& kept, const LightingCamera& camera, int count) {
    std::vector<LitLevel> levels;
    const PointDepths depths(pyramid, kCameraRayLevel);
    const bool emits = pyramid.medium().emits();
    std::vector<float> emission = emits ? emission_luminance(pyramid.medium()) : std::vector<float>{};
    std::vector<float> kept_above = kept;
    for (int l = 1; l <= std::min(count, pyramid.level_count() - 1); ++l) {
        LitLevel level;
        level.level = l;
        level.medium = coarse_medium(pyramid, l);
        BrickLattice lattice;  // that of the coarse medium
        level.needed = parents(pyramid.lattice(l - 1), l == 1 ? needed : levels.back().needed, lattice);
        assert(level.needed.size() == level.medium.lattice.node_count());
        weigh_by_camera(level, depths, camera);
        if (!kept.empty())
            weigh_by_what_is_kept(pyramid.lattice(l - 1), kept_above, level);
        if (emits)
            level.emitted = coarser_emission(pyramid.lattice(l - 1), emission, level.medium.extinction);
        levels.push_back(std::move(level));
    }
    for (LitLevel& level : levels) {
        level.pyramid = std::make_unique<ExtinctionPyramid>(level.medium, ExtinctionPyramid::kMaxLevels);
        level.pyramid->set_occluders(pyramid.occluders());
    }
    return levels;
}

}  // namespace brisance
