#include "medium_lighting/first_light.h"

#include "core/stopwatch.h"
#include "medium_lighting/stages/emitter_light.h"
#include "medium_lighting/stages/fire_light.h"
#include "medium_lighting/stages/surface_light.h"

namespace brisance {

namespace {

Gathered light_from_emitters(const LitLattice& lattice, Statistics& statistics, Progress& progress) {
    progress.stage("light from emitters (MA)");
    const Stopwatch watch;
    Gathered arriving = gather_from_emitters(*lattice.input().surroundings, lattice.pyramid(), lattice.request(),
                                             lattice.input().eye, lattice.input().emitters_at_nodes);
    prepare_interpolation(lattice.medium().lattice, lattice.needed(), arriving);
    statistics.stages.push_back({"light from emitters (MA)", watch.seconds(), 0, {}});
    return arriving;
}

}  // namespace

FirstLight first_light(const LitLattice& lattice, float share, Statistics& statistics, Progress& progress) {
    const MediumLightingInput& input = lattice.input();
    FirstLight out;
    Gathered first;
    if (input.fire) {
        FireLight fire = light_from_fire(lattice, share, statistics, progress);
        first = std::move(fire.arriving);
        out.sources.single = std::move(fire.single);
        out.fire = std::move(fire.exterior);
    } else {
        first = lattice.dark();
    }
    if ((input.reflected.lights || input.reflected.cast) && input.surfaces_on_medium) {
        const Gathered arriving = light_from_surfaces(lattice, first, share, statistics, progress);
        out.sources.from_surfaces = lattice.source_function(arriving, LightOrigin::Outside);
        first.add(arriving);
    }
    if (input.surroundings && input.emitters_on_medium) {
        const Gathered arriving = light_from_emitters(lattice, statistics, progress);
        out.sources.from_emitters = lattice.source_function(arriving, LightOrigin::Outside);
        out.sources.emitters_at_nodes = input.emitters_at_nodes;
        first.add(arriving);
    }
    if (input.multiple)
        out.once = scattered_light(lattice.medium(), first, lattice.needed());
    return out;
}

}  // namespace brisance
