// A density over a line that is constant on each of several steps.
#pragma once

#include <algorithm>
#include <vector>

namespace brisance {

class StepDensity {
public:
    void clear() { steps_.clear(); }
    // Steps in ascending order, without overlap; `weight`, at least 0: of the whole step. Those of weight 0 are left
    // out.
    void add(double begin, double end, double weight) {
        if (weight > 0.0 && end > begin)
            steps_.push_back({begin, end, weight, all() + weight});
    }
    bool empty() const { return steps_.empty(); }

    // Of a density that is not empty; `xi` in [0, 1).
    double sample(double xi) const {
        const double x = xi * all();
        const auto found = std::upper_bound(steps_.begin(), steps_.end() - 1, x,
                                            [](double value, const Step& step) { return value < step.cumulative; });
        const double part = (x - (found->cumulative - found->weight)) / found->weight;
        return found->begin + std::clamp(part, 0.0, 1.0) * (found->end - found->begin);
    }
    double pdf(double t) const {
        const auto after = std::upper_bound(steps_.begin(), steps_.end(), t,
                                            [](double value, const Step& step) { return value < step.end; });
        return after == steps_.end() || t < after->begin ? 0.0 : after->weight / (all() * (after->end - after->begin));
    }

private:
    struct Step {
        double begin, end, weight, cumulative;
    };
    double all() const { return steps_.empty() ? 0.0 : steps_.back().cumulative; }

    std::vector<Step> steps_;
};

}  // namespace brisance
