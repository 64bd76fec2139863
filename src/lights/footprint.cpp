#include "lights/footprint.h"

#include <algorithm>

namespace brisance {

double FootprintPicker::search_brick(int brick, const ivec3& centre, double passed) {
    const int h = 1 << level_;
    const ivec3 first = medium_.lattice.first_node(brick);
    const float* weights = &weights_[std::size_t(brick) * BrickLattice::kNodes];
    for (int n = 0; n < BrickLattice::kNodes; ++n) {
        if (!(weights[n] > 0.0f))
            continue;
        const ivec3 node = first + BrickLattice::node_in_brick(n);
        const ivec3 rest = h - glm::abs(node - centre);
        if (std::min({rest.x, rest.y, rest.z}) <= 0)
            continue;
        passed += double(weights[n]) * (double(rest.x) / h) * (double(rest.y) / h) * (double(rest.z) / h);
        found_.push_back({node, passed});
    }
    return passed;
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
                    passed = search_brick(b, centre, passed);
}

const std::vector<ivec3>& FootprintPicker::pick(const ivec3& vertex, int count) {
    search(vertex);
    picks_.clear();
    std::size_t at = 0;
    for (int k = 0; k < count && !found_.empty(); ++k) {
        const double goal = (k + 0.5) / count * found_.back().passed;
        while (at + 1 < found_.size() && found_[at].passed < goal)
            ++at;
        picks_.push_back(found_[at].node);
    }
    return picks_;
}

}  // namespace brisance
