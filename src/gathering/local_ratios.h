// Ratios of two sums over nodes, as a continuous function of place.
#pragma once

#include <array>
#include <vector>

#include "medium/lattice/brick_lattice.h"

namespace brisance {

// Sums are kept brick by brick. The ratio at a corner of bricks is that of all bricks that touch it, drawn toward the
// ratio of all sums where these have few nodes, and that toward 0; between the corners it is trilinear.
class LocalRatios {
public:
    explicit LocalRatios(const BrickLattice& lattice);  // keeps a reference

    // Of one node. Bricks may be filled by different threads.
    void add(std::size_t node, const Rgb& above, const Rgb& below) {
        Sums& s = sums_[node / BrickLattice::kNodes];
        s.above += dvec3(above);
        s.below += dvec3(below);
        s.count += 1.0;
    }

    using Corners = std::array<Rgb, 8>;       // x slowest
    std::vector<Corners> at_corners() const;  // of every brick
    static Rgb at_node(const Corners& corners, const ivec3& node_in_brick);

private:
    struct Sums {
        dvec3 above{0.0}, below{0.0};
        double count = 0.0;
        void add(const Sums& other);
        // Drawn toward `general` as if so many nodes more had that.
        Rgb ratio(const Rgb& general, double nodes) const;
    };

    const BrickLattice& lattice_;
    std::vector<Sums> sums_;
};

}  // namespace brisance
