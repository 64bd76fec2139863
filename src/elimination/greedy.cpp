#include "elimination/greedy.h"

#include <algorithm>
#include <functional>
#include <iterator>

#include "core/parallel.h"
#include "elimination/leaf_kernels.h"

namespace brisance {

namespace {

constexpr std::size_t kBlockLeaves = 1024;    // that one task works on: half a megabyte, to stay in the second cache
constexpr double kShare = 0.1;                // of the remaining points that a round lets go at most
constexpr std::size_t kSampledLeaves = 1024;  // from which a round's threshold is read

struct Slot {
    std::uint32_t leaf, slot;
};

struct Candidate {
    Weight weight;
    std::uint32_t rank;
    Slot at;

    bool operator<(const Candidate& b) const { return weight < b.weight || (weight == b.weight && rank < b.rank); }
};

struct Removal {
    Weight weight;  // when it went
    std::uint32_t rank;
    std::uint32_t candidate;
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
    std::vector<Candidate> heap;
    std::vector<Message> outbox;
    std::vector<Removal> removed;
    Taken taken;
    bool candidates = false;  // whether there were any this round

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
    void remove_heaviest(Block& block, Weight threshold);
    void remove(Block& block, const Candidate& heaviest);
    void receive(Block& block);
    void refresh(Block& block);
    void round(Weight threshold);
    Weight quantile(double share);
    void remove_weightless(std::size_t count, std::vector<Removal>& removed);

    template <class Function>
    void for_each_block(const Function& f) {
        parallel_for(blocks_.size(), [&](std::size_t b) { f(blocks_[b]); });
    }

    const std::vector<std::uint32_t>& alive_;
    float least_;
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
        for (std::uint32_t l = 0; l < block.owned; ++l)
            block.leaves.push_back(make_leaf(candidates, alive, block.first + l, scale));
        for (const std::uint32_t l : block.copied)
            block.leaves.push_back(make_leaf(candidates, alive, l, scale));
        for (std::uint32_t l = 0; l < block.owned; ++l)
            sum_weights(block.leaves.data(), l, block.neighbours(l), least_);
    });
    for_each_block([&](Block& block) { refresh(block); });
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

// Goes down the block's points above the threshold. Weights in the heap may be out of date, always too great: those
// points are put back with what they weigh by now. Points with a heavier one beside them, in another block or held up
// itself, wait for the next round.
void Rounds::remove_heaviest(Block& block, Weight threshold) {
    block.heap.clear();
    for (std::uint32_t l = 0; l < block.owned; ++l)
        for (std::uint32_t s = 0; s < kLeafSize; ++s)
            if (const Weight weight = block.leaves[l].weight[s]; weight > threshold)
                block.heap.push_back({weight, block.leaves[l].rank[s], {l, s}});
    std::make_heap(block.heap.begin(), block.heap.end());
    block.candidates = !block.heap.empty();
    while (!block.heap.empty()) {
        std::pop_heap(block.heap.begin(), block.heap.end());
        Candidate heaviest = block.heap.back();
        block.heap.pop_back();
        const Weight weight = block.leaves[heaviest.at.leaf].weight[heaviest.at.slot];
        if (weight == heaviest.weight) {
            remove(block, heaviest);
        } else if (weight > threshold) {
            heaviest.weight = weight;
            block.heap.push_back(heaviest);
            std::push_heap(block.heap.begin(), block.heap.end());
        }
    }
}

// Removes the point, if it may go by now.
void Rounds::remove(Block& block, const Candidate& heaviest) {
    const auto [l, s] = heaviest.at;
    Leaf& leaf = block.leaves[l];
    const Probe probe{vec3(leaf.x[s], leaf.y[s], leaf.z[s]), leaf.inverse_reach[s], heaviest.weight, heaviest.rank};
    const std::span<const std::uint32_t> list = block.neighbours(l);
    leaf.clear(s);
    if (!take_weights(block.leaves.data(), list, probe, least_, block.taken)) {
        leaf.set(s, probe.position, probe.inverse_reach, probe.rank, probe.weight);
        return;
    }
    for (std::size_t n = 0; n < list.size(); ++n) {
        if (!block.taken.touched[n])
            continue;
        if (list[n] < block.owned)
            subtract(block.leaves[list[n]], block.taken.weight.data() + n * kLeafSize);
        else
            block.outbox.push_back({block.copied[list[n] - block.owned], probe.position});
    }
    block.removed.push_back({probe.weight, probe.rank, alive_[(block.first + l) * kLeafSize + s]});
}

void Rounds::receive(Block& block) {
    for (const std::uint32_t other : block.near)
        for (const Message& message : blocks_[other].outbox)
            if (block.owns(message.leaf))
                subtract(block.leaves[message.leaf - block.first], message.position, least_);
}

void Rounds::refresh(Block& block) {
    for (std::size_t c = 0; c < block.copied.size(); ++c) {
        const Block& other = blocks_[block.copied[c] / kBlockLeaves];
        block.leaves[block.owned + c] = other.leaves[block.copied[c] - other.first];
    }
}

// In three steps, as nobody may look at what another block is changing.
void Rounds::round(Weight threshold) {
    for_each_block([&](Block& block) {
        block.outbox.clear();
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
                    left.push_back({0, block.leaves[l].rank[s], alive_[(block.first + l) * kLeafSize + s]});
    keep_greatest(left, count);
    removed.insert(removed.end(), left.begin(), left.end());
}

void Rounds::run(std::size_t goal, std::vector<Removal>& removed) {
    const std::size_t before = removed.size();
    Weight threshold = quantile(0.0);
    bool idle = true;  // nobody above the threshold
    for (;;) {
        const std::size_t left = alive_.size() - (removed.size() - before);
        if (removed.size() >= goal ? idle : 2 * left < alive_.size())
            return;
        if (removed.size() < goal) {
            if (idle && threshold == 0)
                return remove_weightless(goal - removed.size(), removed);
            const double share = std::min(kShare, double(goal - removed.size()) / double(left));
            threshold = std::max<Weight>(std::min(threshold - idle, quantile(share)), 0);
        }
        round(threshold);
        idle = true;
        for (Block& block : blocks_) {
            idle = idle && !block.candidates;
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
        for (std::size_t r = before; r < removed.size(); ++r)
            gone[removed[r].candidate] = true;
        std::erase_if(left, [&](std::uint32_t i) { return gone[i]; });
    }
    for (const Removal& r : removed)
        gone[r.candidate] = false;
    keep_greatest(removed, goal);  // the others stay after all
    for (const Removal& r : removed)
        gone[r.candidate] = true;
    std::erase_if(alive, [&](std::uint32_t i) { return gone[i]; });
    return alive;
}

}  // namespace brisance
