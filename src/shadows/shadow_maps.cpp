#include "shadows/shadow_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "medium/phase.h"
#include "shadows/seen_texels.h"
#include "shadows/shadow_kernels.h"
#include "shadows/surface_shadows.h"

namespace brisance {

namespace {

// The smallest step worth taking [m]: the lattice's shortest edge, but no finer than a sixteenth of the mean spacing,
// so that a lattice of needles does not make marches endless.
float finest_step(const Medium& medium) {
    float edge = medium.spacing;
    for (int a = 0; a < 3; ++a)
        edge = std::min(edge, glm::length(medium.local_from_index[a]));
    return std::max(edge, medium.spacing / 16.0f);
}

// At the light, rays see density averaged over this share of the light's spacing. Wide averages save steps but lose the
// clumps of smoke in which fire burns: on real smoke half a spacing let 5 % too much light through, a sixteenth 1 %.
constexpr float kFilterShare = 0.0625f;

// Along a ray, averages narrower than this share of the distance between neighbouring texels' rays add nothing.
constexpr float kTexelShare = 0.5f;

// The pyramid level that strides sample. Its averages reach no farther than a homogeneous brick does.
constexpr int kStrideLevel = 2;

// Steps one averaged voxel long over [begin, end]; averages shrink to single voxels, or to the width of a texel, at the
// far end of the range.
void add_steps(const ExtinctionPyramid& pyramid, const GridLevel& level, const ShadowMapLayout& layout, float begin,
               float end, int store, std::vector<ShadowStep>& steps) {
    const float far = layout.far_distance, texel = std::sqrt(4.0f * kPi) / float(layout.resolution);
    const float voxel = finest_step(pyramid.medium());
    const int coarsest = std::max(0, std::min(level.level - 1, pyramid.level_count() - 1));
    while (begin < end) {
        const float width =
            std::max({voxel, kFilterShare * level.spacing * (1.0f - begin / far), kTexelShare * texel * begin});
        const int mip = std::clamp(static_cast<int>(std::log2(width / voxel)), 0, coarsest);
        const float wish = voxel * float(1 << mip);
        const float rest = end - begin;
        const float length = rest < 1.5f * wish ? rest : wish;
        steps.push_back({begin + 0.5f * length, length, mip, -1});
        begin = length == rest ? end : begin + length;
    }
    if (!steps.empty())
        steps.back().store = store;
}

// Of the rays of a light whose shadows begin at the distance `start` of its centre [m].
struct Steps {
    std::vector<ShadowStep> near, far;
    Steps() = default;
    Steps(const ExtinctionPyramid& pyramid, const GridLevel& level, const ShadowMapLayout& layout, float start) {
        add_steps(pyramid, level, layout, start, start + layout.near_distance, 0, near);
        for (int k = 1; k < layout.distances; ++k) {
            const auto at = [&](int i) {
                return start + glm::mix(layout.near_distance, layout.far_distance, float(i) / (layout.distances - 1));
            };
            add_steps(pyramid, level, layout, at(k - 1), at(k), k, far);
        }
    }
};

// Where rays of a light start: offsets from its centre [nodes] to kStarts of the voxels it represents, in a scattered
// order. The first 16 are repeated at the end for whole-vector loads.
struct Starts {
    std::array<std::vector<float>, 3> offset;
    std::vector<float> weight;
    bool picked = false;

    Starts() : weight(kStarts + 16, 1.0f) {
        for (auto& o : offset)
            o.assign(kStarts + 16, 0.0f);
    }
    void set(std::size_t k, const vec3& start, float w) {
        const std::size_t slot = k * 27 % kStarts;  // 27 is prime to kStarts
        for (int a = 0; a < 3; ++a)
            offset[a][slot] = start[a];
        weight[slot] = w;
        picked = true;
    }
    // Positions of the light's picked voxels, local [m].
    std::vector<vec3> positions(const Medium& medium, const vec3& centre) const {
        std::vector<vec3> out;
        for (std::size_t k = 0; k < (picked ? kStarts : 0); ++k)
            out.push_back(centre + medium.local_from_index * vec3(offset[0][k], offset[1][k], offset[2][k]));
        return out;
    }
    void repeat_first() {
        for (auto* list : {&offset[0], &offset[1], &offset[2], &weight})
            std::copy_n(list->begin(), 16, list->begin() + kStarts);
    }
};

void pick_starts(FootprintPicker& picker, const Medium& medium, const GridLevel& level, std::size_t light,
                 const NodeWeights* escape, Starts& starts) {
    const vec3 centre = medium.index_from_local * level.position[light];
    const auto from_centre = [&](const ivec3& node) { return vec3(node - medium.reference_node) - centre; };
    starts = Starts();
    if (escape) {
        const auto& picks = picker.pick(level.vertex[light], kStarts, *escape);
        for (std::size_t k = 0; k < picks.size(); ++k)
            starts.set(k, from_centre(picks[k].node), picks[k].weight);
    } else {
        const std::vector<ivec3>& picks = picker.pick(level.vertex[light], kStarts);
        for (std::size_t k = 0; k < picks.size(); ++k)
            starts.set(k, from_centre(picks[k]), 1.0f);
    }
    starts.repeat_first();
}

// Copies the interior of a map, where it is seen, and wraps its border: a step across an edge of the square continues
// on the same edge, mirrored about its middle.
void copy_with_border(const std::uint16_t* interior, const SeenTexels& seen, const ShadowMapLayout& layout,
                      std::uint16_t* map) {
    const int r = layout.resolution;
    for (int i = -1; i <= r; ++i)
        for (int j = -1; j <= r; ++j) {
            int u = i, v = j;
            if (u < 0 || u >= r) {
                u = std::clamp(u, 0, r - 1);
                v = r - 1 - v;
            }
            if (v < 0 || v >= r) {
                v = std::clamp(v, 0, r - 1);
                u = r - 1 - u;
            }
            const std::size_t texel = std::size_t(u) * r + v;
            if (seen.has(texel))
                std::copy_n(interior + texel * layout.distances, layout.distances,
                            map + (std::size_t(i + 1) * layout.side() + (j + 1)) * layout.distances);
        }
}

}  // namespace

ParallelRays::ParallelRays(const GridLevel& level) : escaping_(level.escaping) {
    double sum = 0.0, squares = 0.0;
    for (const float power : escaping_) {
        sum += power;
        squares += double(power) * power;
    }
    if (sum > 0.0)
        typical_ = squares / sum;
}

int ParallelRays::of(std::size_t light) const {
    if (!(typical_ > 0.0))
        return kSame;
    const double wish = kTypical * std::min(1.0, escaping_[light] / typical_);
    return std::clamp(static_cast<int>(std::lround(wish)), kLeast, kMostParallelRays);
}

void build_shadow_maps(const ExtinctionPyramid& pyramid, const GridLevel& level, const NodeWeights& weights,
                       const NodeWeights* escape, const ShadowMapLayout& layout, std::size_t first, std::size_t count,
                       LargeVector<std::uint16_t>& maps, const Occluders* occluders) {
    std::vector<std::uint32_t> list(count);
    std::iota(list.begin(), list.end(), static_cast<std::uint32_t>(first));
    maps.clear();  // nothing of them is kept, so that nothing is copied
    maps.resize(count * layout.stride());
    build_shadow_maps(pyramid, level, weights, escape, layout, list, maps.data(), occluders);
}

void build_shadow_maps(const ExtinctionPyramid& pyramid, const GridLevel& level, const NodeWeights& weights,
                       const NodeWeights* escape, const ShadowMapLayout& layout, std::span<const std::uint32_t> list,
                       std::uint16_t* maps, const Occluders* occluders) {
    const Medium& medium = pyramid.medium();
    const Steps from_centres(pyramid, level, layout, 0.0f);
    const TexelTable texels(layout.resolution);
    std::vector<PackedExtinction> mips;
    mips.reserve(std::size_t(pyramid.level_count()));
    for (int l = 0; l < pyramid.level_count(); ++l)
        mips.push_back(pyramid.view(l));
    const HomogeneousBricks* even = pyramid.homogeneous_bricks();
    const HomogeneousStrides strides{even ? even->view() : HomogeneousBricks::View{},
                                     std::min(kStrideLevel, pyramid.level_count() - 1)};
    const ParallelRays parallel(level);
    const bool by_bricks = !layout.for_outside && level.level >= FootprintPicker::kLevelOfWholeBricks;
    const BrickWeights bricks = by_bricks ? sum_over_bricks(medium, weights) : BrickWeights{};
    parallel_blocks(list.size(), 8, [&](std::size_t begin, std::size_t end) {
        SeenTexels seen(texels, medium, layout.distances, layout.for_outside);
        std::vector<std::uint16_t> interior(std::size_t(layout.resolution) * layout.resolution * layout.distances);
        Starts starts;
        FootprintPicker picker(medium, weights, level.level, by_bricks ? &bricks : nullptr);
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t light = list[k];
            pick_starts(picker, medium, level, light, layout.for_outside ? escape : nullptr, starts);
            seen.look_from(level.position[light]);
            const ShadowRays rays{{seen.direction(0), seen.direction(1), seen.direction(2)},
                                  {starts.offset[0].data(), starts.offset[1].data(), starts.offset[2].data()},
                                  starts.weight.data(),
                                  seen.rays(),
                                  parallel.of(light)};
            const vec3 centre = medium.index_from_local * level.position[light];
            const float surface = level.ball.empty() ? 0.0f : level.ball[light].radius;
            const Steps own = surface > 0.0f ? Steps(pyramid, level, layout, surface) : Steps();
            const Steps& steps = surface > 0.0f ? own : from_centres;
            if (layout.for_outside)
                march_parallel_rays(mips.data(), steps.near, steps.far, centre, rays, layout.distances,
                                    65535.0f / layout.range, seen.marched(), even ? &strides : nullptr);
            else
                march_shadow_rays(mips.data(), steps.near, steps.far, centre, rays, layout.distances, seen.marched());
            seen.put_in_rows(interior.data());
            if (occluders) {
                const vec3& position = level.position[light];
                const std::vector<vec3> voxels = starts.positions(medium, position);
                cut_at_surfaces(*occluders, {position, voxels.empty() ? level.parts_of(light) : voxels, surface},
                                layout, interior);
            }
            std::uint16_t* const map = maps + k * layout.stride();
            std::fill_n(map, layout.stride(), std::uint16_t{0});  // of texels that are not seen
            copy_with_border(interior.data(), seen, layout, map);
        }
    });
}

}  // namespace brisance
