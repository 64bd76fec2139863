// Runs cases through methods.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stability/case.h"

namespace brisance::stability {

struct Result {
    std::string name;
    RenderMethod method = RenderMethod::LightingGrid;
    bool finite = false;              // every value of every layer
    std::optional<double> imbalance;  // collided + escaped - emitted of the worst flight, as gathered
    bool balanced = true;             // the same within 0.5 % and the noise of its measurement, once scaled
    Measured measured;
    double tolerance = 0.0;
    double seconds = 0.0;
    std::string trouble;  // what was thrown; empty: nothing
    bool passed() const;
};

std::string method_name(RenderMethod method);

// One picture and its verdict. Errors of the renderer become `trouble`.
Result run_case(const Case& c, RenderMethod method);

}  // namespace brisance::stability
