#include "medium_lighting/lattice_lighting.h"

#include <algorithm>

#include "core/stopwatch.h"
#include "medium_lighting/exterior/point_receivers.h"
#include "medium_lighting/stages/emitter_light.h"
#include "medium_lighting/stages/fire_light.h"
#include "medium_lighting/stages/smoke_light.h"
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

// Settings count levels from the medium's own lattice.
MediumLightingInput with_levels_above(MediumLightingInput input, int level) {
    if (int& levels = input.lighting.levels; levels > 0)
        levels = std::max(1, levels - level);
    if (int& scattering = input.scattering.lattice_level; scattering >= 0)
        scattering = std::max(0, scattering - level);
    return input;
}

}  // namespace

LatticeLighting::LatticeLighting(const MediumLightingInput& input, int level, Statistics& statistics,
                                 Progress& progress)
    : input_(with_levels_above(input, level)), lattice_(input_, level) {
    Gathered first;
    if (input.fire) {
        FireLight fire = light_from_fire(lattice_, statistics, progress);
        first = std::move(fire.arriving);
        nodes_.single = std::move(fire.single);
        fire_ = std::move(fire.exterior);
    } else {
        first = lattice_.dark();
    }
    if ((input.reflected.lights || input.reflected.cast) && input.surfaces_on_medium) {
        const Gathered arriving = light_from_surfaces(lattice_, statistics, progress);
        nodes_.from_surfaces = lattice_.source_function(arriving);
        first.add(arriving);
    }
    if (input.surroundings && input.emitters_on_medium) {
        const Gathered arriving = light_from_emitters(lattice_, statistics, progress);
        nodes_.from_emitters = lattice_.source_function(arriving);
        nodes_.emitters_at_nodes = input.emitters_at_nodes;
        first.add(arriving);
    }
    if (input.multiple) {
        SmokeLight smoke = light_from_smoke(lattice_, first, statistics, progress);
        nodes_.multiple = std::move(smoke.multiple);
        nodes_.orders = std::move(smoke.orders);
        smoke_ = std::move(smoke.exterior);
    }
}

void LatticeLighting::at_surfaces(std::vector<SurfaceReceiver>& points) const {
    if (points.empty())
        return;
    std::vector<ReceiverPoint> at;
    at.reserve(points.size());
    for (const SurfaceReceiver& p : points)
        at.push_back({p.local, p.normal});
    std::vector<std::uint32_t> order;
    const Receivers receivers = point_receivers(lattice_.medium(), at, order);
    const std::size_t n = order.size();
    const auto gather = [&](const std::unique_ptr<ExteriorLights>& lights, std::array<Rgb, 2> SurfaceReceiver::*slot) {
        if (!lights)
            return;
        const std::array<Gathered, 2> arriving = lights->at_surfaces(receivers);
        // Scaled by the balance of what escapes, not of what collides.
        for (int part = 0; part < 2; ++part)
            for (std::size_t i = 0; i < n && !arriving[part].scattered.empty(); ++i)
                for (int c = 0; c < 3; ++c)
                    (points[order[i]].*slot)[part][c] = lights->escape_scale()[c] * arriving[part].scattered[c * n + i];
    };
    if (input_.fire_on_surfaces)
        gather(fire_, &SurfaceReceiver::fire);
    if (input_.smoke_on_surfaces)
        gather(smoke_, &SurfaceReceiver::smoke);
}

}  // namespace brisance
