// Which ledger cells a frame needs, and who owns those that have a choice, decided before anything is built.
//
// scattering.method auto looks at the shot and not at the frame, so that no sequence changes its method half way. Boxes
// of haze without any smoke from files are thin and even. If they scatter forward, hierarchies, which keep directions
// to degree 2 only, lose a part of MM and SM (a tenth at g = 0.8) where particles keep the phase function as it is; ray
// lights do too, and without blur, but in the same time with a hundred times the noise. If haze scatters alike to all
// sides hierarchies are right to a percent, and free of noise. Smoke from files is finer and larger than particles can
// fill: there hierarchies are better by far whatever the phase function. MA
// of haze alone goes by the camera's rays too: beams are narrower than the voxels of a box.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/cell.h"
#include "emitters/surroundings.h"
#include "medium/medium.h"
#include "shot/shot.h"
#include "statistics/statistics.h"

namespace brisance {

struct Plan {
    bool emission = false;                                         // V
    bool single = false;                                           // MV
    bool multiple = false;                                         // MM
    bool directional = false;                                      // anisotropic phase function: directional storage
    ScatteringMethod scattering = ScatteringMethod::LightingGrid;  // never Automatic
    bool scattered_lights = false;        // lights in the smoke, rays or points, or particles own MM and SM
    bool emitters_by_rays = false;        // MA by the camera's rays, not at the medium's nodes
    bool reflected_by_particles = false;  // MS by particles alone, without virtual lights
    bool surfaces = false;                // there are some
    bool emitters = false;                // there are lights, emissive surfaces or an environment
    std::array<bool, kCells> needed{};    // the cells that can be other than zero, those above among them
    std::vector<SkippedPart> skipped;
    bool needs(Cell cell) const { return needed[static_cast<int>(cell)]; }
    std::vector<std::string> cells() const;
};

// What it makes, as users read it.
const char* things_of(ScatteringMethod method);

Plan plan_cells(const Shot& shot, const Medium& medium, const Surroundings* surroundings = nullptr);

}  // namespace brisance
