#include "gathering/gather.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/stopwatch.h"
#include "gathering/far_gather.h"
#include "gathering/node_receivers.h"
#include "near_field/first_level.h"

namespace brisance {

namespace {

int wanted_coarsening(const LightField& field, const LatticeRequest& request, const GridLevel& level) {
    if (!request.interpolates_far_light)
        return 0;
    return std::max(request.least_coarsening, coarsening_of(field, level));
}

// Whether a level's lights stand beside even nodes of the medium's own lattice, and no surface parts them from receivers.
bool gathers_by_separations(const LightField& field, const GridLevel& level) {
    return field.settings.shadows == ShadowMethod::Maps && field.bottom == 0 && field.intensity && level.level == 1 &&
           level.size() > 0 && &level != &field.grid->levels.back() && !field.occluders &&
           FirstLevel::is_small(field.pyramid->medium().local_from_index, field.alpha * level.spacing);
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
        if (first < last && gathers_by_separations(field_, field_.grid->levels[first]) &&
            std::ranges::all_of(asked_, [](const Asked& a) { return a.coarsening <= 1; }))
            gather_by_separations(field_.grid->levels[first++]);
        if (last == first)
            return;
        std::vector<Gathered> light(asked_.size());
        std::vector<ReceiverSet> sets;
        for (std::size_t i = 0; i < asked_.size(); ++i) {
            light[i].resize(asked_[i].nodes->receivers.size(), request_.eye.has_value(), request_.moments);
            sets.push_back({&asked_[i].nodes->receivers, &light[i]});
        }
        FarGather(field_, std::move(sets), request_.mean_cosine, progress_).run_levels(first, last, costs_);
        for (std::size_t i = 0; i < asked_.size(); ++i)
            add_at_nodes(*asked_[i].nodes, light[i], *asked_[i].light);
    }

    // Of the first level above the lattice's own nodes, without maps.
    void gather_by_separations(const GridLevel& level) {
        const Stopwatch watch;
        const Medium& medium = field_.pyramid->medium();
        const FirstLevel first(medium.local_from_index, field_.alpha * level.spacing);
        LevelCost cost;
        cost.level = level.level;
        cost.lights = level.size();
        for (const Asked& asked : asked_)
            cost.evaluations += first.gather({&medium.lattice, &medium.extinction, &level, request_.eye,
                                              medium.local_of_node(ivec3(0)), request_.mean_cosine},
                                             {&asked.nodes->lattice, &asked.nodes->needed, asked.coarsening == 1},
                                             *asked.light);
        cost.gather_seconds = watch.seconds();
        costs_.push_back(cost);
    }

    const LightField& field_;
    const LatticeRequest& request_;
    std::vector<LevelCost>& costs_;
    Progress& progress_;
    std::vector<Asked> asked_;
};

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
