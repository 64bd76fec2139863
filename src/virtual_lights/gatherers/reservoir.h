// Weighted reservoir sampling of one (M.-T. Chao, A General Purpose Unequal Probability Sampling Plan, Biometrika
// 69(3), 1982).
#pragma once

#include "core/rng.h"

namespace brisance {

// One of many, with the probability of its weight among all.
template <class Candidate>
class Reservoir {
public:
    void offer(const Candidate& drawn, double weight, Rng& rng) {
        if (!(weight > 0.0))
            return;
        sum_ += weight;
        if (rng.next_double() * sum_ < weight)
            kept_ = drawn;
    }
    double sum() const { return sum_; }
    const Candidate& kept() const { return kept_; }

private:
    Candidate kept_{};
    double sum_ = 0.0;
};

}  // namespace brisance
