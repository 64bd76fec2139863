#include "elimination/local_reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/parallel.h"
#include "elimination/leaf_kernels.h"

namespace brisance {

namespace {

constexpr std::size_t kBlock = 256;  // leaves that one task works on

// Returns the k-th smallest (k from 1) of n values, of which at least k are not above the limit. Values are about
// evenly distributed, so counting those up to a guess between two bounds ends after a few steps.
float kth_smallest(std::vector<float>& values, std::size_t k, float limit) {
    float low = 0.0f, high = limit;
    std::size_t below = 0, above = count_up_to(values.data(), values.size(), high);
    for (int step = 0; step < 12 && above != k; ++step) {
        const float share = float(k - below) / float(above - below);
        const float guess = low + (high - low) * (step % 3 == 2 ? 0.5f : share);
        const std::size_t count = count_up_to(values.data(), values.size(), guess);
        if (count < k) {
            low = guess;
            below = count;
        } else {
            high = guess;
            above = count;
        }
    }
    if (above == k)
        return greatest_up_to(values.data(), values.size(), high);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(k - 1);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

// Searches around one leaf after the other. The distance found at one is the first guess at the next.
class NeighbourSearch {
public:
    NeighbourSearch(const std::vector<Leaf>& leaves, const LeafTree& tree, std::size_t k)
        : leaves_(leaves), tree_(tree), k_(k) {}

    // The distance from each point of the leaf to the k-th nearest other.
    void search(std::size_t l, std::size_t points, float* distance) {
        find(l, radius_ > 0.0f ? radius_ : first_radius(l));
        float greatest = 0.0f;
        for (std::size_t s = 0; s < points; ++s) {
            const vec3 p(leaves_[l].x[s], leaves_[l].y[s], leaves_[l].z[s]);
            while (!enough(p))
                find(l, 1.5f * radius_);
            // The point itself is the first.
            distance[s] = std::sqrt(kth_smallest(squares_, k_ + 1, complete() ? kEverywhere : radius_ * radius_));
            greatest = std::max(greatest, distance[s]);
        }
        radius_ = 1.1f * greatest;
    }

private:
    static constexpr float kEverywhere = 1e30f;  // nearer than empty slots

    float first_radius(std::size_t l) const {
        const LeafBox& box = tree_.leaf(l);
        return glm::length(box.high - box.low) * std::sqrt(float(k_) / float(kLeafSize)) + 1e-30f;
    }
    bool complete() const { return found_.size() == tree_.size(); }

    void find(std::size_t l, float radius) {
        radius_ = radius;
        LeafBox box = tree_.leaf(l);
        box.reach = radius;
        tree_.find(box, found_);
    }

    bool enough(const vec3& p) {
        squares_.resize(found_.size() * kLeafSize);
        square_distances(leaves_.data(), found_, p, squares_.data());
        return complete() || count_up_to(squares_.data(), squares_.size(), radius_ * radius_) > k_;
    }

    const std::vector<Leaf>& leaves_;
    const LeafTree& tree_;
    std::size_t k_;
    float radius_ = 0.0f;
    std::vector<std::uint32_t> found_;
    std::vector<float> squares_;
};

}  // namespace

double closest_packing_distance(double measure, int dimension) {
    return 2.0 * (dimension == 2 ? std::sqrt(measure / (2.0 * std::numbers::sqrt3))
                                 : std::cbrt(measure / (4.0 * std::numbers::sqrt2)));
}

void reach_by_density(Candidates& candidates, std::size_t k, double ratio, int dimension) {
    candidates.reach.assign(candidates.size(), 0.0f);
    k = std::min(k, candidates.size() - std::min<std::size_t>(candidates.size(), 1));
    if (k == 0)
        return;
    std::vector<std::uint32_t> all(candidates.size());
    std::iota(all.begin(), all.end(), 0u);
    const LeafTree tree = boxes_around(candidates, all, 1.0f);
    std::vector<Leaf> leaves(tree.size());
    parallel_for(
        leaves.size(), [&](std::size_t l) { leaves[l] = make_leaf(candidates, all, l, 1.0f); }, kBlock);
    const double unit = dimension == 2 ? std::numbers::pi : 4.0 / 3.0 * std::numbers::pi;
    const double factor = closest_packing_distance(ratio * unit / double(k), dimension);
    parallel_blocks(leaves.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        NeighbourSearch search(leaves, tree, k);
        for (std::size_t l = begin; l < end; ++l) {
            const std::size_t first = l * kLeafSize, points = std::min(kLeafSize, candidates.size() - first);
            search.search(l, points, candidates.reach.data() + first);
            for (std::size_t i = first; i < first + points; ++i)
                candidates.reach[i] = static_cast<float>(candidates.reach[i] * factor);
        }
    });
}

}  // namespace brisance
