#include "multigrid.h"

namespace brisance::combustion {

namespace {

// Twice the share of the diagonal that walls add: with a ghost of -p (zero pressure on the face) the seven-point
// stencil's diagonal grows by 1, with a ghost of p (no flow) it shrinks by 1. Ghosts themselves stay zero.
float row_diagonal(const ivec3& cells, int j, int k) {
    float diagonal = 6.0f;
    diagonal += (j == 1) + (j == cells.y);
    diagonal += (k == cells.z) - (k == 1);
    return diagonal;
}

float diagonal_at(float row, const ivec3& cells, int i) {
    return row + float((i == 1) + (i == cells.x));
}

// Fills (or clears) the ghost layer: antisymmetric across open faces, symmetric across the floor.
void set_ghosts(Field<float>& p, const ivec3& cells, float weight) {
    const auto plane = [&](int axis, int ghost, int inside, float sign) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        ivec3 g, s;
        g[axis] = ghost;
        s[axis] = inside;
        for (int b = 0; b < cells[v] + 2; ++b)
            for (int a = 0; a < cells[u] + 2; ++a) {
                g[u] = s[u] = a;
                g[v] = s[v] = b;
                p(g.x, g.y, g.z) = sign * weight * p(s.x, s.y, s.z);
            }
    };
    for (int axis = 0; axis < 3; ++axis) {
        plane(axis, 0, 1, axis == 2 ? 1.0f : -1.0f);
        plane(axis, cells[axis] + 1, cells[axis], -1.0f);
    }
}

}  // namespace

Multigrid::Multigrid(const ivec3& cells, float h) {
    ivec3 n = cells;
    for (;;) {
        const ivec3 padded = n + ivec3(2);
        levels_.push_back(Level{n, h, Field<float>(padded), Field<float>(padded), Field<float>(padded)});
        const bool even = n.x % 2 == 0 && n.y % 2 == 0 && n.z % 2 == 0;
        if (!even || std::min({n.x, n.y, n.z}) <= 4)
            break;
        n /= 2;
        h *= 2.0f;
    }
}

int Multigrid::solve(const Field<float>& rhs, float tolerance, int max_cycles) {
    Level& top = levels_[0];
    const double norm = sum_slabs(top.cells.z, [&](int k) {
        double sum = 0.0;
        for (int j = 0; j < top.cells.y; ++j)
            for (int i = 0; i < top.cells.x; ++i) {
                const float f = rhs(i, j, k);
                top.rhs(i + 1, j + 1, k + 1) = f;
                sum += double(f) * f;
            }
        return sum;
    });
    const double target = norm * double(tolerance) * tolerance;
    int cycles = 0;
    while (cycles < max_cycles && compute_residual(top) > target) {
        v_cycle(0);
        ++cycles;
    }
    return cycles;
}

// One V(2, 2) cycle [1, sec. 2.4]. The coarsest grid, a few cells wide, is relaxed until it is as good as solved.
void Multigrid::v_cycle(std::size_t l) {
    Level& level = levels_[l];
    if (l + 1 == levels_.size()) {
        for (int sweep = 0; sweep < 40; ++sweep) {
            smooth(level, sweep & 1);
            smooth(level, ~sweep & 1);
        }
        return;
    }
    for (int sweep = 0; sweep < 4; ++sweep)
        smooth(level, sweep & 1);
    compute_residual(level);
    Level& coarse = levels_[l + 1];
    restrict_residual(level, coarse);
    std::fill(coarse.p.values.begin(), coarse.p.values.end(), 0.0f);
    v_cycle(l + 1);
    add_correction(coarse, level);
    for (int sweep = 0; sweep < 4; ++sweep)
        smooth(level, ~sweep & 1);
}

// Gauss-Seidel over the cells of one colour: no cell reads another of its own, so their order is free.
void Multigrid::smooth(Level& level, int colour) {
    const ivec3 n = level.cells;
    const std::size_t row = level.p.size.x, slab = row * level.p.size.y;
    const float h2 = level.h * level.h;
    for_slabs(n.z, [&](int slab_index) {
        const int k = slab_index + 1;
        for (int j = 1; j <= n.y; ++j) {
            const float diagonal = row_diagonal(n, j, k);
            float* p = level.p.values.data() + level.p.index(0, j, k);
            const float* f = level.rhs.values.data() + level.p.index(0, j, k);
            for (int i = 1 + ((j + k + colour) & 1); i <= n.x; i += 2) {
                float* c = p + i;
                const float around = c[-1] + c[1] + *(c - row) + c[row] + *(c - slab) + c[slab];
                *c = (around - h2 * f[i]) / diagonal_at(diagonal, n, i);
            }
        }
    });
}

// Leaves rhs - laplacian(p) in level.residual and returns the sum of its squares.
double Multigrid::compute_residual(Level& level) {
    const ivec3 n = level.cells;
    const std::size_t row = level.p.size.x, slab = row * level.p.size.y;
    const float over_h2 = 1.0f / (level.h * level.h);
    return sum_slabs(n.z, [&](int slab_index) {
        const int k = slab_index + 1;
        double sum = 0.0;
        for (int j = 1; j <= n.y; ++j) {
            const float diagonal = row_diagonal(n, j, k);
            const std::size_t start = level.p.index(0, j, k);
            const float* p = level.p.values.data() + start;
            const float* f = level.rhs.values.data() + start;
            float* r = level.residual.values.data() + start;
            float row_sum = 0.0f;
            for (int i = 1; i <= n.x; ++i) {
                const float* c = p + i;
                const float around = c[-1] + c[1] + *(c - row) + c[row] + *(c - slab) + c[slab];
                r[i] = f[i] - (around - diagonal_at(diagonal, n, i) * c[0]) * over_h2;
                row_sum += r[i] * r[i];
            }
            sum += row_sum;
        }
        return sum;
    });
}

// Mean of the eight cells inside each coarse one.
void Multigrid::restrict_residual(const Level& fine, Level& coarse) {
    for_slabs(coarse.cells.z, [&](int k) {
        for (int j = 0; j < coarse.cells.y; ++j)
            for (int i = 0; i < coarse.cells.x; ++i) {
                float sum = 0.0f;
                for (int c = 0; c < 8; ++c)
                    sum += fine.residual(2 * i + 1 + (c & 1), 2 * j + 1 + ((c >> 1) & 1), 2 * k + 1 + (c >> 2));
                coarse.rhs(i + 1, j + 1, k + 1) = 0.125f * sum;
            }
    });
}

// Trilinear between cell centres: 3/4 of the own coarse cell and 1/4 of the nearer neighbour along each axis.
void Multigrid::add_correction(Level& coarse, Level& fine) {
    set_ghosts(coarse.p, coarse.cells, 1.0f);
    const Field<float>& e = coarse.p;
    for_slabs(fine.cells.z, [&](int slab_index) {
        const int k = slab_index + 1, ck = (k + 1) / 2, nk = ck + ((k & 1) ? -1 : 1);
        for (int j = 1; j <= fine.cells.y; ++j) {
            const int cj = (j + 1) / 2, nj = cj + ((j & 1) ? -1 : 1);
            const auto across = [&](int i) {
                return 0.75f * (0.75f * e(i, cj, ck) + 0.25f * e(i, nj, ck)) +
                       0.25f * (0.75f * e(i, cj, nk) + 0.25f * e(i, nj, nk));
            };
            float before = across(0), here = across(1);
            for (int ci = 1; ci <= coarse.cells.x; ++ci) {
                const float after = across(ci + 1);
                fine.p(2 * ci - 1, j, k) += 0.75f * here + 0.25f * before;
                fine.p(2 * ci, j, k) += 0.75f * here + 0.25f * after;
                before = here;
                here = after;
            }
        }
    });
    set_ghosts(coarse.p, coarse.cells, 0.0f);
}

}  // namespace brisance::combustion
