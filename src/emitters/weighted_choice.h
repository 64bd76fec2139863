// Choosing one of many lights in proportion to weights that are the same for all receivers.
#pragma once

#include <optional>
#include <vector>

#include "emitters/light_tree.h"

namespace brisance {

class WeightedChoice {
public:
    // Not negative. Where their sum is not positive, there is nothing to choose.
    explicit WeightedChoice(std::vector<double> weights);

    // By a number in [0, 1).
    std::optional<LightTree::Choice> choose(double u) const;
    // The probability with which choose() picks that light.
    double probability(std::size_t light) const;
    std::uint64_t bytes() const { return cumulative_.size() * sizeof(double); }

private:
    std::vector<double> cumulative_;  // inclusive; ends at 1
};

}  // namespace brisance
