#include "gathering/gather.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "gathering/far_kernels.h"
#include "gathering/map_layouts.h"
#include "gathering/node_receivers.h"
#include "medium/phase.h"
#include "shadows/shadow_maps.h"

namespace brisance {

namespace {

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

    // Gathers from the levels [first, last) of the field's grid.
    void run_levels(std::size_t first, std::size_t last, std::vector<LevelCost>& costs) {
        const auto& levels = field_.grid->levels;
        for (std::size_t l = first; l < last; ++l)
            costs.push_back(run(levels[l], l + 1 == levels.size()));
    }

    LevelCost run(const GridLevel& level, bool top) {
        LevelCost cost;
        cost.level = level.level;
        cost.lights = level.size();
        if (level.size() == 0 || receivers_.size() == 0)
            return cost;
        if (!has_maps(level)) {
            cost.evaluations = gather_batch(level, far_lights(level, top, {}), 0, level.size(), {}, cost);
            return cost;
        }
        ShadowMapLayout layout = map_layout(field_, level, top);
        fit_to_memory(layout, level.size(), memory_limit(), level.level, progress_);
        cost.resolution = layout.resolution;
        cost.distances = layout.distances;
        gather_with_maps(level, far_lights(level, top, layout), cost);
        return cost;
    }

private:
    std::uint64_t memory_limit() const { return field_.settings.memory_limit_bytes; }

    void gather_with_maps(const GridLevel& level, const FarLights& lights, LevelCost& cost) {
        ShadowMapCache::Level own;
        std::vector<std::uint8_t> resolution = map_resolutions(level, lights.layout, field_.importance);
        std::uint64_t bytes = 0;
        for (const std::uint8_t r : resolution)
            bytes += lights.layout.of_resolution(r).bytes_per_light();
        const bool on_demand = field_.cache && field_.cache->on_demand, keeps = field_.cache && bytes <= memory_limit();
        if (keeps)
            field_.cache->levels.resize(std::max<std::size_t>(field_.cache->levels.size(), level.level + 1));
        ShadowMapCache::Level& made = keeps ? field_.cache->levels[level.level] : own;
        if (made.map_at.empty()) {
            made.map_at.assign(level.size(), FarLights::kNoMap);
            made.resolution = std::move(resolution);
        }
        const Stopwatch watch;
        std::vector<std::uint32_t> missing;
        for (std::uint32_t i = 0; i < level.size(); ++i)
            if (made.map_at[i] == FarLights::kNoMap)
                missing.push_back(i);
        if (on_demand)
            missing = needed_lights(level, lights, missing);
        cost.map_seconds += watch.seconds();
        if (keeps) {
            make_maps(level, lights, missing, made, cost);
            cost.evaluations += gather_batch(level, lights, 0, level.size(), made, cost);
            cost.map_bytes = cost.held_bytes = made.maps.size() * sizeof(std::uint16_t);
        } else {
            gather_in_batches(level, lights, missing, made, cost);
        }
    }

    // Makes as many of the maps of the lights in `needed` at once as fit the memory limit, and keeps none.
    void gather_in_batches(const GridLevel& level, const FarLights& lights, std::span<const std::uint32_t> needed,
                           ShadowMapCache::Level& made, LevelCost& cost) {
        for (std::size_t begin = 0, end = 0; begin < needed.size(); begin = end) {
            std::uint64_t bytes = 0;
            do
                bytes += lights.layout.of_resolution(made.resolution[needed[end++]]).bytes_per_light();
            while (end < needed.size() && bytes < memory_limit());
            made.maps.clear();
            make_maps(level, lights, needed.subspan(begin, end - begin), made, cost);
            cost.map_bytes += bytes;
            cost.held_bytes = std::max(cost.held_bytes, bytes);
            const std::uint32_t first = needed[begin], count = needed[end - 1] - first + 1;
            cost.evaluations += gather_batch(level, lights, first, count, made, cost);
            progress_.fraction(double(end) / double(needed.size()));
        }
    }

    FarLights far_lights(const GridLevel& level, bool top, const ShadowMapLayout& layout) const {
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
        lights.layout = layout;
        lights.extinction = &fine_;
        lights.index_from_local = field_.pyramid->medium().index_from_local;
        lights.step_nodes = 0.5f;
        return lights;
    }

    bool has_maps(const GridLevel& level) const {
        return field_.settings.shadows == ShadowMethod::Maps && level.level > 0;
    }

    // Those of the lights in `among` that may reach some receiver. Indices ascend.
    std::vector<std::uint32_t> needed_lights(const GridLevel& level, const FarLights& lights,
                                             std::span<const std::uint32_t> among) {
        std::vector<std::uint8_t> asked(level.size(), 0), used(level.size(), 0);
        for (const std::uint32_t i : among)
            asked[i] = 1;
        parallel_for(receivers_.blocks().size(), [&](std::size_t b) {
            thread_local std::vector<std::uint32_t> near;
            const ReceiverBlock& block = receivers_.blocks()[b];
            interaction_list(field_, level, lights.top, block.bounds, near);
            for (const std::uint32_t i : near) {
                std::atomic_ref<std::uint8_t> mark(used[i]);
                if (asked[i] && mark.load(std::memory_order_relaxed) == 0 && may_reach(lights, i, receivers_, block))
                    mark.store(1, std::memory_order_relaxed);
            }
        });
        std::vector<std::uint32_t> list;
        for (const std::uint32_t i : among)
            if (used[i])
                list.push_back(i);
        return list;
    }

    // Adds the maps of the lights in `list`.
    void make_maps(const GridLevel& level, const FarLights& lights, std::span<const std::uint32_t> list,
                   ShadowMapCache::Level& made, LevelCost& cost) {
        const Stopwatch watch;
        std::size_t end = made.maps.size();
        for (const std::uint32_t i : list) {
            made.map_at[i] = end;
            end += lights.layout.of_resolution(made.resolution[i]).stride();
        }
        made.maps.resize(end);
        std::vector<WantedMap> wanted;
        wanted.reserve(list.size());
        for (const std::uint32_t i : list)
            wanted.push_back({i, made.resolution[i], made.maps.data() + made.map_at[i]});
        build_shadow_maps(*field_.pyramid, level, *field_.weight, field_.escape, lights.layout, wanted,
                          field_.occluders);
        cost.map_seconds += watch.seconds();
    }

    // Gathers from `count` lights of the level from `first` on.
    std::uint64_t gather_batch(const GridLevel& level, const FarLights& all, std::size_t first, std::size_t count,
                               const ShadowMapCache::Level& made, LevelCost& cost) {
        const Stopwatch watch;
        std::vector<std::uint64_t> evaluations(receivers_.blocks().size(), 0);
        parallel_for(receivers_.blocks().size(), [&](std::size_t b) {
            thread_local std::vector<std::uint32_t> list;
            const ReceiverBlock& block = receivers_.blocks()[b];
            interaction_list(field_, level, all.top, block.bounds, list);
            std::erase_if(list, [&](std::uint32_t i) { return i < first || i >= first + count; });
            FarLights lights = all;
            lights.list = list;
            lights.maps = made.maps.data();
            lights.map_at = made.map_at.empty() ? nullptr : made.map_at.data();
            lights.resolution_of = made.resolution.data();
            const FarOutput output{receivers_.size(),
                                   out_.fluence.data(),
                                   out_.scattered.empty() ? nullptr : out_.scattered.data(),
                                   out_.moments.empty() ? nullptr : out_.moments.data(),
                                   mean_cosine_,
                                   kind_};
            evaluations[b] = gather_far(lights, receivers_, block, output);
        });
        cost.gather_seconds += watch.seconds();
        return std::accumulate(evaluations.begin(), evaluations.end(), std::uint64_t{0});
    }

    const LightField& field_;
    const Receivers& receivers_;
    float mean_cosine_;
    ReceiverKind kind_;
    Gathered& out_;
    Progress& progress_;
    PackedExtinction fine_;
};

// Light of the levels from `first` to `last` at the nodes of a lattice.
Gathered gather_levels(const LightField& field, const LatticeRequest& request, const NodeReceivers& at,
                       std::size_t first, std::size_t last, std::vector<LevelCost>& costs, Progress& progress) {
    Gathered light;
    light.resize(at.receivers.size(), request.eye.has_value(), request.moments);
    FarGather(field, at.receivers, request.mean_cosine, light, progress).run_levels(first, last, costs);
    return light;
}

// Adds the light of levels from `first` on to `out`, at the nodes of the lattice `at` and at coarser ones below it.
void gather_down(const LightField& field, const LatticeRequest& request, const NodeReceivers& at, std::size_t first,
                 int coarsening, Gathered& out, std::vector<LevelCost>& costs, Progress& progress) {
    const auto& levels = field.grid->levels;
    std::size_t last = first;
    while (last < levels.size() &&
           (!request.interpolates_far_light || coarsening_of(field, levels[last]) <= coarsening))
        ++last;
    if (last > first)
        add_at_nodes(at, gather_levels(field, request, at, first, last, costs, progress), out);
    if (last == levels.size())
        return;
    const NodeReceivers coarser = coarser_receivers(field.pyramid->medium(), request, at, coarsening + 1);
    Gathered light;
    light.resize(coarser.needed.size(), request.eye.has_value(), request.moments);
    gather_down(field, request, coarser, last, coarsening + 1, light, costs, progress);
    add_interpolated(coarser, light, at, out);
}

// Adds the contributions of all levels of the grid to the requested nodes.
void gather_grid(const LightField& field, const LatticeRequest& request, Gathered& out, std::vector<LevelCost>& costs,
                 Progress& progress) {
    gather_down(field, request, node_receivers(field.pyramid->medium(), request), 0, 0, out, costs, progress);
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
    out.resize(nodes, request.eye.has_value(), request.moments);

    const Stopwatch watch;
    const NearField near(medium.local_from_index, field.alpha * medium.spacing,
                         field.settings.shadows != ShadowMethod::None);
    near.gather({&medium.lattice, &medium.extinction, field.intensity, field.directional, request.eye,
                 medium.reference_node, request.mean_cosine, request.needed},
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
    out.resize(field.pyramid->medium().lattice.node_count(), request.eye.has_value(), request.moments);
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
    gather.run_levels(0, field.grid->levels.size(), costs);
    return out;
}

}  // namespace brisance
