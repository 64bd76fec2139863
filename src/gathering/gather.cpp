#include "gathering/gather.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/stopwatch.h"
#include "gathering/far_gather.h"
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
        : field_(field), request_(request), costs_(costs), progress_(progress) {}

    // From the level `first` on, at the nodes of a lattice and at coarser ones below it.
    void run(const NodeReceivers& at, std::size_t first, int coarsening, Gathered& out) {
        const auto& levels = field_.grid->levels;
        std::size_t last = first;
        while (last < levels.size() && wanted_coarsening(field_, request_, levels[last]) <= coarsening)
            ++last;
        asked_.push_back({&at, &out, coarsening});
        gather(first, last);
        asked_.pop_back();
        if (last == levels.size())
            return;
        if (!field_.occluders) {
            run_between(at, last, coarsening, out);
            return;
        }
        const NodesBesideSurfaces parts =
            part_beside_surfaces(field_.pyramid->medium(), request_, at, coarsening, *field_.occluders);
        asked_.push_back({&parts.beside, &out, coarsening});
        run_between(parts.in_the_open, last, coarsening, out);
        asked_.pop_back();
    }

private:
    struct Asked {
        const NodeReceivers* nodes;
        Gathered* light;  // planar over nodes
        int coarsening;
    };

    // At the nodes of a lattice, from the coarser ones below it.
    void run_between(const NodeReceivers& nodes, std::size_t first, int coarsening, Gathered& out) {
        const NodeReceivers coarser = coarser_receivers(field_.pyramid->medium(), request_, nodes, coarsening + 1);
        Gathered light;
        light.resize(coarser.needed.size(), request_.eye.has_value(), request_.moments);
        run(coarser, first, coarsening + 1, light);
        add_interpolated(coarser, light, nodes, out);
    }

    // Of the levels from `first` to `last`.
    void gather(std::size_t first, std::size_t last) {
        const auto by_separations = [&](const GridLevel& level) {
            return std::ranges::all_of(
                asked_, [&](const Asked& a) { return gathers_by_separations(field_, level, a.coarsening); });
        };
        while (first < last && by_separations(field_.grid->levels[first]))
            gather_by_separations(first++);
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
    void gather_by_separations(std::size_t index) {
        const Stopwatch watch;
        const GridLevel& level = field_.grid->levels[index];
        const Medium& medium = field_.pyramid->medium();
        const FirstLevel by_separations(first_level_lattice(field_, level), field_.alpha * level.spacing);
        LevelCost cost;
        cost.level = level.level;
        cost.lights = level.size();
        std::vector<NodesBesideSurfaces> parts;
        parts.reserve(asked_.size());
        for (const Asked& asked : asked_) {
            const NodeReceivers* open = asked.nodes;
            if (field_.occluders) {
                parts.push_back(part_within_reach(medium, request_, *asked.nodes, asked.coarsening,
                                                  by_separations.longest_reach(), *field_.occluders));
                open = &parts.back().in_the_open;
            }
            cost.evaluations +=
                by_separations.gather({field_.pyramid, &level, request_.eye, request_.mean_cosine},
                                      {&open->lattice, &open->needed, asked.coarsening == level.level}, *asked.light);
        }
        cost.gather_seconds = watch.seconds();
        costs_.push_back(cost);
        std::vector<Asked> beside;
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (parts[i].beside.receivers.size() > 0)
                beside.push_back({&parts[i].beside, asked_[i].light, asked_[i].coarsening});
        if (!beside.empty())
            gather_beside_surfaces(beside, index);
    }

    // By maps of the lights that the nodes ask for.
    void gather_beside_surfaces(const std::vector<Asked>& asked, std::size_t index) {
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
    const NearField near(medium.local_from_index, field.alpha * medium.spacing,
                         field.settings.shadows != ShadowMethod::None);
    near.gather({&medium.lattice, &medium.extinction, field.intensity, field.directional, request.eye,
                 medium.reference_node, request.mean_cosine, request.needed},
                out);
    LevelCost bottom;
    bottom.lights =
        std::count_if(field.intensity->begin(), field.intensity->end(), [](const Rgb& i) { return i != Rgb(0.0f); });
    bottom.gather_seconds = watch.seconds();
    bottom.evaluations = near.separations() * medium.lattice.node_count();
    return bottom;
}

}  // namespace

Gathered gather_at_nodes(const LightField& field, const LatticeRequest& request, std::vector<LevelCost>& costs,
                         Progress& progress) {
    Gathered out;
    out.resize(field.pyramid->medium().lattice.node_count(), request.eye.has_value(), request.moments);
    if (field.bottom == 0 && field.intensity)
        costs.push_back(gather_near_field(field, request, out));
    GatherDown(field, request, costs, progress).run(node_receivers(field.pyramid->medium(), request), 0, 0, out);
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
