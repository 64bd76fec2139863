// Decides, before anything is built, which ledger cells a frame needs and which method computes those that have a
// choice.
//
// scattering.method auto depends on the shot and not on the frame, so that no sequence changes its method half way.
// Boxes of haze without smoke from files are thin and homogeneous. If they scatter forward, hierarchies, which keep
// directions to degree 2 only, lose a part of MM and SM (a tenth at g = 0.8), whereas volumetric photons use the exact
// phase function. Ray lights do, too, and without blur, but have a hundred times the noise in the same time. If haze
// scatters almost isotropically, hierarchies are right to a percent and free of noise. Smoke from files is finer and
// larger than photons can resolve: there hierarchies are far better whatever the phase function. MA of haze alone is
// also estimated along the camera's rays, as beams of light are narrower than the voxels of a box.
#pragma once

#include <string>
#include <vector>

#include "core/cell.h"
#include "emitters/surroundings.h"
#include "medium/medium.h"
#include "scattering_methods/methods.h"
#include "shot/shot.h"
#include "statistics/statistics.h"

namespace brisance {

struct Plan {
    bool emission = false;     // V
    bool single = false;       // MV
    bool multiple = false;     // MM
    bool directional = false;  // anisotropic phase function: directional storage
    // The method that computes MM and SM of a picture by many lights; null: the lighting grid, or nothing scatters
    // twice.
    const ScatteringMethod* scattering_method = nullptr;
    std::string scattering_choice;  // the method that scattering.method resolved to
    bool emitters_by_rays = false;  // MA on the camera's rays, not at the medium's nodes
    // Of MS: what particles carry of the light that virtual lights would hold.
    float reflected_by_particles = 0.0f;
    bool surfaces = false;  // there are some
    bool emitters = false;  // there are lights, emissive surfaces or an environment
    CellSet needed;         // the cells that can be other than zero, those above among them
    std::vector<SkippedPart> skipped;
    bool needs(Cell cell) const { return needed.contains(cell); }
    std::vector<std::string> cells() const;
};

Plan plan_cells(const Shot& shot, const Medium& medium, const Surroundings* surroundings = nullptr);

}  // namespace brisance
