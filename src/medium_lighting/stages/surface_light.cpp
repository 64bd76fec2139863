#include "medium_lighting/stages/surface_light.h"

#include "core/stopwatch.h"
#include "lighting_grid/point_grid.h"
#include "medium_lighting/level_costs.h"
#include "scattering/multiple_scattering.h"

namespace brisance {

namespace {

void add_virtual_lights(const PointsOfSides& sides, const LitLattice& lattice, Gathered& arriving, StageCost& stage,
                        Progress& progress) {
    const LightingSettings& settings = lattice.input().lighting;
    const ExtinctionPyramid* const pyramid = &lattice.pyramid();
    std::vector<LevelCost> costs;
    std::size_t lights = 0;
    // Lights outside of the lattice represent themselves only: no voxel has a share in them.
    const std::vector<float> no_weight(lattice.node_count(), 0.0f);
    // Light from outside fades within a few voxels of the smoke's skin, however far its lights are.
    LatticeRequest request = lattice.request();
    request.interpolates_far_light = false;
    for (const PointLights& side : sides) {
        const LightingGrid grid = build_point_grid(lattice.medium(), side, settings.alpha);
        if (grid.levels.empty())
            continue;
        const LightField field{pyramid,  nullptr, nullptr,           &grid, &no_weight, settings.alpha,
                               settings, nullptr, lattice.surfaces()};
        arriving.add(gather_at_nodes(field, request, costs, progress));
        stage.bytes = std::max(stage.bytes, grid.bytes() + most_held(costs));
        lights += side.size();
    }
    stage.detail = {{"lights", lights}, {"levels", level_table(costs)}};
}

}  // namespace

Gathered light_from_surfaces(const LitLattice& lattice, float share, Statistics& statistics, Progress& progress) {
    progress.stage("light from surfaces (MS)");
    const Stopwatch watch;
    const ReflectedLight& reflected = lattice.input().reflected;
    StageCost stage{"light from surfaces (MS)", 0.0, 0, {}};
    Gathered arriving = lattice.dark();
    if (reflected.lights)
        add_virtual_lights(*reflected.lights, lattice, arriving, stage, progress);
    if (reflected.cast) {
        const Stopwatch particles;
        arriving.add(reflected.cast->on(lattice.medium(), lattice.request(), share, lattice.level()));
        stage.detail["particles"] = reflected.cast->particles(share);
        stage.detail["particle_seconds"] = particles.seconds();
    }
    prepare_interpolation(lattice.medium().lattice, lattice.needed(), arriving);
    stage.seconds = watch.seconds();
    statistics.stages.push_back(std::move(stage));
    return arriving;
}

}  // namespace brisance
