#include "medium_lighting/medium_lighting.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/phase.h"
#include "medium_lighting/emitter_light.h"
#include "medium_lighting/level_costs.h"
#include "medium_lighting/surface_occluders.h"

namespace brisance {

namespace {

// Of the pyramid that rays toward extended lights march: which part of a light is hidden by smoke needs no more.
constexpr int kAimLevel = 2;

nlohmann::ordered_json balance_row(const BounceBalance& b, const std::string& orders) {
    return {{"orders", orders}, {"emitted", b.emitted}, {"collided", b.collided},
            {"scale", b.scale}, {"escaped", b.escaped}, {"escape_standard_error", b.escaped_error},
            {"sum", b.sum()}};
}

// Nodes whose light the camera or the smoke can ask for: corners of cells with extinction.
std::vector<std::uint8_t> nodes_beside_extinction(const Medium& medium) {
    constexpr int kWide = BrickLattice::kSize + 2;
    std::vector<std::uint8_t> needed(medium.lattice.node_count(), 0);
    parallel_for(medium.lattice.brick_count(), [&](std::size_t b) {
        std::vector<float> box(kWide * kWide * kWide);
        copy_box(medium.lattice, medium.extinction, 1, medium.lattice.first_node(b) - 1, ivec3(kWide), box);
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const ivec3 p = BrickLattice::node_in_brick(n);
            bool any = false;
            for (int k = 0; k < 27 && !any; ++k)
                any = box[((p.x + k / 9) * kWide + p.y + k / 3 % 3) * kWide + p.z + k % 3] > 0.0f;
            needed[b * BrickLattice::kNodes + n] = any;
        }
    });
    return needed;
}

std::vector<vec3> directions_to(const Medium& medium, const vec3& eye) {
    std::vector<vec3> directions(medium.lattice.node_count());
    parallel_for(
        directions.size(),
        [&](std::size_t i) {
            const vec3 p = medium.local_of_node(medium.lattice.node(i));
            const vec3 way = eye - p;
            const float d = glm::length(way);
            directions[i] = d > 0.0f ? way / d : vec3(0.0f, 0.0f, 1.0f);
        },
        4096);
    return directions;
}

}  // namespace

MediumLighting::MediumLighting(const Shot& shot, const Plan& plan, const Medium& medium, const Camera& camera,
                               Statistics& statistics, Progress& progress, const Surroundings* surroundings,
                               const ReflectedLight& reflected)
    : shot_(shot),
      plan_(plan),
      medium_(medium),
      statistics_(statistics),
      progress_(progress),
      pyramid_(medium, ExtinctionPyramid::kMaxLevels),
      needed_(nodes_beside_extinction(medium)),
      depths_(pyramid_, kAimLevel) {
    if (surroundings && surroundings->has_surfaces()) {
        surfaces_ = std::make_unique<SurfaceOccluders>(surroundings->intersector());
        if (surfaces_reach_into(surroundings->scene(), medium))
            pyramid_.set_occluders(surfaces_.get());
    }
    if (plan.directional)
        toward_camera_ = directions_to(medium, vec3(camera.eye_local()));
    if (!marching() && (plan.single || plan.multiple))
        haze_ = ThinMedium(medium, depths_, needed_,
                           plan.directional ? std::optional(vec3(camera.eye_local())) : std::nullopt);
    if (!haze_.empty())
        pyramid_.set_homogeneous_bricks(&haze_.homogeneous_bricks());
    Gathered first;
    if (plan.emission)
        first = light_from_fire();
    else
        first.resize(needed_.size(), plan.directional, plan.multiple && plan.directional);
    if ((reflected.lights || reflected.cast) && plan.needs(Cell::MS)) {
        const Gathered more = light_from_surfaces(reflected);
        nodes_.from_surfaces = source_function(more);
        first.add(more);
    }
    if (surroundings && plan.needs(Cell::MA)) {
        const Gathered more = light_from_emitters(*surroundings);
        if (!plan.emitters_by_rays)
            nodes_.from_emitters = source_function(more);
        first.add(more);
    }
    if (plan.multiple)
        light_from_smoke(first);
}

LatticeRequest MediumLighting::request() const {
    const bool moments = plan_.multiple && plan_.directional;
    return {&needed_, plan_.directional ? &toward_camera_ : nullptr, moments, medium_.mean_cosine};
}

// Of the last flight before the camera.
LatticeRequest MediumLighting::last_request() const {
    LatticeRequest ask = request();
    ask.moments = false;
    return ask;
}

Gathered MediumLighting::light_from_surfaces(const ReflectedLight& reflected) {
    progress_.stage("light from surfaces (MS)");
    const Stopwatch watch;
    const LatticeRequest ask = request();
    StageCost stage{"light from surfaces (MS)", 0.0, 0, {}};
    Gathered g;
    g.resize(needed_.size(), ask.toward_camera != nullptr, ask.moments);
    if (reflected.lights) {
        std::vector<LevelCost> costs;
        std::size_t lights = 0;
        // Lights outside stand for themselves: no voxel has a share in them.
        const std::vector<float> no_weight(needed_.size(), 0.0f);
        for (const PointLights& side : *reflected.lights) {
            const LightingGrid grid = build_point_grid(medium_, side, shot_.lighting.alpha);
            if (grid.levels.empty())
                continue;
            const LightField field{&pyramid_,      nullptr, nullptr,        &grid, &no_weight, shot_.lighting.alpha,
                                   shot_.lighting, nullptr, surfaces_.get()};
            g.add(gather_from_outside(field, ask, costs, progress_));
            stage.bytes = std::max(stage.bytes, grid.bytes() + most_held(costs));
            lights += side.size();
        }
        stage.detail = {{"lights", lights}, {"levels", level_table(costs)}};
    }
    if (reflected.cast) {
        const Stopwatch cast;
        g.add(reflected.cast->on(medium_, ask));
        stage.detail["particles"] = reflected.cast->particles();
        stage.detail["particle_seconds"] = cast.seconds();
    }
    prepare_interpolation(medium_.lattice, needed_, g);
    stage.seconds = watch.seconds();
    statistics_.stages.push_back(std::move(stage));
    return g;
}

Gathered MediumLighting::light_from_emitters(const Surroundings& surroundings) {
    progress_.stage("light from emitters (MA)");
    const Stopwatch watch;
    const LatticeRequest ask = request();
    Gathered g = gather_from_emitters(surroundings, pyramid_, ask);
    prepare_interpolation(medium_.lattice, needed_, g);
    statistics_.stages.push_back({"light from emitters (MA)", watch.seconds(), 0, {}});
    return g;
}

std::vector<Rgb> MediumLighting::source_function(const Gathered& g) const {
    const std::size_t n = needed_.size();
    std::vector<Rgb> source(n, Rgb(0.0f));
    parallel_for(
        n,
        [&](std::size_t i) {
            if (!needed_[i])
                return;
            for (int c = 0; c < 3; ++c)
                source[i][c] = medium_.albedo_at(i)[c] *
                               (g.scattered.empty() ? g.fluence[c * n + i] / (4.0f * kPi) : g.scattered[c * n + i]);
        },
        4096);
    return source;
}

Gathered MediumLighting::light_from_fire() {
    progress_.stage("fire to lights");
    Stopwatch watch;
    HierarchyLights lights = build_hierarchy(medium_, {voxel_lights(medium_), {}}, shot_.lighting.levels);
    const double emitted = luminance(Rgb(total(lights.light.intensity)));
    statistics_.stages.push_back({"lights and hierarchy",
                                  watch.seconds(),
                                  lights.grid.bytes(),
                                  {{"intensity_sum", emitted}, {"lattice_and_pyramid_bytes", pyramid_.bytes()}}});

    progress_.stage("light from the fire (MV)");
    watch = Stopwatch();
    const bool nodes = plan_.single && (!marching() || plan_.multiple || shot_.lighting.energy_balance);
    StageCost stage{"light from the fire (MV)", 0.0, 0, {}};
    Rgb scale(1.0f);
    Gathered first;
    if (nodes) {
        std::vector<LevelCost> costs;
        const LightField field = lights.field(pyramid_, shot_.lighting.alpha, shot_.lighting, nullptr);
        first = gather_at_nodes(field, request(), costs, progress_);
        prepare_interpolation(medium_.lattice, needed_, first);
        if (shot_.lighting.energy_balance) {
            BounceBalance balance;
            balance.emitted = 1.0;
            scale = energy_balance_factor(pyramid_, lights.light, fluence_at_nodes(first, needed_), balance);
            first.scale(scale);
            stage.detail["balance"].push_back(balance_row(balance, "0"));
        }
        stage.bytes = most_held(costs) + (first.fluence.size() + first.scattered.size() + first.moments.size()) * 4;
        stage.detail["levels"] = level_table(costs);
        stage.seconds = watch.seconds();
        statistics_.stages.push_back(stage);
    }
    if (marching() || lights_outside()) {
        fire_ = std::make_unique<KeptLights>();
        fire_->lights = std::move(lights);
        fire_->scale = scale;
        keep(*fire_, shot_.lighting.alpha);
        if (nodes)
            light_haze(*fire_, request(), first);
    }
    if (nodes && !marching())
        nodes_.single = source_function(first);
    if (first.fluence.empty())
        first.resize(needed_.size(), plan_.directional, plan_.multiple && plan_.directional);
    return first;
}

// Even haze's lights apart from the rest.
Gathered MediumLighting::gather_from_smoke(HierarchyLights& lights, std::vector<LevelCost>& costs) {
    const auto of_haze = take_thin_medium_lights(medium_, haze_.even_bricks(), lights);
    const auto field = [&](const HierarchyLights& h) {
        return h.field(pyramid_, shot_.scattering.alpha, shot_.lighting, nullptr);
    };
    Gathered g = gather_at_nodes(field(lights), last_request(), costs, progress_);
    if (!of_haze)
        return g;
    LightField haze = field(of_haze->lights);
    haze.bottom = kFinestHazeLights;
    g.add(gather_from_outside(haze, last_request(), costs, progress_));
    give_back(*of_haze, haze_.even_bricks(), lights.light);
    return g;
}

Gathered MediumLighting::gather_last_flight(HierarchyLights& lights, int order, nlohmann::ordered_json& balances,
                                            std::vector<LevelCost>& costs) {
    Gathered g = gather_from_smoke(lights, costs);
    prepare_interpolation(medium_.lattice, needed_, g);
    if (!shot_.lighting.energy_balance)
        return g;
    BounceBalance balance;
    balance.emitted = 1.0;
    const Rgb scale = energy_balance_factor(pyramid_, lights.light, fluence_at_nodes(g, needed_), balance);
    g.scale(scale);
    if (smoke_)
        smoke_->scale = scale;
    balances.push_back(balance_row(balance, order < 0 ? "last" : std::to_string(order)));
    return g;
}

std::vector<ScatteredLight> MediumLighting::orders_of_scattering(const Gathered& first) {
    progress_.stage("orders of scattering");
    const Stopwatch watch;
    ScatteringCosts costs;
    std::vector<ScatteredLight> orders = solve_scattering(
        {&pyramid_, &first, &needed_, shot_.lighting, shot_.scattering, orders_apart()}, costs, progress_);
    StageCost series{"orders of scattering on the coarse lattice", watch.seconds(), costs.bytes, {}};
    series.detail = {{"lattice_level", costs.lattice_level},
                     {"nodes", costs.coarse_nodes},
                     {"operator_seconds", costs.operator_seconds},
                     {"series_seconds", costs.series_seconds},
                     {"bounces", costs.bounces},
                     {"tail_ratio", costs.tail_ratio},
                     {"tail_share", costs.tail_share},
                     {"estimated_remainder", costs.remainder}};
    series.detail["levels"] = level_table(costs.levels);
    if (costs.balance)
        series.detail["balance"].push_back(
            balance_row(*costs.balance, "1-" + std::to_string(costs.balance->last_order)));
    statistics_.stages.push_back(series);
    if (shot_.scattering.bounces < 0 && costs.remainder > shot_.scattering.remainder)
        progress_.warning("series", "multiple scattering stopped after " + std::to_string(costs.bounces) +
                                        " bounces with an estimated " + std::to_string(100.0 * costs.remainder) +
                                        " % of its light missing");
    return orders;
}

void MediumLighting::light_from_smoke(const Gathered& first) {
    std::vector<ScatteredLight> orders = orders_of_scattering(first);
    progress_.stage("light from the smoke (MM)");
    const Stopwatch watch;
    StageCost last{"light from the smoke (MM)", 0.0, 0, {}};
    auto balances = nlohmann::ordered_json::array();
    std::vector<LevelCost> levels;
    Gathered sum;
    sum.resize(needed_.size(), plan_.directional, false);
    const bool kept = marching() || lights_outside();
    if (kept)
        smoke_ = std::make_unique<KeptLights>();
    for (std::size_t k = 0; k < orders.size(); ++k) {
        orders[k].sharpen(medium_.lattice);
        HierarchyLights lights = build_hierarchy(medium_, std::move(orders[k]), shot_.lighting.levels);
        // Marching gathers at the points later; the nodes then serve the balance alone.
        Gathered g;
        if (!marching() || shot_.lighting.energy_balance) {
            std::vector<LevelCost> these;
            g = gather_last_flight(lights, orders_apart() ? int(k) + 1 : -1, balances, these);
            if (levels.empty())
                levels = these;
        }
        if (kept)
            smoke_->lights = std::move(lights);
        if (kept && orders_apart()) {
            keep(*smoke_, shot_.scattering.alpha);
            light_haze(*smoke_, last_request(), g);
        }
        if (orders_apart())
            nodes_.orders.push_back(source_function(g));
        sum.add(g);
    }
    if (kept && lights_outside() && !plan_.directional && shot_.scattering.bounces < 0 && !orders_apart()) {
        // What the camera sees is what lights the surroundings: all light that arrives at the nodes, scattered once
        // more.
        Gathered all = first;
        all.add(sum);
        ScatteredLight leaving = scattered_light(medium_, all, needed_);
        leaving.sharpen(medium_.lattice);
        smoke_->lights = build_hierarchy(medium_, std::move(leaving), shot_.lighting.levels);
    }
    if (kept && !orders_apart()) {
        keep(*smoke_, shot_.scattering.alpha);
        light_haze(*smoke_, last_request(), sum);
    }
    if (!marching())
        nodes_.multiple = source_function(sum);
    last.seconds = watch.seconds();
    last.bytes = most_held(levels) + (sum.fluence.size() + sum.scattered.size()) * 4;
    last.detail["levels"] = level_table(levels);
    if (!balances.empty())
        last.detail["balance"] = balances;
    statistics_.stages.push_back(last);
}

}  // namespace brisance
