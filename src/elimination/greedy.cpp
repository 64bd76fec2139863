#include "elimination/greedy.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>

#include "core/parallel.h"
#include "elimination/leaf_kernels.h"

namespace brisance {

namespace {

constexpr std::size_t kLeastBlock = 256, kGreatestBlock = 4096;  // leaves that one task works on
constexpr std::size_t kBlocks = 32;                              // unless those would be too small or too large
constexpr double kOverlap = 1.5;              // neighbours above the same round's threshold, on average
constexpr double kRepack = 0.3;               // leaves are refilled when this share of the points is left
constexpr std::size_t kSampledLeaves = 1024;  // from which a round's threshold is read

struct Removal {
    Weight weight;  // when it went
    std::uint32_t rank;
    std::uint32_t position_in_list;  // in the list of remaining points
};

// The effect of a removal near a border: the weights to subtract from a leaf of another block after the round.
struct Message {
    std::uint32_t leaf;
    vec3 position;
};

// A range of leaves with copies of the leaves around it from the beginning of the round.
struct Block {
    std::uint32_t first = 0, owned = 0;     // the range
    std::vector<Leaf> leaves;               // owned ones, then copies
    std::vector<std::uint32_t> copied;      // ascending: which leaves the copies are of
    std::vector<std::uint32_t> near;        // blocks that own them
    std::vector<std::uint32_t> list_begin;  // per owned leaf, into `list`
    std::vector<std::uint32_t> list;        // leaves of this block that may hold neighbours
    std::vector<float> square_reach;        // per leaf, see LeafView
    std::vector<std::uint8_t> changed;      // per owned leaf: whether this round has changed it
    std::vector<std::uint16_t> waiting;     // per owned leaf, a bit per slot: held up for this round
    std::vector<Slot> path;                 // from a point to heavier and heavier neighbours
    bool idle = true;                       // whether this round has found nobody above the threshold
    std::vector<Message> outbox;
    std::vector<Removal> removed;
    Taken taken;

    bool waits(const Slot& at) const { return waiting[at.leaf] >> at.slot & 1; }
    bool owns(std::uint32_t leaf) const { return leaf - first < owned; }
    std::span<const std::uint32_t> neighbours(std::uint32_t leaf) const {
        return std::span(list).subspan(list_begin[leaf], list_begin[leaf + 1] - list_begin[leaf]);
    }
};

void sort_unique(std::vector<std::uint32_t>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

std::uint32_t position_in(const std::vector<std::uint32_t>& ascending, std::uint32_t value) {
    return static_cast<std::uint32_t>(std::lower_bound(ascending.begin(), ascending.end(), value) - ascending.begin());
}

// Keeps the removals that the one-by-one algorithm would make first.
void keep_greatest(std::vector<Removal>& removed, std::size_t count) {
    const auto last = removed.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(removed.begin(), last, removed.end(), [](const Removal& a, const Removal& b) {
        return a.weight > b.weight || (a.weight == b.weight && a.rank > b.rank);
    });
    removed.erase(last, removed.end());
}

// The remaining candidates, packed into leaves, and the rounds in which they are removed.
class Rounds {
public:
    Rounds(const Candidates& candidates, const std::vector<std::uint32_t>& alive, float scale, float least);

    // Removes points above a falling threshold until `goal` have been removed or so many that leaves are nearly empty;
    // appends to `removed`. Once the goal is reached all above the threshold have gone, and none below it.
    void run(std::size_t goal, Weight& threshold, std::vector<Removal>& removed);

private:
    void find_neighbours(Block& block, const LeafTree& tree) const;
    void remove_heaviest(Block& block, Weight threshold);
    void climb(Block& block, Weight threshold);
    static void hold(Block& block);
    std::optional<Slot> remove(Block& block, const Slot& at);
    void receive(Block& block);
    void refresh(Block& block);
    void round(Weight threshold);
    double mean_neighbours() const;
    double round_share(std::size_t left) const;
    Weight quantile(double share);
    void remove_weightless(std::size_t count, std::vector<Removal>& removed);

    template <class Function>
    void for_each_block(const Function& f) {
        parallel_for(blocks_.size(), [&](std::size_t b) { f(blocks_[b]); });
    }

    const std::vector<std::uint32_t>& alive_;
    float least_;
    double neighbours_ = 1.0;  // of a point, on average
    std::size_t block_leaves_ = 0;
    std::vector<Block> blocks_;
    std::vector<Weight> sample_;
};

Rounds::Rounds(const Candidates& candidates, const std::vector<std::uint32_t>& alive, float scale, float least)
    : alive_(alive), least_(least) {
    const LeafTree tree = boxes_around(candidates, alive, scale);
    block_leaves_ = std::clamp(tree.size() / kBlocks, kLeastBlock, kGreatestBlock);
    blocks_.resize((tree.size() + block_leaves_ - 1) / block_leaves_);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        blocks_[b].first = static_cast<std::uint32_t>(b * block_leaves_);
        blocks_[b].owned =
            static_cast<std::uint32_t>(std::min(tree.size(), (b + 1) * block_leaves_) - b * block_leaves_);
    }
    for_each_block([&](Block& block) {
        find_neighbours(block, tree);
        block.leaves.reserve(block.owned + block.copied.size());
        for (std::uint32_t l = 0; l < block.owned; ++l)
            block.leaves.push_back(make_leaf(candidates, alive, block.first + l, scale));
        for (const std::uint32_t l : block.copied)
            block.leaves.push_back(make_leaf(candidates, alive, l, scale));
        for (const Leaf& leaf : block.leaves)
            block.square_reach.push_back(
                square_reach(*std::min_element(leaf.inverse_reach, leaf.inverse_reach + kLeafSize)));
        for (std::uint32_t l = 0; l < block.owned; ++l)
            sum_weights(block.leaves.data(), l, block.neighbours(l), least_);
        block.changed.assign(block.owned, 1);
    });
    for_each_block([&](Block& block) { refresh(block); });
    neighbours_ = mean_neighbours();
}

// Averages over some points; at least 1.
double Rounds::mean_neighbours() const {
    double sum = 0.0, points = 0.0;
    for (const Block& block : blocks_)
        for (std::uint32_t l = 0; l < block.owned; l += 128) {
            sum += double(count_in_reach(block.leaves.data(), block.neighbours(l), block.leaves[l]));
            points += 1.0;
        }
    return std::max(1.0, sum / std::max(points, 1.0));
}

void Rounds::find_neighbours(Block& block, const LeafTree& tree) const {
    std::vector<std::uint32_t> found;
    block.list_begin.push_back(0);
    for (std::uint32_t l = block.first; l < block.first + block.owned; ++l) {
        tree.find(tree.leaf(l), found);
        block.list.insert(block.list.end(), found.begin(), found.end());
        block.list_begin.push_back(static_cast<std::uint32_t>(block.list.size()));
        std::copy_if(found.begin(), found.end(), std::back_inserter(block.copied),
                     [&](std::uint32_t other) { return !block.owns(other); });
    }
    sort_unique(block.copied);
    for (std::uint32_t& l : block.list)
        l = block.owns(l) ? l - block.first : block.owned + position_in(block.copied, l);
    for (const std::uint32_t l : block.copied)
        block.near.push_back(l / block_leaves_);
    sort_unique(block.near);
}

// Visits the block's points above the threshold from neighbour to neighbour, not by weight, which keeps the cache warm:
// from each point up to heavier and heavier ones until one may be removed, and back. Points with a heavier neighbour in
// another block wait for the next round.
void Rounds::remove_heaviest(Block& block, Weight threshold) {
    block.idle = true;
    block.waiting.assign(block.owned, 0);
    for (std::uint32_t l = 0; l < block.owned; ++l)
        for (std::uint32_t s = 0; s < kLeafSize; ++s) {
            if (block.leaves[l].weight[s] <= threshold)
                continue;
            block.idle = false;
            if (!block.waits({l, s}))
                block.path.push_back({l, s});
            while (!block.path.empty())
                climb(block, threshold);
        }
}

// One step from the end of the path.
void Rounds::climb(Block& block, Weight threshold) {
    const Slot at = block.path.back();
    const bool above = block.leaves[at.leaf].weight[at.slot] > threshold;
    const std::optional<Slot> heavier = above ? remove(block, at) : std::nullopt;
    if (!heavier)
        block.path.pop_back();
    else if (heavier->leaf < block.owned && !block.waits(*heavier))
        block.path.push_back(*heavier);
    else
        hold(block);
}

// Marks the points on the path, none of which can be removed before the end of the round.
void Rounds::hold(Block& block) {
    for (const Slot& at : block.path)
        block.waiting[at.leaf] |= static_cast<std::uint16_t>(1u << at.slot);
    block.path.clear();
}

// Removes the point, unless a heavier neighbour must be removed first: then returns the heaviest one.
std::optional<Slot> Rounds::remove(Block& block, const Slot& at) {
    const auto [l, s] = at;
    Leaf& leaf = block.leaves[l];
    const Probe probe{vec3(leaf.x[s], leaf.y[s], leaf.z[s]), leaf.inverse_reach[s], leaf.weight[s], leaf.rank[s]};
    const std::span<const std::uint32_t> list = block.neighbours(l);
    leaf.clear(s);
    const LeafView view{block.leaves.data(), block.square_reach.data()};
    if (const std::optional<Slot> heavier = take_weights(view, list, probe, least_, block.taken)) {
        leaf.set(s, probe.position, probe.inverse_reach, probe.rank, probe.weight);
        return heavier;
    }
    for (std::size_t n = 0; n < list.size(); ++n) {
        if (!block.taken.touched[n])
            continue;
        if (list[n] < block.owned) {
            subtract(block.leaves[list[n]], block.taken.weight.data() + n * kLeafSize);
            block.changed[list[n]] = 1;
        } else {
            block.outbox.push_back({block.copied[list[n] - block.owned], probe.position});
        }
    }
    block.changed[l] = 1;
    const auto position_in_list = static_cast<std::uint32_t>((block.first + l) * kLeafSize + s);
    block.removed.push_back({probe.weight, probe.rank, position_in_list});
    return {};
}

void Rounds::receive(Block& block) {
    for (const std::uint32_t other : block.near)
        for (const Message& message : blocks_[other].outbox)
            if (block.owns(message.leaf)) {
                subtract(block.leaves[message.leaf - block.first], message.position, least_);
                block.changed[message.leaf - block.first] = 1;
            }
}

void Rounds::refresh(Block& block) {
    for (std::size_t c = 0; c < block.copied.size(); ++c) {
        const Block& other = blocks_[block.copied[c] / block_leaves_];
        if (other.changed[block.copied[c] - other.first])
            block.leaves[block.owned + c] = other.leaves[block.copied[c] - other.first];
    }
}

// A round takes three steps, because no block may read what another block is changing.
void Rounds::round(Weight threshold) {
    for_each_block([&](Block& block) {
        block.outbox.clear();
        std::fill(block.changed.begin(), block.changed.end(), std::uint8_t(0));
        remove_heaviest(block, threshold);
    });
    for_each_block([&](Block& block) { receive(block); });
    for_each_block([&](Block& block) { refresh(block); });
}

// The weight that about `share` of the points exceed.
Weight Rounds::quantile(double share) {
    sample_.clear();
    const std::size_t leaves = (alive_.size() + kLeafSize - 1) / kLeafSize;
    for (std::size_t l = 0; l < leaves; l += (leaves + kSampledLeaves - 1) / kSampledLeaves)
        for (const Weight weight : blocks_[l / block_leaves_].leaves[l % block_leaves_].weight)
            if (weight >= 0)
                sample_.push_back(weight);
    if (sample_.empty())
        return 0;
    const auto at = sample_.begin() + static_cast<std::ptrdiff_t>(share * double(sample_.size() - 1));
    std::nth_element(sample_.begin(), at, sample_.end(), std::greater<>());
    return *at;
}

// Removes points when none has neighbours any more, so that ranks alone decide.
void Rounds::remove_weightless(std::size_t count, std::vector<Removal>& removed) {
    std::vector<Removal> left;
    for (const Block& block : blocks_)
        for (std::size_t l = 0; l < block.owned; ++l)
            for (std::size_t s = 0; s < kLeafSize; ++s)
                if (block.leaves[l].weight[s] >= 0)
                    left.push_back(
                        {0, block.leaves[l].rank[s], static_cast<std::uint32_t>((block.first + l) * kLeafSize + s)});
    keep_greatest(left, count);
    removed.insert(removed.end(), left.begin(), left.end());
}

// Among the points above a round's threshold few should be neighbours, because across a border between blocks the
// lighter of two waits for the next round.
double Rounds::round_share(std::size_t left) const {
    return std::min(kOverlap * double(alive_.size()) / (neighbours_ * double(left)), 0.5);
}

void Rounds::run(std::size_t goal, Weight& threshold, std::vector<Removal>& removed) {
    const std::size_t before = removed.size();
    bool idle = false;  // nobody above the threshold
    for (;;) {
        const std::size_t left = alive_.size() - (removed.size() - before);
        if (removed.size() >= goal ? idle : double(left) < kRepack * double(alive_.size()))
            return;
        if (removed.size() < goal) {
            if (idle && threshold == 0)
                return remove_weightless(goal - removed.size(), removed);
            const double share = std::min(round_share(left), double(goal - removed.size()) / double(left));
            threshold = std::max<Weight>(std::min(threshold - idle, quantile(share)), 0);
        }
        round(threshold);
        idle = true;
        for (Block& block : blocks_) {
            idle = idle && block.idle;
            removed.insert(removed.end(), block.removed.begin(), block.removed.end());
            block.removed.clear();
        }
    }
}

}  // namespace

std::vector<std::uint32_t> eliminate_greedily(const Candidates& candidates, std::vector<std::uint32_t> alive,
                                              std::size_t target, float scale, float least) {
    if (alive.size() <= target)
        return alive;
    const std::size_t goal = alive.size() - target;
    std::vector<bool> gone(candidates.size());
    std::vector<Removal> removed;
    Weight threshold = std::numeric_limits<Weight>::max();
    std::vector<std::uint32_t> left = alive;
    while (removed.size() < goal) {
        const std::size_t before = removed.size();
        Rounds(candidates, left, scale, least).run(goal, threshold, removed);
        for (std::size_t r = before; r < removed.size(); ++r) {
            removed[r].position_in_list = left[removed[r].position_in_list];  // among all candidates from now on
            gone[removed[r].position_in_list] = true;
        }
        std::erase_if(left, [&](std::uint32_t i) { return gone[i]; });
    }
    for (const Removal& r : removed)
        gone[r.position_in_list] = false;
    keep_greatest(removed, goal);  // the others are restored
    for (const Removal& r : removed)
        gone[r.position_in_list] = true;
    std::erase_if(alive, [&](std::uint32_t i) { return gone[i]; });
    return alive;
}

}  // namespace brisance
