#include "medium_lighting/stages/fire_light.h"

#include "core/stopwatch.h"
#include "lighting_grid/voxel_lights.h"
#include "medium_lighting/adaptive_gather.h"
#include "medium_lighting/balance_table.h"
#include "medium_lighting/level_costs.h"

namespace brisance {

namespace {

HierarchyLights build_fire_lights(const LitLattice& lattice, Statistics& statistics, Progress& progress) {
    progress.stage("fire to lights");
    const Stopwatch watch;
    const Medium& medium = lattice.medium();
    const LightingSettings& settings = lattice.input().lighting;
    ScatteredLight fire{lattice.fire_lights(), {}};
    HierarchyLights lights = settings.clusters > 0 ? build_lamps(medium, std::move(fire), settings.clusters)
                                                   : build_hierarchy(medium, std::move(fire), settings.levels);
    const double emitted = luminance(Rgb(total(lights.light.intensity)));
    statistics.stages.push_back(
        {"lights and hierarchy",
         watch.seconds(),
         lights.grid.bytes(),
         {{"intensity_sum", emitted}, {"lattice_and_pyramid_bytes", lattice.pyramid().bytes()}}});
    return lights;
}

AdaptiveLight gather_at_lattice(const LitLattice& lattice, float share, const HierarchyLights& lights,
                                Statistics& statistics, Progress& progress) {
    const Stopwatch watch;
    const LightingSettings& settings = lattice.input().lighting;
    StageCost stage{"light from the fire (MV)", 0.0, 0, {}};
    std::vector<LevelCost> costs;
    AdaptiveLight arriving = gather_adaptively(
        lattice, share, lattice.request(), LevelLights(lattice, lights, settings.alpha, costs, progress), stage.detail);
    if (settings.energy_balance) {
        BounceBalance balance;
        balance.emitted = 1.0;
        balance_light(lattice, lights.light, arriving, balance);
        stage.detail["balance"].push_back(balance_row(balance, "0"));
    }
    stage.bytes = most_held(costs) + arriving.light.bytes();
    stage.detail["levels"] = level_table(costs);
    stage.seconds = watch.seconds();
    statistics.stages.push_back(stage);
    return arriving;
}

}  // namespace

FireLight light_from_fire(const LitLattice& lattice, float share, Statistics& statistics, Progress& progress) {
    FireLight out;
    const bool at_nodes = lattice.input().single;
    HierarchyLights lights = build_fire_lights(lattice, statistics, progress);
    progress.stage("light from the fire (MV)");
    AdaptiveLight arriving;
    if (at_nodes)
        arriving = gather_at_lattice(lattice, share, lights, statistics, progress);
    const bool on_surfaces = lattice.input().fire_on_surfaces;
    if (lattice.lights_exterior(on_surfaces))
        out.exterior = std::make_unique<ExteriorLights>(lattice, std::move(lights), on_surfaces,
                                                        lattice.input().lighting.alpha, statistics);
    if (!at_nodes) {
        out.arriving = lattice.dark();
        return out;
    }
    if (out.exterior)
        out.exterior->light_thin_medium(lattice.request(), arriving.light, statistics, progress);
    const Stopwatch watch;
    out.single = lattice.source_function(arriving.light, LightOrigin::Fire);
    statistics.stages.push_back(
        {"light of the fire at the volume's nodes (MV)", watch.seconds(), out.single.size() * sizeof(Rgb), {}});
    arriving.conserve(lattice.thin_medium().rest());
    out.arriving = std::move(arriving.light);
    return out;
}

}  // namespace brisance
