#include "motion/velocity_around.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr std::array<ivec3, 6> kNeighbours = {ivec3(-1, 0, 0), ivec3(1, 0, 0),  ivec3(0, -1, 0),
                                              ivec3(0, 1, 0),  ivec3(0, 0, -1), ivec3(0, 0, 1)};

bool holds_something(const Medium& medium, std::size_t i) {
    return medium.extinction[i] > 0.0f || (!medium.emission.empty() && medium.emission[i] != Rgb(0.0f));
}

BrickLattice lattice_around(const Medium& medium, int reach) {
    std::vector<std::uint8_t> marked(medium.lattice.node_count());
    for (std::size_t i = 0; i < marked.size(); ++i)
        marked[i] = holds_something(medium, i);
    BrickLattice lattice = medium.lattice;
    for (int left = reach; left > 0; left -= BrickLattice::kSize) {
        lattice = BrickLattice(bricks_around(lattice, marked, std::min(left, BrickLattice::kSize)));
        marked.assign(lattice.node_count(), 1);
    }
    return lattice;
}

// Rounds of filling: each gives the nodes beside known ones the mean of those.
class Filling {
public:
    explicit Filling(VelocityAround& around) : around_(around), known_(around.lattice.node_count(), 0) {}

    void start(const Medium& medium) {
        parallel_for(around_.lattice.brick_count(), [&](std::size_t b) {
            const int own = medium.lattice.find(around_.lattice.brick(b));
            for (int n = 0; own >= 0 && n < BrickLattice::kNodes; ++n) {
                const std::size_t from = std::size_t(own) * BrickLattice::kNodes + n;
                const std::size_t to = b * BrickLattice::kNodes + n;
                known_[to] = holds_something(medium, from);
                if (known_[to])
                    around_.at_nodes[to] = medium.index_from_local * medium.velocity[from];
            }
        });
    }

    void round() {
        std::vector<std::uint8_t> next = known_;
        parallel_for(
            around_.lattice.brick_count(),
            [&](std::size_t b) {
                for (std::size_t i = b * BrickLattice::kNodes; i < (b + 1) * BrickLattice::kNodes; ++i)
                    if (!known_[i])
                        next[i] = fill(i);
            },
            16);
        known_ = std::move(next);
    }

private:
    bool fill(std::size_t i) {
        const ivec3 node = around_.lattice.node(i);
        vec3 sum(0.0f);
        int count = 0;
        for (const ivec3& step : kNeighbours)
            if (const std::int64_t k = around_.lattice.find_node(node + step); k >= 0 && known_[std::size_t(k)]) {
                sum += around_.at_nodes[std::size_t(k)];
                ++count;
            }
        if (count > 0)
            around_.at_nodes[i] = sum / float(count);
        return count > 0;
    }

    VelocityAround& around_;
    std::vector<std::uint8_t> known_;
};

}  // namespace

VelocityAround velocity_around(const Medium& medium, int reach) {
    VelocityAround out{lattice_around(medium, reach), {}};
    out.at_nodes.resize(out.lattice.node_count(), vec3(0.0f));
    Filling filling(out);
    filling.start(medium);
    for (int k = 0; k < reach; ++k)
        filling.round();
    return out;
}

}  // namespace brisance
