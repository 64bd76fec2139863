// The table of methods that a report knows by name (methods.h).
#pragma once

#include <string>
#include <vector>

#include "methods.h"

namespace brisance {

struct BuiltIn {
    std::string name;
    std::vector<std::string> settings;  // of a shot: KEY=VALUE
    StepsOf steps = StepsOf::Grid;
    CellSet cells;
    bool unbiased = false;
    bool by_default = false;     // a shot that names no method has its cells from this one
    bool scatters_grid = false;  // its MM begins with the lighting grid's MV
};

// Virtual lights come last.
const std::vector<BuiltIn>& built_ins();

}  // namespace brisance
