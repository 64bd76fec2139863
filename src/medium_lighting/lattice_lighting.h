// The lighting of a medium on one lattice: from the medium to the light that scatters toward the camera, and to the
// lights that surfaces see.
//
// Stages, each with one job: the fire's light (fire_light.h, MV), light of surfaces (surface_light.h, MS), light of
// emitters (emitter_light.h, MA), and light that scatters again (smoke_light.h, MM).
#pragma once

#include "medium_lighting/exterior/exterior_lights.h"
#include "medium_lighting/exterior/surface_receiver.h"
#include "medium_lighting/node_sources.h"

namespace brisance {

class LatticeLighting {
public:
    // On the lattice 2^level coarser than the medium's. Keeps what the input refers to. Adds a stage to the statistics
    // for each part of the work.
    LatticeLighting(const MediumLightingInput& input, int level, Statistics& statistics, Progress& progress);

    NodeLighting take_nodes() { return std::move(nodes_); }  // at the nodes of the medium itself

    // Fills `fire` and `smoke` of receivers, as far as the input said that they light surfaces.
    void at_surfaces(std::vector<SurfaceReceiver>& points) const;
    VisibilityRatios fire_visibility() const { return fire_ ? fire_->visibility_ratios() : VisibilityRatios{}; }
    VisibilityRatios smoke_visibility() const { return smoke_ ? smoke_->visibility_ratios() : VisibilityRatios{}; }

private:
    MediumLightingInput input_;
    LitLattice lattice_;
    NodeLighting nodes_;
    std::unique_ptr<ExteriorLights> fire_, smoke_;
};

}  // namespace brisance
