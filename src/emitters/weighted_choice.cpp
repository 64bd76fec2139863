#include "emitters/weighted_choice.h"

#include <algorithm>
#include <utility>

namespace brisance {

WeightedChoice::WeightedChoice(std::vector<double> weights) : cumulative_(std::move(weights)) {
    double sum = 0.0;
    for (double& c : cumulative_)
        c = sum += c;
    if (!(sum > 0.0))
        cumulative_.clear();
    for (double& c : cumulative_)
        c /= sum;
}

std::optional<LightTree::Choice> WeightedChoice::choose(double u) const {
    if (cumulative_.empty())
        return std::nullopt;
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, u);
    const auto light = static_cast<std::size_t>(found - cumulative_.begin());
    return LightTree::Choice{light, probability(light)};
}

double WeightedChoice::probability(std::size_t light) const {
    if (cumulative_.empty())
        return 0.0;
    return cumulative_[light] - (light > 0 ? cumulative_[light - 1] : 0.0);
}

}  // namespace brisance
