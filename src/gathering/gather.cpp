#include "gathering/gather.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "gathering/far_kernels.h"
#include "medium/lattice/local_bounds.h"
#include "medium/phase.h"
#include "shadows/shadow_maps.h"

namespace brisance {

namespace {

constexpr std::size_t kLeastBatch = 2048;  // lights with maps at once; resolution is reduced rather than fewer lights
constexpr float kNearestOfBalls = 0.25f;  // first distance of the maps of the finest level's lights, over their spacing

// Distance from any light of the level to the farthest corner of the medium. Nothing attenuates light beyond it.
float farthest_distance(const GridLevel& level, const Medium& medium) {
    Box lights;
    for (const vec3& p : level.position)
        lights.add(p);
    const LocalBounds corners = local_bounds(medium);
    const vec3 far = glm::max(glm::abs(lights.high - corners.low), glm::abs(corners.high - lights.low));
    return glm::length(far);
}

ShadowMapLayout layout_of(const LightField& field, const GridLevel& level, bool top) {
    ShadowMapLayout layout;
    // A coarser light's map covers more voxels but its own size blurs its shadows: resolution grows as the square root
    // of the spacing (more gained less than the hierarchy's own error on real smoke), to even numbers.
    const float growth = std::sqrt(float(1 << std::min(level.level - 1, 6)));
    layout.resolution =
        std::min(128, 2 * static_cast<int>(std::lround(0.5f * growth * field.settings.shadow_resolution)));
    layout.distances = field.settings.shadow_distances;
    const float radius = field.alpha * level.spacing;
    layout.near_distance = level.level == field.bottom ? kNearestOfBalls * level.spacing : 0.5f * radius;
    layout.far_distance = 2.0f * radius;
    layout.for_outside = field.escape != nullptr;
    layout.range = layout.for_outside ? 1.0f / FootprintPicker::kLeastShare : 1.0f;
    if (top) {
        const float far = std::max(layout.far_distance, farthest_distance(level, field.pyramid->medium()));
        layout.distances = std::min(64, static_cast<int>(std::ceil(layout.distances * far / layout.far_distance)));
        layout.far_distance = far;
    }
    if (!field.intensity) {  // lights outside of the medium
        layout.geometric = true;
        const float range = layout.far_distance - layout.near_distance;
        layout.distances = std::max(layout.distances, std::min(256, 1 + int(range / field.pyramid->medium().spacing)));
    }
    return layout;
}

// Lowers the resolution, then the number of distances, until at least kLeastBatch lights (or all) fit the memory limit.
void fit_to_memory(ShadowMapLayout& layout, std::size_t lights, std::uint64_t limit, int level, Progress& progress) {
    const ShadowMapLayout wish = layout;
    const auto too_large = [&] { return layout.bytes_per_light() * std::min(lights, kLeastBatch) > limit; };
    while (too_large() && layout.resolution > 4)
        layout.resolution /= 2;
    while (too_large() && layout.distances > 2)
        layout.distances = std::max(2, layout.distances / 2);
    if (layout.resolution != wish.resolution || layout.distances != wish.distances)
        progress.notice("shadow maps of level " + std::to_string(level) + " lowered from " +
                        std::to_string(wish.resolution) + "^2 x " + std::to_string(wish.distances) + " to " +
                        std::to_string(layout.resolution) + "^2 x " + std::to_string(layout.distances) +
                        " to stay within the memory limit of " + std::to_string(limit >> 20) + " MiB");
}

// Lights of the level that may reach a block, as ascending indices.
void interaction_list(const LightField& field, const GridLevel& level, bool top, const Box& bounds,
                      std::vector<std::uint32_t>& list) {
    list.clear();
    if (top) {
        for (std::uint32_t i = 0; i < level.size(); ++i)
            list.push_back(i);
        return;
    }
    const Medium& medium = field.pyramid->medium();
    const float range = 2.0f * field.alpha * level.spacing;
    const mat3 rows = glm::transpose(medium.index_from_local);
    vec3 low(1e30f), high(-1e30f);
    for (int k = 0; k < 8; ++k) {
        const vec3 corner(k & 1 ? bounds.high.x : bounds.low.x, k & 2 ? bounds.high.y : bounds.low.y,
                          k & 4 ? bounds.high.z : bounds.low.z);
        const vec3 p = medium.index_from_local * corner;
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const vec3 reach(range * glm::length(rows[0]), range * glm::length(rows[1]), range * glm::length(rows[2]));
    const float scale = 1.0f / float(1 << level.level);
    const ivec3 reference = medium.reference_node >> level.level;
    level.find_in_box(ivec3(glm::floor((low - reach) * scale)) + reference - 1,
                      ivec3(glm::ceil((high + reach) * scale)) + reference + 1, list);
}

class FarGather {
public:
    FarGather(const LightField& field, const Receivers& receivers, float mean_cosine, Gathered& out, Progress& progress,
              ReceiverKind kind = ReceiverKind::Medium)
        : field_(field), receivers_(receivers), mean_cosine_(mean_cosine), kind_(kind), out_(out), progress_(progress) {
        fine_ = field.pyramid->view(0);
    }

    LevelCost run(const GridLevel& level, bool top) {
        LevelCost cost;
        cost.level = level.level;
        cost.lights = level.size();
        if (level.size() == 0 || receivers_.size() == 0)
            return cost;
        const bool maps = has_maps(level);
        ShadowMapLayout layout;
        std::size_t batch = level.size();
        if (maps) {
            layout = layout_of(field_, level, top);
            fit_to_memory(layout, level.size(), field_.settings.memory_limit_bytes, level.level, progress_);
            batch = std::clamp<std::size_t>(field_.settings.memory_limit_bytes / layout.bytes_per_light(),
                                            std::min(kLeastBatch, level.size()), level.size());
            cost.resolution = layout.resolution;
            cost.distances = layout.distances;
            cost.map_bytes = layout.bytes_per_light() * level.size();
            cost.held_bytes = layout.bytes_per_light() * batch;
        }
        const bool keep = maps && field_.cache && batch == level.size();
        if (keep)
            field_.cache->levels.resize(std::max<std::size_t>(field_.cache->levels.size(), level.level + 1));
        ShadowMapCache::Level own;
        ShadowMapCache::Level& made = keep ? field_.cache->levels[level.level] : own;
        const bool on_demand = keep && field_.cache->on_demand;
        for (std::size_t first = 0; first < level.size(); first += batch) {
            const std::size_t count = std::min(batch, level.size() - first);
            const FarLights lights = far_lights(level, top, layout, first);
            Stopwatch watch;
            if (on_demand)
                make_needed_maps(level, lights, made);
            else if (maps && !(keep && !made.maps.empty()))
                build_shadow_maps(*field_.pyramid, level, *field_.weight, field_.escape, layout, first, count,
                                  made.maps, field_.occluders);
            cost.map_seconds += watch.seconds();
            watch = Stopwatch();
            cost.evaluations += gather_batch(level, lights, count, made);
            cost.gather_seconds += watch.seconds();
            progress_.fraction(double(first + count) / level.size());
        }
        if (on_demand)
            cost.map_bytes = cost.held_bytes = made.maps.size() * sizeof(std::uint16_t);
        return cost;
    }

private:
    FarLights far_lights(const GridLevel& level, bool top, const ShadowMapLayout& layout, std::size_t first) const {
        FarLights lights{};
        lights.position = level.position.data();
        lights.intensity = level.intensity.data();
        lights.directional = level.directional.empty() ? nullptr : level.directional.data();
        lights.radius = field_.alpha * level.spacing;
        lights.bottom = level.level == field_.bottom;
        lights.top = top;
        lights.ball = std::cbrt(3.0f / (4.0f * kPi)) * field_.pyramid->medium().spacing * float(1 << level.level);
        lights.shadow = field_.settings.shadows == ShadowMethod::None ? FarLights::Shadow::None
                        : has_maps(level)                             ? FarLights::Shadow::Maps
                                                                      : FarLights::Shadow::Exact;
        lights.list_base = static_cast<std::uint32_t>(first);
        lights.layout = layout;
        lights.extinction = &fine_;
        lights.index_from_local = field_.pyramid->medium().index_from_local;
        lights.step_nodes = 0.5f;
        return lights;
    }

    bool has_maps(const GridLevel& level) const {
        return field_.settings.shadows == ShadowMethod::Maps && level.level > 0;
    }

    // Adds to `made` the missing maps of all lights that may reach some receiver.
    void make_needed_maps(const GridLevel& level, const FarLights& lights, ShadowMapCache::Level& made) {
        made.map_of.resize(level.size(), FarLights::kNoMap);
        std::vector<std::uint8_t> used(level.size(), 0);
        parallel_for(receivers_.blocks().size(), [&](std::size_t b) {
            thread_local std::vector<std::uint32_t> near;
            const ReceiverBlock& block = receivers_.blocks()[b];
            interaction_list(field_, level, lights.top, block.bounds, near);
            for (const std::uint32_t i : near) {
                std::atomic_ref<std::uint8_t> mark(used[i]);
                if (made.map_of[i] == FarLights::kNoMap && mark.load(std::memory_order_relaxed) == 0 &&
                    may_reach(lights, i, receivers_, block))
                    mark.store(1, std::memory_order_relaxed);
            }
        });
        std::vector<std::uint32_t> list;
        const std::size_t stride = lights.layout.stride(), before = made.maps.size();
        for (std::uint32_t i = 0; i < used.size(); ++i)
            if (used[i]) {
                made.map_of[i] = static_cast<std::uint32_t>(before / stride + list.size());
                list.push_back(i);
            }
        made.maps.resize(before + list.size() * stride);
        build_shadow_maps(*field_.pyramid, level, *field_.weight, field_.escape, lights.layout, list,
                          made.maps.data() + before, field_.occluders);
    }

    std::uint64_t gather_batch(const GridLevel& level, const FarLights& all, std::size_t count,
                               const ShadowMapCache::Level& made) {
        std::vector<std::uint64_t> evaluations(receivers_.blocks().size(), 0);
        parallel_for(receivers_.blocks().size(), [&](std::size_t b) {
            thread_local std::vector<std::uint32_t> list;
            const ReceiverBlock& block = receivers_.blocks()[b];
            interaction_list(field_, level, all.top, block.bounds, list);
            std::erase_if(list, [&](std::uint32_t i) { return i < all.list_base || i >= all.list_base + count; });
            FarLights lights = all;
            lights.list = list;
            lights.maps = made.maps.data();
            lights.map_of = made.map_of.empty() ? nullptr : made.map_of.data();
            const FarOutput output{receivers_.size(),
                                   out_.fluence.data(),
                                   out_.scattered.empty() ? nullptr : out_.scattered.data(),
                                   out_.moments.empty() ? nullptr : out_.moments.data(),
                                   mean_cosine_,
                                   kind_};
            evaluations[b] = gather_far(lights, receivers_, block, output);
        });
        std::uint64_t sum = 0;
        for (std::uint64_t e : evaluations)
            sum += e;
        return sum;
    }

    const LightField& field_;
    const Receivers& receivers_;
    float mean_cosine_;
    ReceiverKind kind_;
    Gathered& out_;
    Progress& progress_;
    PackedExtinction fine_;
};

// The needed nodes of every brick as one block, in sub-blocks of 4 x 2 x 2 so that groups of 16 are compact.
Receivers node_receivers(const Medium& medium, const LatticeRequest& request, std::vector<std::uint32_t>& node_of) {
    Receivers receivers;
    std::vector<vec3> points, directions;
    for (std::size_t b = 0; b < medium.lattice.brick_count(); ++b) {
        points.clear();
        directions.clear();
        const std::size_t first = node_of.size();
        for (int k = 0; k < BrickLattice::kNodes; ++k) {
            const int sub = k >> 4, in = k & 15;
            const ivec3 p((sub >> 4) * 4 + (in >> 2), (sub >> 2 & 3) * 2 + (in >> 1 & 1), (sub & 3) * 2 + (in & 1));
            const std::size_t node = b * BrickLattice::kNodes + BrickLattice::offset_in_brick(p);
            if (!(*request.needed)[node])
                continue;
            points.push_back(medium.local_of_node(medium.lattice.first_node(b) + p));
            if (request.toward_camera)
                directions.push_back((*request.toward_camera)[node]);
            node_of.push_back(static_cast<std::uint32_t>(node));
        }
        receivers.add_block(points, directions);
        while (node_of.size() > first && node_of.size() < receivers.size())
            node_of.push_back(node_of.back());
    }
    return receivers;
}

void gather_upper_levels(const LightField& field, FarGather& far, std::vector<LevelCost>& costs) {
    const auto& levels = field.grid->levels;
    for (std::size_t l = 0; l < levels.size(); ++l)
        costs.push_back(far.run(levels[l], l + 1 == levels.size()));
}

// Adds the contributions of all levels of the grid to the requested nodes.
void gather_grid(const LightField& field, const LatticeRequest& request, Gathered& out, std::vector<LevelCost>& costs,
                 Progress& progress) {
    const std::size_t nodes = field.pyramid->medium().lattice.node_count();
    std::vector<std::uint32_t> node_of;
    const Receivers receivers = node_receivers(field.pyramid->medium(), request, node_of);
    Gathered far;
    far.resize(receivers.size(), request.toward_camera != nullptr, request.moments);
    FarGather gather(field, receivers, request.mean_cosine, far, progress);
    gather_upper_levels(field, gather, costs);
    const auto add = [&](const std::vector<float>& from, std::vector<float>& to, int channels) {
        parallel_for(from.empty() ? 0 : channels, [&](std::size_t c) {
            std::uint32_t last = ~0u;
            for (std::size_t i = 0; i < node_of.size(); ++i) {
                if (node_of[i] != last)  // padding repeats a block's last node
                    to[c * nodes + node_of[i]] += from[c * node_of.size() + i];
                last = node_of[i];
            }
        });
    };
    add(far.fluence, out.fluence, 3);
    add(far.scattered, out.scattered, 3);
    add(far.moments, out.moments, 24);
}

}  // namespace

GridLevel bottom_level(const LightField& field) {
    const Medium& medium = field.pyramid->medium();
    GridLevel level;
    level.spacing = medium.spacing;
    std::vector<std::pair<ivec3, std::size_t>> lit;
    for (std::size_t i = 0; i < field.intensity->size(); ++i)
        if ((*field.intensity)[i] != Rgb(0.0f))
            lit.emplace_back(medium.lattice.node(i), i);
    std::sort(lit.begin(), lit.end(), [](const auto& a, const auto& b) {
        return std::tie(a.first.x, a.first.y, a.first.z) < std::tie(b.first.x, b.first.y, b.first.z);
    });
    for (const auto& [vertex, i] : lit) {
        level.vertex.push_back(vertex);
        level.position.push_back(medium.local_of_node(vertex));
        level.intensity.push_back((*field.intensity)[i]);
        if (field.directional)
            level.directional.insert(level.directional.end(), field.directional->begin() + i * 24,
                                     field.directional->begin() + (i + 1) * 24);
    }
    level.index_rows();
    return level;
}

Gathered gather_at_nodes(const LightField& field, const LatticeRequest& request, std::vector<LevelCost>& costs,
                         Progress& progress) {
    const Medium& medium = field.pyramid->medium();
    const std::size_t nodes = medium.lattice.node_count();
    Gathered out;
    out.resize(nodes, request.toward_camera != nullptr, request.moments);

    const Stopwatch watch;
    const NearField near(medium.local_from_index, field.alpha * medium.spacing,
                         field.settings.shadows != ShadowMethod::None);
    near.gather({&medium.lattice, &medium.extinction, field.intensity, field.directional, request.toward_camera,
                 request.mean_cosine},
                out);
    LevelCost bottom;
    bottom.lights =
        std::count_if(field.intensity->begin(), field.intensity->end(), [](const Rgb& i) { return i != Rgb(0.0f); });
    bottom.gather_seconds = watch.seconds();
    bottom.evaluations = near.separations() * nodes;
    costs.push_back(bottom);
    gather_grid(field, request, out, costs, progress);
    return out;
}

Gathered gather_from_outside(const LightField& field, const LatticeRequest& request, std::vector<LevelCost>& costs,
                             Progress& progress) {
    Gathered out;
    out.resize(field.pyramid->medium().lattice.node_count(), request.toward_camera != nullptr, request.moments);
    gather_grid(field, request, out, costs, progress);
    return out;
}

Gathered gather_at_points(const LightField& field, const GridLevel& bottom, const Receivers& receivers,
                          float mean_cosine, std::vector<LevelCost>& costs, Progress& progress, ReceiverKind kind,
                          bool moments) {
    Gathered out;
    out.resize(receivers.size(), !receivers.out_x.empty(), moments);
    FarGather gather(field, receivers, mean_cosine, out, progress, kind);
    if (field.bottom == 0)
        costs.push_back(gather.run(bottom, false));
    gather_upper_levels(field, gather, costs);
    return out;
}

}  // namespace brisance
