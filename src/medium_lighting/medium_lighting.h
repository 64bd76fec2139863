// The lighting of a medium, on a lattice as coarse as its error allows (lighting_level.h). Where the next coarser
// one is nearly good enough, its light replaces that of the finer one step by step, so that no lattice is left at once.
#pragma once

#include <memory>

#include "medium_lighting/lattice_lighting.h"

namespace brisance {

class MediumLighting {
public:
    // Keeps what the input refers to. Adds a stage to the statistics for each part of the work.
    MediumLighting(const MediumLightingInput& input, Statistics& statistics, Progress& progress);

    const NodeLighting& at_nodes() const { return nodes_; }

    bool lights_surfaces() const { return input_.fire_on_surfaces || input_.smoke_on_surfaces; }
    // Fills `fire` and `smoke` of receivers, as far as the input said that they light surfaces.
    void at_surfaces(std::vector<SurfaceReceiver>& points) const;
    VisibilityRatios fire_visibility() const { return lighting_->fire_visibility(); }
    VisibilityRatios smoke_visibility() const { return lighting_->smoke_visibility(); }

private:
    MediumLightingInput input_;
    float share_of_coarser_ = 0.0f;
    std::unique_ptr<LatticeLighting> lighting_, coarser_;  // the second null: no share
    NodeLighting nodes_;
};

}  // namespace brisance
