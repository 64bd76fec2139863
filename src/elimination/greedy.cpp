#include "elimination/greedy.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>

#include "core/parallel.h"
#include "elimination/bracket_queue.h"
#include "elimination/leaf_kernels.h"

namespace brisance {

namespace {

constexpr std::size_t kBlockLeaves = 1024;    // that one task works on: half a megabyte, to stay in the second cache
constexpr double kOverlap = 1.5;              // neighbours above the same round's threshold, on average
constexpr double kRepack = 0.3;               // of the points left: leaves are filled anew
constexpr std::size_t kSampledLeaves = 1024;  // from which a round's threshold is read

struct Removal {
    Weight weight;  // when it went
    std::uint32_t rank;
    std::uint32_t place;  // in the list of those alive
};

// A removal near a border: what it takes from a leaf of another block is subtracted there after the round.
struct Message {
    std::uint32_t leaf;
    vec3 position;
};

// A range of leaves, and a copy of those around it as they were when the round began.
struct Block {
    std::uint32_t first = 0, owned = 0;     // the range
    std::vector<Leaf> leaves;               // owned ones, then copies
    std::vector<std::uint32_t> copied;      // ascending: which leaves the copies are of
    std::vector<std::uint32_t> near;        // blocks that own them
    std::vector<std::uint32_t> list_begin;  // per owned leaf, into `list`
    std::vector<std::uint32_t> list;        // leaves of this block that may hold neighbours
    std::vector<float> square_reach;        // per leaf, see LeafView
    std::vector<Weight> bound;              // per owned leaf: no weight in it is above
    std::vector<std::uint8_t> changed;      // per owned leaf: whether this round has changed it
    BracketQueue queue;
    std::vector<Message> outbox;
    std::vector<Removal> removed;
    Taken taken;

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

// Those that went first when one goes at a time.
void keep_greatest(std::vector<Removal>& removed, std::size_t count) {
    const auto last = removed.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(removed.begin(), last, removed.end(), [](const Removal& a, const Removal& b) {
        return a.weight > b.weight || (a.weight == b.weight && a.rank > b.rank);
    });
    removed.erase(last, removed.end());
}

// The candidates left at some time, and what is removed of them until half are gone.
class Rounds {
public:
    Rounds(const Candidates& candidates, const std::vector<std::uint32_t>& alive, float scale, float least);

    // Removes until `goal` have been removed or half of the points are gone; appends to `removed`. Once the goal is
    // reached, whoever is left would have gone after all that went.
    void run(std::size_t goal, std::vector<Removal>& removed);

private:
    void find_neighbours(Block& block, const LeafTree& tree) const;
    void remove_heaviest(Block& block, Weight threshold, Weight last_threshold);
    Weight enqueue(Block& block, std::uint32_t l, Weight threshold);
    void remove(Block& block, const Queued& heaviest);
    void receive(Block& block);
    void refresh(Block& block);
    void round(Weight threshold, Weight last_threshold);
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
    std::vector<Block> blocks_;
    std::vector<Weight> sample_;
};

Rounds::Rounds(const Candidates& candidates, const std::vector<std::uint32_t>& alive, float scale, float least)
    : alive_(alive), least_(least) {
    const LeafTree tree = boxes_around(candidates, alive, scale);
    blocks_.resize((tree.size() + kBlockLeaves - 1) / kBlockLeaves);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        blocks_[b].first = static_cast<std::uint32_t>(b * kBlockLeaves);
        blocks_[b].owned = static_cast<std::uint32_t>(std::min(tree.size(), (b + 1) * kBlockLeaves) - b * kBlockLeaves);
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
        block.bound.assign(block.owned, std::numeric_limits<Weight>::max());
        block.changed.assign(block.owned, 1);
    });
    for_each_block([&](Block& block) { refresh(block); });
    neighbours_ = mean_neighbours();
}

// Of points here and there, at least 1.
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
        block.near.push_back(l / kBlockLeaves);
    sort_unique(block.near);
}

// Goes down the block's points above the threshold. Points with a heavier one beside them, in another block or held up
// itself, wait for the next round.
void Rounds::remove_heaviest(Block& block, Weight threshold, Weight last_threshold) {
    block.queue.reset(threshold, last_threshold);
    for (std::uint32_t l = 0; l < block.owned; ++l) {
        if (block.bound[l] > threshold)
            block.bound[l] = enqueue(block, l, threshold);
    }
    block.queue.drain([&](const Queued& item) { return block.leaves[item.at.leaf].weight[item.at.slot]; },
                      [&](const Queued& item) { remove(block, item); });
}

// Puts the leaf's points above the threshold into the queue; returns the greatest weight.
Weight Rounds::enqueue(Block& block, std::uint32_t l, Weight threshold) {
    const Leaf& leaf = block.leaves[l];
    Weight greatest = -1;
    for (std::uint32_t s = 0; s < kLeafSize; ++s) {
        greatest = std::max(greatest, leaf.weight[s]);
        if (leaf.weight[s] > threshold)
            block.queue.push({leaf.weight[s], leaf.rank[s], {l, s}});
    }
    return greatest;
}

// Removes the point, if it may go by now.
void Rounds::remove(Block& block, const Queued& heaviest) {
    const auto [l, s] = heaviest.at;
    Leaf& leaf = block.leaves[l];
    const Probe probe{vec3(leaf.x[s], leaf.y[s], leaf.z[s]), leaf.inverse_reach[s], heaviest.weight, heaviest.rank};
    const std::span<const std::uint32_t> list = block.neighbours(l);
    leaf.clear(s);
    if (!take_weights({block.leaves.data(), block.square_reach.data()}, list, probe, least_, block.taken)) {
        leaf.set(s, probe.position, probe.inverse_reach, probe.rank, probe.weight);
        return;
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
    block.removed.push_back({probe.weight, probe.rank, static_cast<std::uint32_t>((block.first + l) * kLeafSize + s)});
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
        const Block& other = blocks_[block.copied[c] / kBlockLeaves];
        if (other.changed[block.copied[c] - other.first])
            block.leaves[block.owned + c] = other.leaves[block.copied[c] - other.first];
    }
}

// In three steps, as nobody may look at what another block is changing.
void Rounds::round(Weight threshold, Weight last_threshold) {
    for_each_block([&](Block& block) {
        block.outbox.clear();
        std::fill(block.changed.begin(), block.changed.end(), std::uint8_t(0));
        remove_heaviest(block, threshold, last_threshold);
    });
    for_each_block([&](Block& block) { receive(block); });
    for_each_block([&](Block& block) { refresh(block); });
}

// The weight that about `share` of the points exceed.
Weight Rounds::quantile(double share) {
    sample_.clear();
    const std::size_t leaves = (alive_.size() + kLeafSize - 1) / kLeafSize;
    for (std::size_t l = 0; l < leaves; l += (leaves + kSampledLeaves - 1) / kSampledLeaves)
        for (const Weight weight : blocks_[l / kBlockLeaves].leaves[l % kBlockLeaves].weight)
            if (weight >= 0)
                sample_.push_back(weight);
    if (sample_.empty())
        return 0;
    const auto at = sample_.begin() + static_cast<std::ptrdiff_t>(share * double(sample_.size() - 1));
    std::nth_element(sample_.begin(), at, sample_.end(), std::greater<>());
    return *at;
}

// Nobody has neighbours any more: ranks alone decide.
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

// Among the points above a round's threshold few should be neighbours: across a border between blocks the lighter of
// two waits for the next round.
double Rounds::round_share(std::size_t left) const {
    return std::min(kOverlap * double(alive_.size()) / (neighbours_ * double(left)), 0.5);
}

void Rounds::run(std::size_t goal, std::vector<Removal>& removed) {
    const std::size_t before = removed.size();
    Weight threshold = quantile(0.0);
    bool idle = true;  // nobody above the threshold
    for (;;) {
        const std::size_t left = alive_.size() - (removed.size() - before);
        if (removed.size() >= goal ? idle : double(left) < kRepack * double(alive_.size()))
            return;
        const Weight last_threshold = threshold;
        if (removed.size() < goal) {
            if (idle && threshold == 0)
                return remove_weightless(goal - removed.size(), removed);
            const double share = std::min(round_share(left), double(goal - removed.size()) / double(left));
            threshold = std::max<Weight>(std::min(threshold - idle, quantile(share)), 0);
        }
        round(threshold, last_threshold);
        idle = true;
        for (Block& block : blocks_) {
            idle = idle && block.queue.empty();
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
    std::vector<std::uint32_t> left = alive;
    while (removed.size() < goal) {
        const std::size_t before = removed.size();
        Rounds(candidates, left, scale, least).run(goal, removed);
        for (std::size_t r = before; r < removed.size(); ++r) {
            removed[r].place = left[removed[r].place];  // among all candidates from now on
            gone[removed[r].place] = true;
        }
        std::erase_if(left, [&](std::uint32_t i) { return gone[i]; });
    }
    for (const Removal& r : removed)
        gone[r.place] = false;
    keep_greatest(removed, goal);  // the others stay after all
    for (const Removal& r : removed)
        gone[r.place] = true;
    std::erase_if(alive, [&](std::uint32_t i) { return gone[i]; });
    return alive;
}

}  // namespace brisance
