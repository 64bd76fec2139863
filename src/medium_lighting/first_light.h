// Light that has not scattered in the smoke before, on one lattice: what of it scatters toward the camera, what it
// scatters into as the first order, and the fire's lights as surfaces see them.
//
// Stages, each with one job: the fire's light (fire_light.h, MV), light of surfaces (surface_light.h, MS), and light of
// emitters (emitter_light.h, MA).
#pragma once

#include "medium_lighting/exterior/exterior_lights.h"
#include "medium_lighting/node_sources.h"

namespace brisance {

struct FirstLight {
    NodeSources sources;                   // at the nodes of the medium itself; `multiple` is empty
    ScatteredLight once;                   // leaving the nodes of the lattice; empty where nothing scatters again
    std::unique_ptr<ExteriorLights> fire;  // where LitLattice::lights_exterior(), or null
};

// Adds a stage to the statistics for each part of the work. What is returned refers to the lattice.
// `share`: that of gather_adaptively().
FirstLight first_light(const LitLattice& lattice, float share, Statistics& statistics, Progress& progress);

}  // namespace brisance
