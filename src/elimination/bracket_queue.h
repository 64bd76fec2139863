// Who goes next within one round of one block: the heaviest first, of those above a threshold.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "elimination/weight.h"

namespace brisance {

struct Slot {
    std::uint32_t leaf, slot;
};

struct Queued {
    Weight weight;
    std::uint32_t rank;
    Slot at;

    bool operator<(const Queued& b) const { return weight < b.weight || (weight == b.weight && rank < b.rank); }
};

// Buckets of equal width, each sorted when its turn comes. Weights only fall while the queue empties: what has become
// lighter is moved down at little cost, where a heap would pay for every level it passes.
class BracketQueue {
public:
    // For weights above `low`, most of which are not above `high`.
    void reset(Weight low, Weight high) {
        low_ = low;
        per_weight_ = double(kBuckets - 1) / double(std::max<Weight>(high - low, 1));
        top_ = kBuckets;
        empty_ = true;
    }

    void push(const Queued& item) {
        const int bucket = bucket_of(item.weight);
        if (bucket >= top_)
            open_.insert(std::upper_bound(open_.begin(), open_.end(), item), item);
        else
            buckets_[bucket].push_back(item);
        empty_ = false;
    }

    // Hands each item to visit(item), heaviest first, after bringing its weight up to date by weight_of(item). Items no
    // longer above the lowest weight are dropped.
    template <class WeightOf, class Visit>
    void drain(const WeightOf& weight_of, const Visit& visit) {
        while (top_ > 0) {
            open_next(weight_of);
            while (!open_.empty()) {
                const Queued item = open_.back();
                open_.pop_back();
                if (const Weight weight = weight_of(item); weight == item.weight)
                    visit(item);
                else if (weight > low_)
                    push({weight, item.rank, item.at});
            }
        }
    }

    bool empty() const { return empty_; }

private:
    static constexpr int kBuckets = 256;

    int bucket_of(Weight weight) const {
        return static_cast<int>(std::min(double(weight - low_) * per_weight_, double(kBuckets - 1)));
    }

    template <class WeightOf>
    void open_next(const WeightOf& weight_of) {
        --top_;
        for (Queued& item : buckets_[top_]) {
            item.weight = weight_of(item);
            if (item.weight <= low_)
                continue;
            if (const int bucket = bucket_of(item.weight); bucket < top_)
                buckets_[bucket].push_back(item);
            else
                open_.push_back(item);
        }
        buckets_[top_].clear();
        std::sort(open_.begin(), open_.end());
    }

    Weight low_ = 0;
    double per_weight_ = 0.0;
    int top_ = 0;  // the bucket that is open; all above are empty
    bool empty_ = true;
    std::array<std::vector<Queued>, kBuckets> buckets_;
    std::vector<Queued> open_;  // ascending
};

}  // namespace brisance
