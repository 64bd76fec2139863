#include "gathering/far_gather.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "gathering/map_layouts.h"
#include "medium/lattice/local_bounds.h"
#include "medium/phase.h"
#include "medium/voxel_size.h"
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

}  // namespace

FarGather::FarGather(const LightField& field, std::vector<ReceiverSet> sets, float mean_cosine, Progress& progress,
                     ReceiverKind kind)
    : field_(field), sets_(std::move(sets)), mean_cosine_(mean_cosine), kind_(kind), progress_(progress) {
    std::erase_if(sets_, [](const ReceiverSet& s) { return s.receivers->size() == 0; });
    fine_ = field.pyramid->view(0);
    const LocalBounds bounds = local_bounds(field.pyramid->medium());
    const vec3 voxel(longest_diagonal(field.pyramid->medium()));  // smoke ends within one of its nodes
    medium_ = {bounds.low - voxel, bounds.high + voxel};
}

void FarGather::run_levels(std::size_t first, std::size_t last, std::vector<LevelCost>& costs) {
    const auto& levels = field_.grid->levels;
    for (std::size_t l = first; l < last; ++l)
        costs.push_back(run(levels[l], l + 1 == levels.size()));
}

LevelCost FarGather::run(const GridLevel& level, bool top) {
    LevelCost cost;
    cost.level = level.level;
    cost.lights = level.size();
    if (level.size() == 0 || sets_.empty())
        return cost;
    const bool maps = has_maps(level);
    ShadowMapLayout layout;
    std::size_t batch = level.size();
    if (maps) {
        layout = map_layout(field_, level, top);
        fit_to_memory(layout, level.size(), field_.settings.memory_limit_bytes, level.level, progress_);
        batch = std::clamp<std::size_t>(field_.settings.memory_limit_bytes / layout.bytes_per_light(),
                                        std::min(kLeastBatch, level.size()), level.size());
        cost.resolution = layout.resolution;
        cost.distances = layout.distances;
        cost.map_bytes = layout.bytes_per_light() * level.size();
        cost.held_bytes = layout.bytes_per_light() * batch;
    }
    if (maps && field_.cache && batch < level.size() && field_.cache->on_demand)
        gather_needed(level, far_lights(level, top, layout, 0), batch, cost);
    else
        gather_batches(level, far_lights(level, top, layout, 0), maps, batch, cost);
    return cost;
}

void FarGather::gather_batches(const GridLevel& level, FarLights lights, bool maps, std::size_t batch,
                               LevelCost& cost) {
    const bool keep = maps && field_.cache && batch == level.size();
    if (keep)
        field_.cache->levels.resize(std::max<std::size_t>(field_.cache->levels.size(), level.level + 1));
    ShadowMapCache::Level own;
    ShadowMapCache::Level& made = keep ? field_.cache->levels[level.level] : own;
    const bool on_demand = keep && field_.cache->on_demand;
    for (std::size_t first = 0; first < level.size(); first += batch) {
        const std::size_t count = std::min(batch, level.size() - first);
        lights.list_base = static_cast<std::uint32_t>(first);
        Stopwatch watch;
        if (on_demand) {
            make_needed_maps(level, lights, made);
        } else if (maps && !(keep && !made.maps.empty())) {
            made.ends.clear();
            build_shadow_maps(*field_.pyramid, level, *field_.weight, field_.escape, lights.layout, first, count,
                              made.maps, field_.occluders);
        }
        use_ends(lights, made);
        cost.map_seconds += watch.seconds();
        watch = Stopwatch();
        cost.evaluations += gather_batch(level, lights, count, made);
        cost.gather_seconds += watch.seconds();
        progress_.fraction(double(first + count) / level.size());
    }
    if (on_demand)
        cost.map_bytes = cost.held_bytes = made.maps.size() * sizeof(std::uint16_t);
}

// Where not all maps of the level can be held: makes those that are needed, `batch` of them at once, and keeps
// none.
void FarGather::gather_needed(const GridLevel& level, FarLights lights, std::size_t batch, LevelCost& cost) {
    Stopwatch watch;
    ShadowMapCache::Level made;
    made.map_of.resize(level.size(), FarLights::kNoMap);
    const std::vector<std::uint32_t> needed = needed_lights(level, lights, made);
    cost.map_seconds += watch.seconds();
    cost.map_bytes = needed.size() * lights.layout.bytes_per_light();
    cost.held_bytes = std::min(batch, needed.size()) * lights.layout.bytes_per_light();
    for (std::size_t begin = 0; begin < needed.size(); begin += batch) {
        const std::size_t end = std::min(begin + batch, needed.size());
        watch = Stopwatch();
        made.maps.clear();
        made.ends.clear();
        make_maps(level, lights, std::span(needed).subspan(begin, end - begin), made);
        use_ends(lights, made);
        cost.map_seconds += watch.seconds();
        watch = Stopwatch();
        lights.list_base = needed[begin];
        cost.evaluations += gather_batch(level, lights, needed[end - 1] - needed[begin] + 1, made);
        cost.gather_seconds += watch.seconds();
        progress_.fraction(double(end) / needed.size());
    }
}

FarLights FarGather::far_lights(const GridLevel& level, bool top, const ShadowMapLayout& layout,
                                std::size_t first) const {
    FarLights lights{};
    lights.position = level.position.data();
    lights.intensity = level.intensity.data();
    lights.directional = level.directional.empty() ? nullptr : level.directional.data();
    lights.lobes = level.lobe.empty() ? nullptr : level.lobe.data();
    lights.radius = field_.alpha * level.spacing;
    lights.bottom = level.level == field_.bottom;
    lights.voxels = level.level == 0;
    lights.top = top;
    lights.ball = std::cbrt(3.0f / (4.0f * kPi)) * field_.pyramid->medium().spacing * float(1 << level.level);
    lights.balls = level.ball.empty() ? nullptr : level.ball.data();
    lights.shadow = field_.settings.shadows == ShadowMethod::None ? FarLights::Shadow::None
                    : has_maps(level)                             ? FarLights::Shadow::Maps
                                                                  : FarLights::Shadow::Exact;
    lights.list_base = static_cast<std::uint32_t>(first);
    lights.layout = layout;
    lights.medium = medium_;
    lights.extinction = &fine_;
    lights.index_from_local = field_.pyramid->medium().index_from_local;
    lights.edges = float(1 << level.level) * field_.pyramid->medium().local_from_index;
    lights.step_nodes = 0.5f;
    return lights;
}

bool FarGather::has_maps(const GridLevel& level) const {
    return field_.settings.shadows == ShadowMethod::Maps && level.level > 0;
}

// Lights without a map in `made` that may reach some receiver, as ascending indices.
std::vector<std::uint32_t> FarGather::needed_lights(const GridLevel& level, const FarLights& lights,
                                                    const ShadowMapCache::Level& made) const {
    std::vector<std::uint8_t> used(level.size(), 0);
    for (const ReceiverSet& set : sets_)
        parallel_for(set.receivers->blocks().size(), [&](std::size_t b) {
            thread_local std::vector<std::uint32_t> near;
            const ReceiverBlock& block = set.receivers->blocks()[b];
            interaction_list(field_, level, lights.top, block.bounds, near);
            for (const std::uint32_t i : near) {
                std::atomic_ref<std::uint8_t> mark(used[i]);
                if (made.map_of[i] == FarLights::kNoMap && mark.load(std::memory_order_relaxed) == 0 &&
                    may_reach(lights, i, *set.receivers, block))
                    mark.store(1, std::memory_order_relaxed);
            }
        });
    std::vector<std::uint32_t> list;
    for (std::uint32_t i = 0; i < used.size(); ++i)
        if (used[i])
            list.push_back(i);
    return list;
}

// Whether what the coarsest level's maps hold for their last distance serves some receivers: nothing extinguishes
// light outside of the medium, and surfaces do not in these maps.
bool FarGather::ends_serve(const FarLights& lights) const {
    if (!lights.top || lights.shadow != FarLights::Shadow::Maps || field_.occluders || !field_.intensity)
        return false;
    return std::ranges::any_of(sets_, [&](const ReceiverSet& set) {
        return std::ranges::any_of(set.receivers->group_bounds,
                                   [&](const Box& group) { return lights.are_outside(group); });
    });
}

// Makes lights use the ends of their maps, where that pays.
void FarGather::use_ends(FarLights& lights, ShadowMapCache::Level& made) const {
    if (!ends_serve(lights))
        return;
    const std::size_t from = lights.layout.stride(), to = ends_of(lights.layout).stride();
    const auto texels = std::size_t(lights.layout.side()) * std::size_t(lights.layout.side());
    const std::size_t before = made.ends.size() / to, count = made.maps.size() / from;
    made.ends.resize(count * to);
    parallel_for(
        count - before,
        [&](std::size_t k) {
            const std::uint16_t* const map = made.maps.data() + (before + k) * from + (lights.layout.distances - 1);
            std::uint16_t* const end = made.ends.data() + (before + k) * to;
            for (std::size_t t = 0; t < texels; ++t)
                end[t] = map[t * std::size_t(lights.layout.distances)];
        },
        64);
    lights.ends = made.ends.data();
}

// Adds the maps of the lights in `list`.
void FarGather::make_maps(const GridLevel& level, const FarLights& lights, std::span<const std::uint32_t> list,
                          ShadowMapCache::Level& made) const {
    const std::size_t stride = lights.layout.stride(), before = made.maps.size();
    for (std::size_t k = 0; k < list.size(); ++k)
        made.map_of[list[k]] = static_cast<std::uint32_t>(before / stride + k);
    made.maps.resize(before + list.size() * stride);
    build_shadow_maps(*field_.pyramid, level, *field_.weight, field_.escape, lights.layout, list,
                      made.maps.data() + before, field_.occluders);
}

// Adds to `made` the missing maps of all lights that may reach some receiver.
void FarGather::make_needed_maps(const GridLevel& level, const FarLights& lights, ShadowMapCache::Level& made) const {
    made.map_of.resize(level.size(), FarLights::kNoMap);
    make_maps(level, lights, needed_lights(level, lights, made), made);
}

std::uint64_t FarGather::gather_batch(const GridLevel& level, const FarLights& all, std::size_t count,
                                      const ShadowMapCache::Level& made) const {
    std::uint64_t sum = 0;
    for (const ReceiverSet& set : sets_)
        sum += gather_batch(level, all, count, made, *set.receivers, *set.light);
    return sum;
}

std::uint64_t FarGather::gather_batch(const GridLevel& level, const FarLights& all, std::size_t count,
                                      const ShadowMapCache::Level& made, const Receivers& receivers,
                                      Gathered& light) const {
    std::vector<std::uint64_t> evaluations(receivers.blocks().size(), 0);
    parallel_for(receivers.blocks().size(), [&](std::size_t b) {
        thread_local std::vector<std::uint32_t> list;
        const ReceiverBlock& block = receivers.blocks()[b];
        interaction_list(field_, level, all.top, block.bounds, list);
        std::erase_if(list, [&](std::uint32_t i) { return i < all.list_base || i >= all.list_base + count; });
        FarLights lights = all;
        lights.list = list;
        lights.maps = made.maps.data();
        lights.map_of = made.map_of.empty() ? nullptr : made.map_of.data();
        const FarOutput output{receivers.size(),
                               light.fluence.data(),
                               light.scattered.empty() ? nullptr : light.scattered.data(),
                               light.moments.empty() ? nullptr : light.moments.data(),
                               mean_cosine_,
                               kind_};
        evaluations[b] = gather_far(lights, receivers, block, output);
    });
    std::uint64_t sum = 0;
    for (std::uint64_t e : evaluations)
        sum += e;
    return sum;
}

}  // namespace brisance
