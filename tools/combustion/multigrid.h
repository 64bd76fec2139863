// Poisson's equation in a box: zero pressure on the sides and the top, no flow through the floor (k = 0).
// References
// [1] Trottenberg, Oosterlee & Schuller, Multigrid, Academic Press 2001: red-black Gauss-Seidel V-cycles (ch. 2, 5).
#pragma once

#include <vector>

#include "field.h"

namespace brisance::combustion {

class Multigrid {
public:
    // `cells` of side h [m]. Coarsens for as long as all three counts are even and above 4.
    Multigrid(const ivec3& cells, float h);

    // Solves laplacian(p) = rhs from the p of the last call until the residual's root mean square has fallen to
    // `tolerance` times that of rhs. Returns the number of V-cycles.
    int solve(const Field<float>& rhs, float tolerance, int max_cycles);

    float pressure(int i, int j, int k) const { return levels_[0].p(i + 1, j + 1, k + 1); }

private:
    // All fields carry one layer of ghost cells, kept at zero but during interpolation.
    struct Level {
        ivec3 cells;
        float h;
        Field<float> p, rhs, residual;
    };

    void v_cycle(std::size_t level);
    static void smooth(Level& level, int colour);
    static double compute_residual(Level& level);
    static void restrict_residual(const Level& fine, Level& coarse);
    static void add_correction(Level& coarse, Level& fine);

    std::vector<Level> levels_;
};

}  // namespace brisance::combustion
