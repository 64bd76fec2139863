#include <algorithm>

#include "elimination/greedy.h"

namespace brisance {

namespace {

// Cells of a grid as wide as the greatest reach: neighbours are in the 27 around a point.
class VoxelIndex {
public:
    VoxelIndex(const Candidates& candidates, const std::vector<std::uint32_t>& alive, float scale)
        : candidates_(candidates), alive_(alive), low_(1e30f) {
        vec3 high(-1e30f);
        for (const std::uint32_t i : alive) {
            width_ = std::max(width_, candidates.reach[i] * scale);
            low_ = glm::min(low_, candidates.position[i]);
            high = glm::max(high, candidates.position[i]);
        }
        const vec3 side = high - low_;
        width_ = std::max(width_, std::max(side.x, std::max(side.y, side.z)) * 1e-5f) * 1.001f;
        for (std::uint32_t n = 0; n < alive.size(); ++n)
            sorted_.emplace_back(key(cell(candidates.position[alive[n]])), n);
        std::sort(sorted_.begin(), sorted_.end());
    }

    // Calls f(n) for the n-th of `alive` in and around p's cell.
    template <class Function>
    void near(const vec3& p, const Function& f) const {
        const ivec3 middle = cell(p);
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y) {
                const std::uint64_t first = key(middle + ivec3(x, y, -1)), last = key(middle + ivec3(x, y, 1));
                auto at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(first, std::uint32_t(0)));
                for (; at != sorted_.end() && at->first <= last; ++at)
                    f(at->second);
            }
    }

private:
    ivec3 cell(const vec3& p) const { return width_ > 0.0f ? ivec3(glm::floor((p - low_) / width_)) + 1 : ivec3(1); }
    static std::uint64_t key(const ivec3& c) {
        return (std::uint64_t(c.x) << 42) | (std::uint64_t(c.y) << 21) | std::uint64_t(c.z);
    }

    const Candidates& candidates_;
    const std::vector<std::uint32_t>& alive_;
    vec3 low_;
    float width_ = 0.0f;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted_;
};

struct Neighbour {
    std::uint32_t point;
    std::int32_t weight;  // that the neighbour gets from the one whose list this is
};

// For each point, the neighbours whose weights it adds to.
struct Lists {
    std::vector<std::size_t> begin{0};
    std::vector<Neighbour> neighbours;
};

Lists list_neighbours(const Candidates& c, const std::vector<std::uint32_t>& alive, float scale, float least) {
    const VoxelIndex index(c, alive, scale);
    Lists lists;
    for (std::uint32_t n = 0; n < alive.size(); ++n) {
        const vec3 p = c.position[alive[n]];
        index.near(p, [&](std::uint32_t m) {
            const vec3 gap = c.position[alive[m]] - p;
            const float square = gap.x * gap.x + gap.y * gap.y + gap.z * gap.z;
            const std::int32_t w = pair_weight(square, inverse_reach(c.reach[alive[m]], scale), least);
            if (m != n && w > 0)
                lists.neighbours.push_back({m, w});
        });
        lists.begin.push_back(lists.neighbours.size());
    }
    return lists;
}

// A binary heap of points that keeps the position of each.
class Heap {
public:
    Heap(std::vector<Weight> weight, std::vector<std::uint32_t> rank)
        : weight_(std::move(weight)), rank_(std::move(rank)), heap_(weight_.size()), heap_index_(weight_.size()) {
        for (std::uint32_t n = 0; n < heap_.size(); ++n)
            heap_[n] = heap_index_[n] = n;
        for (std::size_t n = heap_.size() / 2; n-- > 0;)
            sink(n);
    }

    std::uint32_t pop() {
        const std::uint32_t top = heap_.front();
        put(0, heap_.back());
        heap_.pop_back();
        if (!heap_.empty())
            sink(0);
        heap_index_[top] = kGone;
        return top;
    }

    void lighten(std::uint32_t point, Weight by) {
        weight_[point] -= by;
        if (heap_index_[point] != kGone)
            sink(heap_index_[point]);
    }

private:
    static constexpr std::uint32_t kGone = ~0u;

    bool heavier(std::uint32_t a, std::uint32_t b) const {
        return weight_[a] > weight_[b] || (weight_[a] == weight_[b] && rank_[a] > rank_[b]);
    }
    void put(std::size_t at, std::uint32_t point) {
        heap_[at] = point;
        heap_index_[point] = static_cast<std::uint32_t>(at);
    }
    void sink(std::size_t at) {
        const std::uint32_t point = heap_[at];
        for (std::size_t child = 2 * at + 1; child < heap_.size(); child = 2 * at + 1) {
            if (child + 1 < heap_.size() && heavier(heap_[child + 1], heap_[child]))
                ++child;
            if (!heavier(heap_[child], point))
                break;
            put(at, heap_[child]);
            at = child;
        }
        put(at, point);
    }

    std::vector<Weight> weight_;
    std::vector<std::uint32_t> rank_, heap_, heap_index_;
};

}  // namespace

std::vector<std::uint32_t> eliminate_one_by_one(const Candidates& candidates, std::vector<std::uint32_t> alive,
                                                std::size_t target, float scale, float least) {
    if (alive.size() <= target)
        return alive;
    const Lists lists = list_neighbours(candidates, alive, scale, least);
    std::vector<Weight> weight(alive.size());
    for (const Neighbour& neighbour : lists.neighbours)
        weight[neighbour.point] += neighbour.weight;
    std::vector<std::uint32_t> rank(alive.size());
    std::transform(alive.begin(), alive.end(), rank.begin(), [&](std::uint32_t i) { return candidates.rank[i]; });
    Heap heap(std::move(weight), std::move(rank));
    std::vector<bool> gone(candidates.size());
    for (std::size_t left = alive.size(); left > target; --left) {
        const std::uint32_t n = heap.pop();
        gone[alive[n]] = true;
        for (std::size_t k = lists.begin[n]; k < lists.begin[n + 1]; ++k)
            heap.lighten(lists.neighbours[k].point, lists.neighbours[k].weight);
    }
    std::erase_if(alive, [&](std::uint32_t i) { return gone[i]; });
    return alive;
}

}  // namespace brisance
