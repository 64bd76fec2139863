// Which method is best for a cell of a scene, at equal time and at equal error.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "error_curve.h"
#include "report.h"

namespace brisance {

// The errors that a suite reads times off for, from the largest.
constexpr std::array<double, 3> kSuiteTargets = {0.10, 0.05, 0.02};

struct Contender {
    std::string method;
    Reading error;                                    // after Contest::seconds
    std::array<Reading, kSuiteTargets.size()> times;  // [s] to each of kSuiteTargets
    double floor = 0.0;                               // the smallest error that it was measured with
    std::optional<double> flicker;                    // of its first run
    std::optional<double> floor_spread = {};          // standard deviation of `floor` from repeat to repeat
};

struct Contest {
    std::string cell;
    double seconds = 0.0;                 // at which errors are compared (equal_time())
    double noise = 0.0;                   // of the reference: smaller errors are not told apart; 0: not known
    std::vector<Contender> contenders;    // that own the cell and have an error in it
    std::optional<std::size_t> at_time;   // index of the smallest error then
    std::optional<std::size_t> target;    // index of the smallest error of kSuiteTargets that any of them reaches
    std::optional<std::size_t> at_error;  // index of the first to reach it
};

// One for each cell of the reference, in the order of the report's layers; without contenders where it is black.
std::vector<Contest> contests(const Report& report, Clock clock);

// The contender that comes second to the winner at equal time; absent where there is none.
std::optional<std::size_t> second_at_time(const Contest& contest);

}  // namespace brisance
