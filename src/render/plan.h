// Which ledger cells a frame needs, decided before anything is built.
#pragma once

#include <vector>

#include "medium/medium.h"
#include "render/statistics.h"
#include "shot/shot.h"

namespace brisance {

struct Plan {
    bool emission = false;     // V
    bool single = false;       // MV
    bool multiple = false;     // MM
    bool directional = false;  // anisotropic phase function: directional storage
    std::vector<SkippedPart> skipped;
    std::vector<std::string> cells() const;
};

Plan plan_cells(const Shot& shot, const Medium& medium);

}  // namespace brisance
