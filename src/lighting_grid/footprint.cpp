#include "lighting_grid/footprint.h"

#include <algorithm>
#include <numeric>

#include "core/parallel.h"

namespace brisance {

BrickWeights sum_over_bricks(const Medium& medium, const NodeWeights& weights) {
    BrickWeights sums(medium.lattice.brick_count());
    parallel_for(
        sums.size(),
        [&](std::size_t b) {
            const auto first = weights.begin() + std::ptrdiff_t(b * BrickLattice::kNodes);
            sums[b] = std::accumulate(first, first + BrickLattice::kNodes, 0.0,
                                      [](double sum, float w) { return sum + std::max(0.0f, w); });
        },
        256);
    return sums;
}

double FootprintPicker::search_brick(int brick, const ivec3& centre, double passed) {
    const int h = 1 << level_;
    const ivec3 first = medium_.lattice.first_node(brick);
    const float* weights = &weights_[std::size_t(brick) * BrickLattice::kNodes];
    const ivec3 low = glm::max(centre - h + 1 - first, ivec3(0));
    const ivec3 high = glm::min(centre + h - 1 - first, ivec3(BrickLattice::kSize - 1));
    for (int x = low.x; x <= high.x; ++x)
        for (int y = low.y; y <= high.y; ++y)
            for (int z = low.z; z <= high.z; ++z) {
                const int n = (x * BrickLattice::kSize + y) * BrickLattice::kSize + z;
                if (!(weights[n] > 0.0f))
                    continue;
                const ivec3 node = first + ivec3(x, y, z), rest = h - glm::abs(node - centre);
                passed += double(weights[n]) * (double(rest.x) / h) * (double(rest.y) / h) * (double(rest.z) / h);
                found_.push_back({node, std::size_t(brick) * BrickLattice::kNodes + n, passed});
            }
    return passed;
}

double FootprintPicker::find_whole_brick(int brick, const ivec3& centre, double passed) {
    const double weight = (*bricks_)[std::size_t(brick)];
    if (!(weight > 0.0))
        return passed;
    const ivec3 first = medium_.lattice.first_node(brick);
    const dvec3 middle = dvec3(first) + 0.5 * (BrickLattice::kSize - 1);
    const dvec3 rest = 1.0 - glm::abs(middle - dvec3(centre)) / double(1 << level_);
    passed += weight * rest.x * rest.y * rest.z;
    found_.push_back({first, std::size_t(brick), passed});
    return passed;
}

ivec3 FootprintPicker::node_at(std::size_t brick, double share) const {
    const float* weights = &weights_[brick * BrickLattice::kNodes];
    double rest = share * (*bricks_)[brick];
    int last = 0;
    for (int n = 0; n < BrickLattice::kNodes; ++n) {
        if (!(weights[n] > 0.0f))
            continue;
        last = n;
        rest -= double(weights[n]);
        if (rest <= 0.0)
            break;
    }
    return medium_.lattice.first_node(brick) + BrickLattice::node_in_brick(last);
}

void FootprintPicker::search(const ivec3& vertex) {
    const int h = 1 << level_;
    const ivec3 centre = vertex * h;
    const ivec3 low = (centre - h + 1) >> 3, high = (centre + h - 1) >> 3;
    found_.clear();
    double passed = 0.0;
    for (int x = low.x; x <= high.x; ++x)
        for (int y = low.y; y <= high.y; ++y)
            for (int z = low.z; z <= high.z; ++z)
                if (const int b = medium_.lattice.find({x, y, z}); b >= 0)
                    passed = bricks_ ? find_whole_brick(b, centre, passed) : search_brick(b, centre, passed);
}

const std::vector<ivec3>& FootprintPicker::pick(const ivec3& vertex, int count) {
    search(vertex);
    picks_.clear();
    std::size_t at = 0;
    for (int k = 0; k < count && !found_.empty(); ++k) {
        const double goal = (k + 0.5) / count * found_.back().passed;
        while (at + 1 < found_.size() && found_[at].passed < goal)
            ++at;
        const double before = at > 0 ? found_[at - 1].passed : 0.0, own = found_[at].passed - before;
        picks_.push_back(bricks_ ? node_at(found_[at].index, (goal - before) / own) : found_[at].node);
    }
    return picks_;
}

const std::vector<FootprintPicker::WeightedPick>& FootprintPicker::pick(const ivec3& vertex, int count,
                                                                        const NodeWeights& importance) {
    search(vertex);
    weighted_picks_.clear();
    if (found_.empty())
        return weighted_picks_;
    double mean = 0.0, before = 0.0;
    for (const Found& f : found_) {
        mean += (f.passed - before) * importance[f.index];
        before = f.passed;
    }
    mean /= before;
    const auto density = [&](const Found& f) {
        return mean > 0.0 ? kLeastShare + (1.0 - kLeastShare) * importance[f.index] / mean : 1.0;
    };
    // The density's sum is that of the weights.
    std::size_t at = 0;
    double passed = found_[0].passed * density(found_[0]);
    for (int k = 0; k < count; ++k) {
        const double goal = (k + 0.5) / count * before;
        for (; at + 1 < found_.size() && passed < goal; ++at)
            passed += (found_[at + 1].passed - found_[at].passed) * density(found_[at + 1]);
        weighted_picks_.push_back({found_[at].node, float(1.0 / density(found_[at]))});
    }
    return weighted_picks_;
}

}  // namespace brisance
