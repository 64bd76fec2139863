// Renders cases by methods and judges the results.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stability/case.h"

namespace brisance::stability {

struct Result {
    std::string name;
    std::string method;               // its name
    bool finite = false;              // every value of every layer
    std::optional<double> imbalance;  // collided + escaped - emitted of the worst flight, as gathered
    bool balanced = true;             // the same within 0.5 % and the noise of its measurement, once scaled
    Measured measured;
    double tolerance = 0.0;
    bool limit = false;  // the tolerance is that of a method which the case is beyond
    double seconds = 0.0;
    std::string trouble;  // what was thrown; empty: nothing
    bool passed() const;
};

// One picture and its verdict; none where the method owns no cell of the case. Errors of the renderer become `trouble`.
std::optional<Result> run_case(const Case& c, const Method& method);

}  // namespace brisance::stability
