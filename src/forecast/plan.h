// Decides, before anything is built, which ledger cells a frame needs and which method computes those that have a
// choice.
#pragma once

#include <string>
#include <vector>

#include "core/cell.h"
#include "emitters/surroundings.h"
#include "fire_lights/samplings.h"
#include "medium/medium.h"
#include "scattering_methods/methods.h"
#include "shot/shot.h"
#include "statistics/statistics.h"
#include "unified_lights/samplings.h"

namespace brisance {

struct Plan {
    bool emission = false;     // V
    bool single = false;       // MV
    bool multiple = false;     // MM
    bool directional = false;  // anisotropic phase function: directional storage
    // The method that computes MM and SM of a picture by many lights, or of one of two that are mixed; null: the
    // lighting grid alone, or nothing scatters twice (scattering_choice.h).
    const ScatteringMethod* scattering_method = nullptr;
    float share_of_method = 0.0f;   // of its picture; the rest is that of the lighting grid
    std::string scattering_choice;  // the method that scattering.method resolved to
    float emitters_by_rays = 0.0f;  // of MA: the share on the camera's rays, not at the medium's nodes
    StageCost choice_cost;          // of the choice; no name: there was none to make
    // How MV and, on the base of surfaces, SV are gathered from the fire's single lights; null: from hierarchies.
    const FireLightSampling* fire_sampling = nullptr;
    // How lights of all kinds are chosen together on surfaces, for SV of the base, SS and SA, and in smoke, if they are
    // (on_rays); null: each by itself.
    const UnifiedLightSampling* unified_sampling = nullptr;
    // Those of MV, MS and MA that single lights send along the camera's rays, so that what nodes hold of them is not
    // seen.
    CellSet on_rays;
    // Of MS: what particles carry of the light that virtual lights would hold.
    float reflected_by_particles = 0.0f;
    bool surfaces = false;  // there are some
    bool emitters = false;  // there are lights, emissive surfaces or an environment
    CellSet needed;         // the cells that can be other than zero, those above among them
    std::vector<SkippedPart> skipped;
    bool lights_on_rays() const { return on_rays != CellSet{}; }
    bool unified_in_smoke() const { return unified_sampling && !fire_sampling && lights_on_rays(); }
    // Whether single lights of the fire own SV of the base.
    bool fire_lights_on_surfaces() const { return fire_sampling || unified_sampling; }
    bool needs(Cell cell) const { return needed.contains(cell); }
    // Whether two pictures are made and mixed: one by scattering_method, one by the lighting grid.
    bool mixed() const { return scattering_method && share_of_method < 1.0f; }
    std::vector<std::string> cells() const;
};

// The plans of the two pictures of a mixed one.
Plan by_lighting_grid(Plan plan);
Plan by_scattering_method(Plan plan);

Plan plan_cells(const Shot& shot, const Medium& medium, const Surroundings* surroundings = nullptr);

}  // namespace brisance
