#include "diffusion/multigrid.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "diffusion/cell_loops.h"

namespace brisance {

namespace {

constexpr int kSize = BrickLattice::kSize, kNodes = BrickLattice::kNodes;
constexpr int kSmoothings = 2;
constexpr int kCoarsestSmoothings = 24;

// What a cell gives away. Differences come first: conductances may be so much larger than the loss that the diagonal
// does not hold it.
double outflow(const Cells& cells, const StencilSystem& s, const std::vector<double>& x, std::size_t i) {
    const auto& n = cells.neighbour[i];
    double sum = s.loss[i] * x[i];
    for (int a = 0; a < 3; ++a)
        sum += s.conductance[a][i] * (x[i] - x[n[a]]) + s.conductance[a][n[3 + a]] * (x[i] - x[n[3 + a]]);
    return sum;
}

// What flows in from the neighbours of a cell.
double inflow(const Cells& cells, const StencilSystem& s, const std::vector<double>& x, std::size_t i) {
    const auto& n = cells.neighbour[i];
    double sum = 0.0;
    for (int a = 0; a < 3; ++a)
        sum += s.conductance[a][i] * x[n[a]] + s.conductance[a][n[3 + a]] * x[n[3 + a]];
    return sum;
}

// One sweep of Gauss and Seidel over the cells of one colour of a chequerboard, which do not touch.
void relax(const Cells& cells, const StencilSystem& s, const std::vector<double>& right, std::vector<double>& x,
           int colour) {
    parallel_for(
        cells.lattice.brick_count(),
        [&](std::size_t b) {
            for (int row = 0; row < kSize * kSize; ++row)
                for (int z = (colour + row / kSize + row) & 1; z < kSize; z += 2) {
                    const std::size_t i = b * kNodes + row * kSize + z;
                    if (s.diagonal[i] > 0.0)
                        x[i] = (right[i] + inflow(cells, s, x, i)) / s.diagonal[i];
                }
        },
        8);
}

void smooth(const Cells& cells, const StencilSystem& s, const std::vector<double>& right, std::vector<double>& x,
            int first, int times) {
    for (int k = 0; k < times; ++k)
        for (const int colour : {first, 1 - first})
            relax(cells, s, right, x, colour);
}

void make_diagonal(const Cells& cells, StencilSystem& s) {
    over_cells(cells.count(), [&](std::size_t i) {
        double sum = s.loss[i];
        for (int a = 0; a < 3; ++a)
            sum += double(s.conductance[a][i]) + s.conductance[a][cells.neighbour[i][3 + a]];
        s.diagonal[i] = sum;
    });
}

std::vector<std::int32_t> parents_of(const Cells& fine, const Cells& coarse) {
    std::vector<std::int32_t> parent(fine.count());
    over_cells(fine.count(), [&](std::size_t i) {
        parent[i] = static_cast<std::int32_t>(coarse.lattice.find_node(fine.lattice.node(i) >> 1));
    });
    return parent;
}

// The eight cells that a coarser one joins; none where there is no brick.
template <class Body>
void over_children(const Cells& fine, const Cells& coarse, std::size_t i, const Body& body) {
    const ivec3 first = coarse.lattice.node(i) * 2;
    const int b = fine.lattice.find(first >> 3);
    for (int k = 0; k < 8 && b >= 0; ++k)
        body(std::size_t(b) * kNodes + BrickLattice::offset_in_brick(first + ivec3(k >> 2, k >> 1 & 1, k & 1)),
             ivec3(k >> 2, k >> 1 & 1, k & 1));
}

void join(const Cells& fine, const StencilSystem& from, const Cells& coarse, StencilSystem& to) {
    over_cells(coarse.count(), [&](std::size_t i) {
        float sum[3] = {}, loss = 0.0f;
        over_children(fine, coarse, i, [&](std::size_t child, const ivec3& place) {
            loss += from.loss[child];
            for (int a = 0; a < 3; ++a)
                if (place[a] == 1)
                    sum[a] += from.conductance[a][child];
        });
        for (int a = 0; a < 3; ++a)
            to.conductance[a][i] = 0.5f * sum[a];
        to.loss[i] = loss;
    });
}

BrickLattice halved(const BrickLattice& fine) {
    std::vector<ivec3> bricks;
    for (std::size_t b = 0; b < fine.brick_count(); ++b)
        bricks.push_back(fine.brick(b) >> 1);
    return BrickLattice(std::move(bricks));
}

}  // namespace

Cells::Cells(BrickLattice nodes) : lattice(std::move(nodes)), neighbour(lattice.node_count()) {
    parallel_for(
        lattice.brick_count(),
        [&](std::size_t b) {
            for (int k = 0; k < kNodes; ++k) {
                const ivec3 node = lattice.first_node(b) + BrickLattice::node_in_brick(k);
                for (int a = 0; a < 6; ++a) {
                    ivec3 next = node;
                    next[a % 3] += a < 3 ? 1 : -1;
                    const std::int64_t j = lattice.find_node(next);
                    neighbour[b * kNodes + k][a] = j < 0 ? none() : static_cast<std::int32_t>(j);
                }
            }
        },
        8);
}

void StencilSystem::resize(std::size_t cells) {
    for (std::vector<float>& c : conductance)
        c.assign(cells + 1, 0.0f);
    loss.assign(cells, 0.0f);
    diagonal.assign(cells, 0.0);
}

Multigrid::Multigrid(const BrickLattice& lattice) {
    BrickLattice next = lattice;
    for (;;) {
        // Bricks on both sides of the origin never become one.
        const ivec3 extent = next.brick_extent();
        Level level{Cells(std::move(next)), {}, {}, {}, {}, {}};
        level.system.resize(level.cells.count());
        level.x.assign(level.cells.count() + 1, 0.0);
        level.right = level.residual = level.x;
        levels_.push_back(std::move(level));
        if (levels_.size() > 1) {
            Level& finer = levels_[levels_.size() - 2];
            finer.parent = parents_of(finer.cells, levels_.back().cells);
        }
        if (std::max({extent.x, extent.y, extent.z}) <= 2)
            break;
        next = halved(levels_.back().cells.lattice);
    }
}

std::uint64_t Multigrid::bytes() const {
    std::uint64_t sum = 0;
    for (const Level& l : levels_)
        sum += l.cells.bytes() + l.cells.count() * (4 * sizeof(float) + sizeof(std::int32_t) + 4 * sizeof(double));
    return sum + 4 * levels_.front().cells.count() * sizeof(double);  // of conjugate gradients
}

void Multigrid::set_up() {
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        if (l > 0)
            join(levels_[l - 1].cells, levels_[l - 1].system, levels_[l].cells, levels_[l].system);
        make_diagonal(levels_[l].cells, levels_[l].system);
    }
}

// Improves the level's x = 0 toward the solution for its right side.
void Multigrid::cycle(std::size_t index) {
    Level& level = levels_[index];
    std::fill(level.x.begin(), level.x.end(), 0.0);
    const bool last = index + 1 == levels_.size();
    const int times = last ? kCoarsestSmoothings : kSmoothings;
    smooth(level.cells, level.system, level.right, level.x, 0, times);
    if (!last) {
        over_cells(level.cells.count(), [&](std::size_t i) {
            level.residual[i] = level.right[i] - outflow(level.cells, level.system, level.x, i);
        });
        Level& coarser = levels_[index + 1];
        over_cells(coarser.cells.count(), [&](std::size_t i) {
            double sum = 0.0;
            over_children(level.cells, coarser.cells, i,
                          [&](std::size_t child, const ivec3&) { sum += level.residual[child]; });
            coarser.right[i] = sum;
        });
        cycle(index + 1);
        over_cells(level.cells.count(), [&](std::size_t i) {
            if (level.system.diagonal[i] > 0.0)
                level.x[i] += coarser.x[level.parent[i]];
        });
    }
    smooth(level.cells, level.system, level.right, level.x, 1, times);
}

Convergence Multigrid::solve(const std::vector<double>& right, std::vector<double>& x, double tolerance,
                             int most_iterations) {
    Level& finest = levels_.front();
    const Cells& cells = finest.cells;
    const std::size_t n = cells.count();
    const auto times = [&](const std::vector<double>& v, std::size_t i) { return outflow(cells, finest.system, v, i); };
    const double norm = sum_over(n, [&](std::size_t i) { return std::abs(right[i]); });
    Convergence c;
    if (!(norm > 0.0)) {
        std::fill(x.begin(), x.end(), 0.0);
        return c;
    }
    std::vector<double> r(n), p(n + 1, 0.0), q(n);
    over_cells(n, [&](std::size_t i) { r[i] = right[i] - times(x, i); });
    const auto residual = [&] { return sum_over(n, [&](std::size_t i) { return std::abs(r[i]); }) / norm; };
    double before = 0.0;
    for (c.residual = residual(); c.residual > tolerance && c.iterations < most_iterations; c.residual = residual()) {
        std::copy(r.begin(), r.end(), finest.right.begin());
        cycle(0);
        const std::vector<double>& z = finest.x;
        const double now = sum_over(n, [&](std::size_t i) { return r[i] * z[i]; });
        const double turn = before > 0.0 ? now / before : 0.0;
        over_cells(n, [&](std::size_t i) { p[i] = z[i] + turn * p[i]; });
        before = now;
        over_cells(n, [&](std::size_t i) { q[i] = times(p, i); });
        const double curvature = sum_over(n, [&](std::size_t i) { return p[i] * q[i]; });
        if (!(curvature > 0.0))
            break;
        const double step = now / curvature;
        over_cells(n, [&](std::size_t i) {
            x[i] += step * p[i];
            r[i] -= step * q[i];
        });
        ++c.iterations;
    }
    c.reached = c.residual <= tolerance;
    return c;
}

}  // namespace brisance
