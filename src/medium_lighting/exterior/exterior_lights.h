// The lights of fire or smoke as seen from outside of dense smoke: by surfaces, and by nodes of thin media.
//
// The flux through a sphere around the medium is balanced against rays that measure how much of the light escapes.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "medium_lighting/exterior/visibility_ratio.h"
#include "medium_lighting/lit_lattice.h"
#include "scattering/multiple_scattering.h"
#include "statistics/statistics.h"
#include "thin_media/thin_medium_lights.h"

namespace brisance {

// Distributions from which surfaces sample points to find how much of the light other surfaces occlude: of dense smoke,
// and of thin media. Null where there is no such light.
using VisibilityRatios = std::array<const VisibilityRatio*, 2>;

class ExteriorLights {
public:
    // Keeps a reference to the lattice. `for_surfaces`: not for nodes of thin media alone. `alpha`: of the blends
    // between levels. Adds stages to the statistics.
    ExteriorLights(const LitLattice& lattice, HierarchyLights lights, bool for_surfaces, float alpha,
                   Statistics& statistics);
    ExteriorLights(const ExteriorLights&) = delete;
    ExteriorLights& operator=(const ExteriorLights&) = delete;

    // Replaces the light gathered from the lattice itself at nodes of thin media. `request`: of that gather.
    void light_thin_medium(const LatticeRequest& request, Gathered& gathered, Statistics& statistics,
                           Progress& progress) const;

    // At receivers on surfaces, if they are for surfaces (point_receivers.h): of dense smoke, and of thin media, empty
    // where they have no lights of their own. Planar over the receivers; to be scaled by escape_scale().
    std::array<Gathered, 2> at_surfaces(const Receivers& receivers) const;
    Rgb escape_scale() const { return escape_scale_; }

    VisibilityRatios visibility_ratios() const { return {ratio_.get(), thin_ratio_.get()}; }

private:
    NodeWeights escape_probabilities() const;
    void part_thin_medium(float alpha);
    void keep_for_exterior(float alpha);
    void balance_escape(const dvec3& power, const EscapeEstimate& escape, Statistics& statistics);

    const LitLattice& lattice_;
    bool for_surfaces_;
    HierarchyLights lights_;
    NodeWeights escape_;                      // per node: how likely its light is to leave the medium
    LightingGrid for_thin_;                   // levels that thin media need, where surfaces need fewer
    std::unique_ptr<ThinMediumLights> thin_;  // lights of thin media, apart from the rest; or none
    std::unique_ptr<VisibilityRatio> ratio_, thin_ratio_;
    ShadowMapCache maps_;
    LightField field_;
    GridLevel bottom_;
    Rgb escape_scale_{1.0f};
};

}  // namespace brisance
