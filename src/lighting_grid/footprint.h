// The footprint of a vertex of a coarser lattice: the nodes under its hat, by weight.
#pragma once

#include <vector>

#include "medium/medium.h"

namespace brisance {

// A weight (luminance, extinction, ...) for every node of a medium's lattice.
using NodeWeights = std::vector<float>;

// Sums of weights over the bricks of a medium's lattice.
using BrickWeights = std::vector<double>;
BrickWeights sum_over_bricks(const Medium& medium, const NodeWeights& weights);

// Picks nodes under the hat of a vertex by systematic sampling in proportion to hat times weight. It keeps scratch
// memory, so each thread needs its own.
class FootprintPicker {
public:
    // Vertices lie at every 2^level-th node. With `bricks`, the sums of `weights`, footprints of whole bricks are
    // searched brick by brick: their cost is that of bricks, and the hat counts as constant over each. Not for picks by
    // importance, which varies within a brick.
    FootprintPicker(const Medium& medium, const NodeWeights& weights, int level, const BrickWeights* bricks = nullptr)
        : medium_(medium), weights_(weights), bricks_(level >= kLevelOfWholeBricks ? bricks : nullptr), level_(level) {}
    static constexpr int kLevelOfWholeBricks = 4;  // the hat spans four bricks per axis, and ends where they do

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
        ivec3 node;         // or a brick's first
        std::size_t index;  // in the medium's fields, or of the brick
        double passed;      // running sum of weights
    };
    void search(const ivec3& vertex);
    double search_brick(int brick, const ivec3& centre, double passed);
    double find_whole_brick(int brick, const ivec3& centre, double passed);
    // The node of a brick below which lies this share of its weight.
    ivec3 node_at(std::size_t brick, double share) const;

    const Medium& medium_;
    const NodeWeights& weights_;
    const BrickWeights* bricks_;
    int level_;
    std::vector<Found> found_;
    std::vector<ivec3> picks_;
    std::vector<WeightedPick> weighted_picks_;
};

}  // namespace brisance
