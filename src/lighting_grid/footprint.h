// The footprint of a vertex of a coarser lattice: the nodes under its hat, by weight.
#pragma once

#include <vector>

#include "medium/medium.h"

namespace brisance {

// A weight (luminance, extinction, ...) for every node of a medium's lattice.
using NodeWeights = std::vector<float>;

// Picks nodes under the hat of a vertex by systematic sampling in proportion to hat times weight. It keeps scratch
// memory, so each thread needs its own.
class FootprintPicker {
public:
    // Vertices lie at every 2^level-th node.
    FootprintPicker(const Medium& medium, const NodeWeights& weights, int level)
        : medium_(medium), weights_(weights), level_(level) {}

    // Returns `count` picks in node order, or none when nothing has weight.
    const std::vector<ivec3>& pick(const ivec3& vertex, int count);

    struct WeightedPick {
        ivec3 node;
        float weight;  // the mean of weight times f over all picks is that of f over the footprint
    };
    // Picks with a density that follows `importance` (per node, >= 0) except for the share kLeastShare, so that no pick
    // weighs more than the reciprocal of that share.
    const std::vector<WeightedPick>& pick(const ivec3& vertex, int count, const NodeWeights& importance);
    static constexpr float kLeastShare = 0.25f;

private:
    struct Found {
        ivec3 node;
        std::size_t index;  // in the medium's fields
        double passed;      // running sum of weights
    };
    void search(const ivec3& vertex);
    double search_brick(int brick, const ivec3& centre, double passed);

    const Medium& medium_;
    const NodeWeights& weights_;
    int level_;
    std::vector<Found> found_;
    std::vector<ivec3> picks_;
    std::vector<WeightedPick> weighted_picks_;
};

}  // namespace brisance
