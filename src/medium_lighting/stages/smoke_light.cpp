#include "medium_lighting/stages/smoke_light.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/stopwatch.h"
#include "gathering/map_layouts.h"
#include "medium_lighting/adaptive_gather.h"
#include "medium_lighting/balance_table.h"
#include "medium_lighting/level_costs.h"
#include "scattering/balance.h"

namespace brisance {

namespace {

// The lattice of the series, which is no finer than that of the light, as levels above it.
struct SeriesLattice {
    LatticeChoice choice;
    SmokeMet smoke;
    float error = 0.0f, error_of_coarser = 0.0f;  // that it is expected to add to the picture, and the next coarser one
};

SeriesLattice lattice_of(const LitLattice& lattice, const ScatteredLight& once, const ScatteringSettings& settings) {
    SeriesLattice out;
    out.smoke = smoke_met(lattice.medium(), once.intensity);
    const float error = lattice.input().lighting.error;
    out.choice = lattice_of_series(out.smoke, settings, error, lattice.pyramid().level_count() - 1);
    out.error = error_of_series(out.smoke, settings, error, out.choice.level);
    out.error_of_coarser = error_of_series(out.smoke, settings, error, out.choice.level + 1);
    return out;
}

std::vector<ScatteredLight> orders_of_scattering(const LitLattice& lattice, const ScatteredLight& once,
                                                 const ScatteringSettings& settings, const SeriesLattice& on,
                                                 float fine_bounces, Statistics& statistics, Progress& progress) {
    progress.stage("orders of scattering");
    const Stopwatch watch;
    const MediumLightingInput& input = lattice.input();
    ScatteringCosts costs;
    std::vector<ScatteredLight> orders = solve_scattering(
        {&lattice.pyramid(), &once, input.lighting, settings, on.choice, input.orders_apart}, costs, progress);
    StageCost series{"orders of scattering on the coarse lattice", watch.seconds(), costs.bytes, {}};
    series.detail = {{"lattice_level", lattice.level() + costs.lattice_level},
                     {"share_of_coarser_level", costs.share_of_coarser},
                     {"depth_of_lit_voxel", on.smoke.depth},
                     {"error", on.error},
                     {"error_of_coarser_level", on.error_of_coarser},
                     {"nodes", costs.coarse_nodes},
                     {"share_of_fine_bounces", fine_bounces},
                     {"operator_seconds", costs.operator_seconds},
                     {"series_seconds", costs.series_seconds},
                     {"bounces", costs.bounces},
                     {"tail_ratio", costs.tail_ratio},
                     {"tail_share", costs.tail_share},
                     {"estimated_remainder", costs.remainder}};
    series.detail["levels"] = level_table(costs.levels);
    if (costs.cascades)
        series.detail["radiance_cascades"] = {{"cascades", costs.cascades->cascades},
                                              {"probes", costs.cascades->probes},
                                              {"intervals", costs.cascades->intervals},
                                              {"directions_of_coarsest", costs.cascades->directions}};
    if (const auto& d = costs.diffusion)
        series.detail["diffusion"] = {
            {"cells", d->cells},           {"multigrid_levels", d->levels}, {"flux_limiters", d->limiters},
            {"iterations", d->iterations}, {"residual", d->residual},       {"last_change", d->change},
            {"unbalanced", d->unbalanced}, {"converged", d->converged}};
    if (costs.balance)
        series.detail["balance"].push_back(
            balance_row(*costs.balance, "1-" + std::to_string(costs.balance->last_order)));
    statistics.stages.push_back(series);
    if (input.scattering.bounces < 0 && costs.remainder > input.scattering.remainder)
        progress.warning("series", "multiple scattering stopped after " + std::to_string(costs.bounces) +
                                       " bounces with an estimated " + std::to_string(100.0 * costs.remainder) +
                                       " % of its light missing");
    if (costs.diffusion && !costs.diffusion->converged)
        progress.warning("diffusion",
                         fmt::format("the diffusion of scattered light has not converged: residual {:.1e} of "
                                     "the source, last change of the fluence {:.1e}",
                                     costs.diffusion->residual, costs.diffusion->change));
    return orders;
}

// Bounces on the light's own lattice between the series and the last flight.
struct FineBounces {
    int count = 0;
    float share = 0.0f;  // of the light that each replaces
};

// Where orders end at a stated number, the series in `settings` leaves the last of them to these bounces.
FineBounces plan_fine_bounces(const LatticeChoice& series, float error, ScatteringSettings& settings) {
    FineBounces out{count_of_fine_bounces(settings), share_of_fine_bounces(series, settings, error)};
    const bool endless = settings.bounces < 0;
    if (!endless)
        out.count = std::min(out.count, std::max(0, settings.bounces - 2));
    if (!(out.share > 0.0f))
        out.count = 0;
    if (endless || out.count == 0)
        return out;
    settings.bounces -= out.count;
    out.share = 1.0f;
    return out;
}

// The flights on the light's own lattice. The last ends where the light is scattered toward the camera.
class FineFlights {
public:
    // `share`: that of gather_adaptively().
    FineFlights(const LitLattice& lattice, float share, Progress& progress)
        : lattice_(lattice), share_(share), progress_(progress) {}

    HierarchyLights build(ScatteredLight order) const {
        order.sharpen(lattice_.medium().lattice);
        return build_hierarchy(lattice_.medium(), std::move(order), lattice_.input().lighting.levels);
    }

    // Replaces the part `share` of the lights by what scatters after one more flight, with the light that has scattered
    // once. Its far light is gathered at every second node: what scatters on needs no more.
    void bounce(HierarchyLights& lights, const ScatteredLight& once, float share) {
        const MediumLightingInput& input = lattice_.input();
        keeps_maps_ = map_bytes(lights.field(lattice_.pyramid(), input.scattering.alpha, input.lighting, nullptr)) <=
                      input.lighting.memory_limit_bytes;
        ScatteredLight leaving = scattered_light(lattice_.medium(), gather(lights, {"fine", true}), lattice_.needed());
        leaving.add(once, Rgb(1.0f));
        leaving.sharpen(lattice_.medium().lattice);
        ScatteredLight& light = lights.light;
        light.add(light, Rgb(-share));
        light.add(leaving, Rgb(share));
        // Their centres remain, and so do their maps.
        set_intensity(lights.grid, lattice_.medium().lattice, light.intensity,
                      light.directional.empty() ? nullptr : &light.directional);
    }

    // Light of the last flight at the nodes. Keeps the lights themselves, but not always their grid. `order`: its name
    // in the balance.
    Gathered gather_last(HierarchyLights& lights, const std::string& order) { return gather(lights, {order, false}); }

    StageCost cost(const Gathered& sum) const {
        StageCost stage{"light from the smoke (MM)", watch_.seconds(), 0, {}};
        stage.bytes = std::max(maps_.bytes(), most_held(levels_)) + (sum.fluence.size() + sum.scattered.size()) * 4;
        stage.detail = detail_;
        if (!levels_of_bounce_.empty())
            stage.detail["levels_of_fine_bounce"] = level_table(levels_of_bounce_);
        stage.detail["levels"] = level_table(levels_);
        if (!balances_.empty())
            stage.detail["balance"] = balances_;
        return stage;
    }

private:
    struct Flight {
        std::string name;  // in the balance
        bool scatters_on;  // instead of toward the camera
    };

    Gathered gather(HierarchyLights& lights, const Flight& flight) {
        std::vector<LevelCost> costs;
        AdaptiveLight light = gather_unbalanced(lights, flight, costs);
        std::vector<LevelCost>& known = flight.scatters_on ? levels_of_bounce_ : levels_;
        if (known.empty())
            known = costs;
        if (lattice_.input().lighting.energy_balance) {
            BounceBalance balance;
            balance.emitted = 1.0;
            balance_light(lattice_, lights.light, light, balance);
            balances_.push_back(balance_row(balance, flight.name));
        }
        if (flight.scatters_on)
            light.conserve(lattice_.thin_medium().rest());
        return std::move(light.light);
    }

    // Lights of thin media apart from the rest.
    AdaptiveLight gather_unbalanced(HierarchyLights& lights, const Flight& flight, std::vector<LevelCost>& costs) {
        const auto thin = take_thin_medium_lights(lattice_.medium(), lattice_.thin_medium().even_bricks(), lights);
        const MediumLightingInput& input = lattice_.input();
        if (thin) {  // the rest has other centres
            maps_ = {};
            keeps_maps_ = false;
        }
        LatticeRequest request = flight.scatters_on ? lattice_.request() : lattice_.last_request();
        request.least_coarsening = flight.scatters_on ? 1 : 0;
        const LevelLights of_levels(lattice_, lights, input.scattering.alpha, costs, progress_,
                                    keeps_maps_ ? &maps_ : nullptr);
        AdaptiveLight light = gather_adaptively(lattice_, share_, request, of_levels, detail_);
        if (!thin)
            return light;
        LightField of_thin = thin->lights.field(lattice_.pyramid(), input.scattering.alpha, input.lighting, nullptr);
        of_thin.bottom = kFinestThinLights;
        Gathered more = gather_at_nodes(of_thin, request, costs, progress_);
        prepare_interpolation(lattice_.medium().lattice, lattice_.needed(), more);
        light.light.add(more);
        give_back(*thin, lights.light);
        return light;
    }

    const LitLattice& lattice_;
    float share_;
    Progress& progress_;
    Stopwatch watch_;
    ShadowMapCache maps_;
    bool keeps_maps_ = false;
    std::vector<LevelCost> levels_;  // of the first gather toward the camera
    std::vector<LevelCost> levels_of_bounce_;
    nlohmann::ordered_json detail_;  // of the last one
    nlohmann::ordered_json balances_ = nlohmann::ordered_json::array();
};

// The lights of all orders as seen from outside. Light that the camera sees also illuminates the surroundings: light
// scattered once, and all light of the smoke that arrives at the nodes, scattered once more. Where light has a
// direction, or orders are counted, that is not known, and the lights of the last flight replace it.
HierarchyLights exterior_lights_of(const LitLattice& lattice, HierarchyLights last_flight, const ScatteredLight& once,
                                   const Gathered& scattered) {
    const MediumLightingInput& input = lattice.input();
    if (input.directional || input.scattering.bounces >= 0)
        return last_flight;
    ScatteredLight leaving = scattered_light(lattice.medium(), scattered, lattice.needed());
    leaving.add(once, Rgb(1.0f));
    leaving.sharpen(lattice.medium().lattice);
    return build_hierarchy(lattice.medium(), std::move(leaving), input.lighting.levels);
}

Gathered gather_together(const LitLattice& lattice, ScatteredLight orders, const ScatteredLight& once,
                         const FineBounces& bounces, FineFlights& flights, SmokeLight& out, Statistics& statistics,
                         Progress& progress) {
    Gathered sum;
    sum.resize(lattice.node_count(), lattice.input().directional, false);
    HierarchyLights lights = flights.build(std::move(orders));
    for (int k = 0; k < bounces.count; ++k)
        flights.bounce(lights, once, bounces.share);
    sum.add(flights.gather_last(lights, "last"));
    const bool on_surfaces = lattice.input().smoke_on_surfaces;
    if (lattice.lights_exterior(on_surfaces)) {
        out.exterior =
            std::make_unique<ExteriorLights>(lattice, exterior_lights_of(lattice, std::move(lights), once, sum),
                                             on_surfaces, lattice.input().scattering.alpha, statistics);
        out.exterior->light_thin_medium(lattice.last_request(), sum, statistics, progress);
    }
    return sum;
}

Gathered gather_apart(const LitLattice& lattice, std::vector<ScatteredLight> orders, FineFlights& flights,
                      SmokeLight& out, Statistics& statistics, Progress& progress) {
    Gathered sum;
    sum.resize(lattice.node_count(), lattice.input().directional, false);
    for (std::size_t k = 0; k < orders.size(); ++k) {
        HierarchyLights lights = flights.build(std::move(orders[k]));
        Gathered g = flights.gather_last(lights, std::to_string(k + 1));
        const bool on_surfaces = lattice.input().smoke_on_surfaces;
        if (lattice.lights_exterior(on_surfaces)) {
            out.exterior = std::make_unique<ExteriorLights>(lattice, std::move(lights), on_surfaces,
                                                            lattice.input().scattering.alpha, statistics);
            out.exterior->light_thin_medium(lattice.last_request(), g, statistics, progress);
        }
        out.orders.push_back(lattice.source_function(g, LightOrigin::Smoke));
        sum.add(g);
    }
    return sum;
}

}  // namespace

SmokeLight light_from_smoke(const LitLattice& lattice, float share, const ScatteredLight& once, Statistics& statistics,
                            Progress& progress) {
    ScatteringSettings settings = lattice.input().scattering;
    const SeriesLattice series = lattice_of(lattice, once, settings);
    const FineBounces bounces = plan_fine_bounces(series.choice, lattice.input().lighting.error, settings);
    std::vector<ScatteredLight> orders = orders_of_scattering(
        lattice, once, settings, series, bounces.count > 0 ? bounces.share : 0.0f, statistics, progress);
    progress.stage("light from the smoke (MM)");
    FineFlights flights(lattice, share, progress);
    SmokeLight out;
    const Gathered sum =
        lattice.input().orders_apart
            ? gather_apart(lattice, std::move(orders), flights, out, statistics, progress)
            : gather_together(lattice, std::move(orders.front()), once, bounces, flights, out, statistics, progress);
    out.multiple = lattice.source_function(sum, LightOrigin::Smoke);
    statistics.stages.push_back(flights.cost(sum));
    return out;
}

}  // namespace brisance
