// The lighting of a medium: from the medium to the light that scatters toward the camera, and to the lights that
// surfaces see.
//
// Light that has not scattered yet (first_light.h) and light of the smoke (smoke_light.h) live on lattices of their
// own, each as coarse as its error allows (lighting_level.h). Where the next coarser one is nearly good enough, its
// light replaces that of the finer one step by step, so that no lattice is left at once.
#pragma once

#include <memory>
#include <vector>

#include "medium_lighting/exterior/exterior_lights.h"
#include "medium_lighting/exterior/surface_receiver.h"
#include "medium_lighting/levels/lighting_level.h"
#include "medium_lighting/node_sources.h"

namespace brisance {

class MediumLighting {
public:
    // Keeps what the input refers to. Adds a stage to the statistics for each part of the work.
    MediumLighting(const MediumLightingInput& input, Statistics& statistics, Progress& progress);

    const NodeLighting& at_nodes() const { return nodes_; }

    bool lights_surfaces() const { return input_.fire_on_surfaces || input_.smoke_on_surfaces; }
    // Fills `fire` and `smoke` of receivers, as far as the input said that they light surfaces.
    void at_surfaces(std::vector<SurfaceReceiver>& points) const;
    VisibilityRatios fire_visibility() const { return visibility_of(&SurfaceReceiver::fire); }
    VisibilityRatios smoke_visibility() const { return visibility_of(&SurfaceReceiver::smoke); }

private:
    using Slot = std::array<Rgb, 2> SurfaceReceiver::*;
    using Lattice = std::shared_ptr<const LitLattice>;
    class Stages;

    // Lights as surfaces see them, of one lattice.
    struct SeenFromOutside {
        Lattice lattice;
        Slot slot;
        float share;  // of the light in the slot
        std::unique_ptr<ExteriorLights> lights;
    };

    VisibilityRatios visibility_of(Slot slot) const;
    void add_at_surfaces(const LitLattice& lattice, std::vector<SurfaceReceiver>& points) const;

    MediumLightingInput input_;
    NodeLighting nodes_;
    std::vector<SeenFromOutside> seen_from_outside_;  // of a slot, the finest lattice first
};

}  // namespace brisance
