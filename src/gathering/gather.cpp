#include "gathering/gather.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/stopwatch.h"
#include "gathering/far_gather.h"
#include "gathering/light_between.h"
#include "gathering/node_receivers.h"
#include "gathering/separations.h"
#include "near_field/first_level.h"

namespace brisance {

namespace {

int wanted_coarsening(const LightField& field, const LatticeRequest& request, const GridLevel& level) {
    if (!request.interpolates_far_light)
        return 0;
    return std::max(request.least_coarsening, coarsening_of(field, level));
}

// Adds the light of all levels of the grid to the requested nodes, from near to far: each at the nodes of a lattice and
// at those of finer ones that do not see it whole.
class GatherDown {
public:
    GatherDown(const LightField& field, const LatticeRequest& request, std::vector<LevelCost>& costs,
               Progress& progress)
        : field_(field), request_(request), costs_(costs), progress_(progress), extinction_(*field.pyramid) {}

    // At the nodes of the medium and at coarser ones below them.
    void run(Gathered& out) {
        const NodeReceivers nodes = node_receivers(field_.pyramid->medium(), request_);
        const std::size_t last = end_of_levels(0, 0);
        const bool between = request_.own_share < 1.0f && field_.bottom == 0 && field_.intensity && last > 0 &&
                             field_.pyramid->level_count() > 1;
        if (!between)
            return run(nodes, 0, 0, out);
        gather_between(nodes, last, out);
        run_below(nodes, last, 0, out);
    }

private:
    struct Asked {
        const NodeReceivers* nodes;
        Gathered* light;  // planar over nodes
        int coarsening;
    };

    Gathered dark(std::size_t nodes) const {
        Gathered light;
        light.resize(nodes, request_.eye.has_value(), request_.moments);
        return light;
    }

    // The end of the levels from `first` on that every 2^coarsening-th node gathers.
    std::size_t end_of_levels(std::size_t first, int coarsening) const {
        const auto& levels = field_.grid->levels;
        while (first < levels.size() && wanted_coarsening(field_, request_, levels[first]) <= coarsening)
            ++first;
        return first;
    }

    // From the level `first` on, at the nodes of a lattice and at coarser ones below it.
    void run(const NodeReceivers& at, std::size_t first, int coarsening, Gathered& out) {
        const std::size_t last = end_of_levels(first, coarsening);
        asked_.push_back({&at, &out, coarsening});
        gather(first, last);
        asked_.pop_back();
        run_below(at, last, coarsening, out);
    }

    // The levels from `first` on, at coarser nodes than those of `at`, to which it is interpolated.
    void run_below(const NodeReceivers& at, std::size_t first, int coarsening, Gathered& out) {
        if (first == field_.grid->levels.size())
            return;
        if (!field_.occluders) {
            run_between(at, first, coarsening, out);
            return;
        }
        const NodesBesideSurfaces parts =
            part_beside_surfaces(field_.pyramid->medium(), request_, at, coarsening, *field_.occluders);
        asked_.push_back({&parts.beside, &out, coarsening});
        run_between(parts.in_the_open, first, coarsening, out);
        asked_.pop_back();
    }

    // The levels up to `last` at every second node, from far to near, and at the others by what is between them. Nodes
    // beside surfaces gather for themselves. `out` has no other light yet.
    void gather_between(const NodeReceivers& nodes, std::size_t last, Gathered& out) {
        const Medium& medium = field_.pyramid->medium();
        NodesBesideSurfaces parts{{nodes.lattice, nodes.needed, {}, {}}, {nodes.lattice, {}, {}, {}}};
        if (field_.occluders)
            parts = part_beside_surfaces(medium, request_, nodes, 0, *field_.occluders);
        const std::vector<std::uint8_t>& open = parts.in_the_open.needed;
        const NodeReceivers coarser = coarser_receivers(medium, request_, parts.in_the_open, 1);
        const LightBetween between(*field_.pyramid, extinction_.at(1), coarser, field_.alpha * medium.spacing,
                                   field_.occluders);
        const bool all_gather = request_.own_share > 0.0f;
        const NodeReceivers compared =
            marked_receivers(medium, request_, all_gather ? open : between.compared_nodes(open));
        Gathered sum = dark(coarser.needed.size());
        for (std::size_t index = last; index-- > 0;) {
            if (index == 0 && !all_gather)
                between.set(sum, compared.needed, out);
            Gathered here = dark(coarser.needed.size());
            asked_ = {{&coarser, &here, 1}};
            if (parts.beside.receivers.size() > 0)
                asked_.push_back({&parts.beside, &out, 0});
            if (index == 0 || all_gather)
                asked_.push_back({&compared, &out, 0});
            gather(index, index + 1);
            asked_.clear();
            const GridLevel& level = field_.grid->levels[index];
            between.add(here, level.level > 1 && gathers_by_separations(field_, level, 1), sum);
        }
        between.mix(sum, compared.needed, open, request_.own_share, out);
    }

    // At the nodes of a lattice, from the coarser ones below it.
    void run_between(const NodeReceivers& nodes, std::size_t first, int coarsening, Gathered& out) {
        const NodeReceivers coarser = coarser_receivers(field_.pyramid->medium(), request_, nodes, coarsening + 1);
        Gathered light = dark(coarser.needed.size());
        run(coarser, first, coarsening + 1, light);
        add_interpolated(coarser, light, nodes, out);
    }

    // Of the levels from `first` to `last`: by separations where nodes can, and else by maps.
    void gather(std::size_t first, std::size_t last) {
        for (; first < last; ++first) {
            const GridLevel& level = field_.grid->levels[first];
            std::vector<Asked> by_separations, by_maps;
            for (const Asked& asked : asked_)
                (gathers_by_separations(field_, level, asked.coarsening) ? by_separations : by_maps).push_back(asked);
            if (by_separations.empty())
                break;
            gather_by_separations(by_separations, first);
            if (!by_maps.empty())
                gather_on_demand(by_maps, first);
        }
        if (first < last)
            gather_by_maps(field_, asked_, first, last);
    }

    void gather_by_maps(const LightField& field, const std::vector<Asked>& asked, std::size_t first, std::size_t last) {
        std::vector<Gathered> light(asked.size());
        std::vector<ReceiverSet> sets;
        for (std::size_t i = 0; i < asked.size(); ++i) {
            light[i].resize(asked[i].nodes->receivers.size(), request_.eye.has_value(), request_.moments);
            sets.push_back({&asked[i].nodes->receivers, &light[i]});
        }
        FarGather(field, std::move(sets), request_.mean_cosine, progress_).run_levels(first, last, costs_);
        for (std::size_t i = 0; i < asked.size(); ++i)
            add_at_nodes(*asked[i].nodes, light[i], *asked[i].light);
    }

    // By separations alone where no surface is as near as the level's light reaches, elsewhere by maps.
    void gather_by_separations(const std::vector<Asked>& asked, std::size_t index) {
        const Stopwatch watch;
        const GridLevel& level = field_.grid->levels[index];
        const Medium& medium = field_.pyramid->medium();
        const FirstLevel by_separations(first_level_lattice(field_, level), field_.alpha * level.spacing);
        LevelCost cost;
        cost.level = level.level;
        cost.lights = level.size();
        std::vector<NodesBesideSurfaces> parts;
        parts.reserve(asked.size());
        for (const Asked& a : asked) {
            const NodeReceivers* open = a.nodes;
            if (field_.occluders) {
                parts.push_back(part_within_reach(medium, request_, *a.nodes, a.coarsening,
                                                  by_separations.longest_reach(), *field_.occluders));
                open = &parts.back().in_the_open;
            }
            cost.evaluations += by_separations.gather(
                {field_.pyramid, &extinction_.at(level.level - 1), &level, request_.eye, request_.mean_cosine},
                {&open->lattice, &open->needed, a.coarsening == level.level}, *a.light);
        }
        cost.gather_seconds = watch.seconds();
        costs_.push_back(cost);
        std::vector<Asked> beside;
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (parts[i].beside.receivers.size() > 0)
                beside.push_back({&parts[i].beside, asked[i].light, asked[i].coarsening});
        if (!beside.empty())
            gather_on_demand(beside, index);
    }

    // By maps of the lights that the nodes ask for.
    void gather_on_demand(const std::vector<Asked>& asked, std::size_t index) {
        ShadowMapCache own;
        auto& maps = (field_.cache ? field_.cache : &own)->beside_surfaces;
        if (!maps)
            maps = std::make_unique<ShadowMapCache>(ShadowMapCache{{}, true});
        LightField field = field_;
        field.cache = maps.get();
        gather_by_maps(field, asked, index, index + 1);
    }

    const LightField& field_;
    const LatticeRequest& request_;
    std::vector<LevelCost>& costs_;
    Progress& progress_;
    SeparationExtinction extinction_;
    std::vector<Asked> asked_;
};

}  // namespace

std::uint64_t ShadowMapCache::bytes() const {
    std::uint64_t sum = beside_surfaces ? beside_surfaces->bytes() : 0;
    for (const Level& level : levels)
        sum += (level.maps.size() + level.ends.size()) * sizeof(std::uint16_t) +
               level.map_of.size() * sizeof(std::uint32_t);
    return sum;
}

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

namespace {

// Adds the light of level 0 at the nodes.
LevelCost gather_near_field(const LightField& field, const LatticeRequest& request, Gathered& out) {
    const Medium& medium = field.pyramid->medium();
    const Stopwatch watch;
    const bool shadows = field.settings.shadows != ShadowMethod::None;
    const NearField near(medium.local_from_index, field.alpha * medium.spacing, shadows);
    near.gather({&medium.lattice, &medium.extinction, field.intensity, field.directional, request.eye,
                 medium.reference_node, request.mean_cosine, request.needed, shadows ? field.occluders : nullptr},
                out);
    LevelCost bottom;
    bottom.lights =
        std::count_if(field.intensity->begin(), field.intensity->end(), [](const Rgb& i) { return i != Rgb(0.0f); });
    bottom.gather_seconds = watch.seconds();
    bottom.evaluations = near.separations() * medium.lattice.node_count();
    return bottom;
}

}  // namespace

float own_share_of(const LightingSettings& settings, float mean_cosine) {
    constexpr float kUsual = 0.02f, kWide = 0.4f, kNarrow = 0.6f;
    if (settings.interpolation == 0.0f || settings.shadows != ShadowMethod::Maps)
        return 1.0f;
    return 1.0f - glm::smoothstep(0.5f * kUsual, kUsual, settings.error) *
                      (1.0f - glm::smoothstep(kWide, kNarrow, std::abs(mean_cosine)));
}

Gathered gather_at_nodes(const LightField& field, const LatticeRequest& request, std::vector<LevelCost>& costs,
                         Progress& progress) {
    Gathered out;
    out.resize(field.pyramid->medium().lattice.node_count(), request.eye.has_value(), request.moments);
    const std::size_t before = costs.size();
    GatherDown(field, request, costs, progress).run(out);
    if (field.bottom == 0 && field.intensity)
        costs.push_back(gather_near_field(field, request, out));
    std::stable_sort(costs.begin() + std::ptrdiff_t(before), costs.end(),
                     [](const LevelCost& a, const LevelCost& b) { return a.level < b.level; });
    return out;
}

Gathered gather_at_points(const LightField& field, const GridLevel& bottom, const Receivers& receivers,
                          float mean_cosine, std::vector<LevelCost>& costs, Progress& progress, ReceiverKind kind,
                          bool moments) {
    Gathered out;
    out.resize(receivers.size(), !receivers.out_x.empty(), moments);
    FarGather gather(field, {{&receivers, &out}}, mean_cosine, progress, kind);
    if (field.bottom == 0)
        costs.push_back(gather.run(bottom, false));
    gather.run_levels(0, field.grid->levels.size(), costs);
    return out;
}

}  // namespace brisance
