// Symmetric systems of seven-point stencils on a sparse lattice, by conjugate gradients with a multigrid cycle.
//
// A cell is a node of a brick lattice with the volume around it. It exchanges flux with six neighbours,
//   sum over faces of C (x_i - x_j) + loss_i x_i = b_i,
// with conductances C >= 0 and losses >= 0. No matrix is built: a cell stores three conductances and one loss.
//
// Coarser systems join cells eight by eight; transfer is constant over joined cells. Their losses are sums, and their
// conductances half the sums, since what is joined lies twice as far apart (D. Braess, Towards Algebraic Multigrid for
// Elliptic Problems of Second Order, Computing 55, 1995). The cycle is symmetric: red, black before the coarser system
// and black, red after it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "medium/lattice/brick_lattice.h"

namespace brisance {

// The cells of a lattice and their neighbours.
struct Cells {
    BrickLattice lattice;
    // Per cell toward +x, +y, +z, -x, -y, -z; the cell after the last one stands for none.
    std::vector<std::array<std::int32_t, 6>> neighbour;

    explicit Cells(BrickLattice nodes);
    std::size_t count() const { return neighbour.size(); }
    std::int32_t none() const { return static_cast<std::int32_t>(neighbour.size()); }
    std::uint64_t bytes() const { return lattice.bytes() + neighbour.size() * sizeof(neighbour[0]); }
};

// Coefficients of one level. A cell with no conductance and no loss takes no part.
struct StencilSystem {
    std::array<std::vector<float>, 3> conductance;  // per cell and one more that is 0, to the neighbour at +x, +y, +z
    std::vector<float> loss;
    std::vector<double> diagonal;  // made by Multigrid

    void resize(std::size_t cells);
};

struct Convergence {
    int iterations = 0;
    double residual = 0.0;  // sum of what is left over at the cells, without sign, over that of the right side
    bool reached = true;    // the tolerance
};

class Multigrid {
public:
    // Of the finest cells and coarser ones, down to two bricks per axis.
    explicit Multigrid(const BrickLattice& lattice);

    const Cells& cells() const { return levels_.front().cells; }
    int level_count() const { return static_cast<int>(levels_.size()); }
    std::uint64_t bytes() const;

    // To be filled, then set_up().
    StencilSystem& system() { return levels_.front().system; }
    void set_up();

    // Solves for `x`, from the `x` given, both of cells().count() + 1 values of which the last is 0.
    Convergence solve(const std::vector<double>& right, std::vector<double>& x, double tolerance, int most_iterations);

private:
    struct Level {
        Cells cells;
        StencilSystem system;
        std::vector<std::int32_t> parent;  // in the next level
        std::vector<double> x, right, residual;
    };

    void cycle(std::size_t level);

    std::vector<Level> levels_;
};

}  // namespace brisance
