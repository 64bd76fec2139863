// Seven-point systems on a sparse lattice.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/parallel.h"
#include "core/rng.h"
#include "diffusion/multigrid.h"

namespace brisance {
namespace {

std::vector<ivec3> cube_of_bricks(int side) {
    std::vector<ivec3> bricks;
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z)
                bricks.push_back(ivec3(x, y, z) - side / 2);
    return bricks;
}

// Conductances 10^0 ... 10^-decades by chance, and a wall that loses light.
void fill(Multigrid& m, int decades) {
    const Cells& cells = m.cells();
    StencilSystem& s = m.system();
    for (std::size_t i = 0; i < cells.count(); ++i) {
        Rng rng(Stream::EscapeRay, 7, i);
        for (int a = 0; a < 6; ++a)
            if (cells.neighbour[i][a] == cells.none())
                s.loss[i] += 0.5f;
            else if (a < 3)
                s.conductance[a][i] = std::pow(10.0f, -float(decades) * rng.next());
    }
    m.set_up();
}

std::vector<double> product(Multigrid& m, const std::vector<double>& x) {
    const Cells& cells = m.cells();
    const StencilSystem& s = m.system();
    std::vector<double> b(cells.count());
    for (std::size_t i = 0; i < cells.count(); ++i) {
        b[i] = s.loss[i] * x[i];
        for (int a = 0; a < 3; ++a) {
            const auto up = cells.neighbour[i][a], down = cells.neighbour[i][3 + a];
            b[i] += s.conductance[a][i] * (x[i] - x[up]) + s.conductance[a][down] * (x[i] - x[down]);
        }
    }
    return b;
}

std::vector<double> random_values(std::size_t n) {
    std::vector<double> x(n + 1, 0.0);
    for (std::size_t i = 0; i < n; ++i)
        x[i] = Rng(Stream::EscapeRay, 8, i).next_double();
    return x;
}

TEST(Multigrid, FindsWhatTheProductWasMadeOf) {
    std::vector<ivec3> bricks = cube_of_bricks(3);
    bricks.erase(bricks.begin() + 13);  // a hole in the middle
    bricks.push_back({40, -3, 5});      // far from all others
    Multigrid m{BrickLattice(bricks)};
    fill(m, 4);
    const std::vector<double> truth = random_values(m.cells().count());
    std::vector<double> x(truth.size(), 0.0);
    const Convergence c = m.solve(product(m, truth), x, 1e-12, 300);
    EXPECT_TRUE(c.reached);
    double worst = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
        worst = std::max(worst, std::abs(x[i] - truth[i]));
    std::printf("%d iterations, largest error %.2e\n", c.iterations, worst);
    EXPECT_LT(worst, 1e-5);
}

TEST(Multigrid, NeedsHardlyMoreIterationsOnLargerLattices) {
    for (const int decades : {0, 4}) {
        int iterations[2];
        for (const int k : {0, 1}) {
            Multigrid m{BrickLattice(cube_of_bricks(k == 0 ? 2 : 8))};
            fill(m, decades);
            std::vector<double> x(m.cells().count() + 1, 0.0);
            iterations[k] = m.solve(product(m, random_values(m.cells().count())), x, 1e-8, 300).iterations;
            std::printf("%d decades, %zu cells: %d iterations\n", decades, m.cells().count(), iterations[k]);
        }
        // Coefficients that jump from cell to cell are what joined cells represent worst.
        EXPECT_LE(iterations[1], decades == 0 ? 2 * iterations[0] : 60);
    }
}

TEST(Multigrid, SaysWhenItHasNotConverged) {
    Multigrid m{BrickLattice(cube_of_bricks(2))};
    fill(m, 2);
    std::vector<double> x(m.cells().count() + 1, 0.0);
    const Convergence c = m.solve(product(m, random_values(m.cells().count())), x, 1e-10, 1);
    EXPECT_FALSE(c.reached);
    EXPECT_GT(c.residual, 1e-10);
    EXPECT_EQ(c.iterations, 1);
}

TEST(Multigrid, OfNothingIsNothing) {
    Multigrid m{BrickLattice(cube_of_bricks(1))};
    fill(m, 2);
    std::vector<double> x(m.cells().count() + 1, 1.0);
    EXPECT_TRUE(m.solve(std::vector<double>(m.cells().count(), 0.0), x, 1e-8, 10).reached);
    for (const double v : x)
        EXPECT_EQ(v, 0.0);
}

TEST(Multigrid, ThreadsChangeNoBit) {
    const auto with = [](int threads) {
        const ThreadLimit limit(threads);
        Multigrid m{BrickLattice(cube_of_bricks(4))};
        fill(m, 3);
        std::vector<double> x(m.cells().count() + 1, 0.0);
        m.solve(product(m, random_values(m.cells().count())), x, 1e-6, 100);
        return x;
    };
    const auto one = with(1), many = with(5);
    EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(double)), 0);
}

}  // namespace
}  // namespace brisance
