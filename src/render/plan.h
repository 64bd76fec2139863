// Which ledger cells a frame needs, decided before anything is built.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/cell.h"
#include "emitters/surroundings.h"
#include "medium/medium.h"
#include "render/statistics.h"
#include "shot/shot.h"

namespace brisance {

struct Plan {
    bool emission = false;              // V
    bool single = false;                // MV
    bool multiple = false;              // MM
    bool directional = false;           // anisotropic phase function: directional storage
    bool scattered_lights = false;      // virtual lights in the smoke, rays or points, own MM and SM
    bool surfaces = false;              // there are some
    bool emitters = false;              // there are lights, emissive surfaces or an environment
    std::array<bool, kCells> needed{};  // the cells that can be other than zero, those above among them
    std::vector<SkippedPart> skipped;
    bool needs(Cell cell) const { return needed[static_cast<int>(cell)]; }
    std::vector<std::string> cells() const;
};

Plan plan_cells(const Shot& shot, const Medium& medium, const Surroundings* surroundings = nullptr);

}  // namespace brisance
