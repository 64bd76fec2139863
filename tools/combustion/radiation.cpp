#include "radiation.h"

namespace brisance::combustion {

namespace {

Field<float> halved(const Field<float>& fine) {
    Field<float> coarse(fine.size / 2);
    for_slabs(coarse.size.z, [&](int k) {
        for (int j = 0; j < coarse.size.y; ++j)
            for (int i = 0; i < coarse.size.x; ++i) {
                float sum = 0.0f;
                for (int c = 0; c < 8; ++c)
                    sum += fine(2 * i + (c & 1), 2 * j + ((c >> 1) & 1), 2 * k + (c >> 2));
                coarse(i, j, k) = 0.125f * sum;
            }
    });
    return coarse;
}

// Optical depth from each cell's centre to the outside along d, one addition per cell: the neighbour's depth plus the
// half cells between the two centres.
void sweep(const Field<float>& sigma, const ivec3& d, float cell_size, Field<float>& tau) {
    const ivec3 n = sigma.size;
    const float half_length = 0.5f * cell_size * glm::length(vec3(d));
    const auto ordered = [](int step, int count, int towards) { return towards > 0 ? count - 1 - step : step; };
    for (int c = 0; c < n.z; ++c) {
        const int k = ordered(c, n.z, d.z);
        for (int b = 0; b < n.y; ++b) {
            const int j = ordered(b, n.y, d.y);
            for (int a = 0; a < n.x; ++a) {
                const int i = ordered(a, n.x, d.x);
                const ivec3 next = ivec3(i, j, k) + d;
                float beyond = 0.0f;
                if (next.z < 0)
                    beyond = 100.0f;
                else if (next.x >= 0 && next.y >= 0 && next.x < n.x && next.y < n.y && next.z < n.z)
                    beyond = tau(next.x, next.y, next.z) + half_length * sigma(next.x, next.y, next.z);
                tau(i, j, k) = beyond + half_length * sigma(i, j, k);
            }
        }
    }
}

// Binomial weights 1/4, 1/2, 1/4 along one axis.
Field<float> blurred(const Field<float>& f, int axis) {
    Field<float> result(f.size);
    ivec3 d(0);
    d[axis] = 1;
    for_slabs(f.size.z, [&](int k) {
        for (int j = 0; j < f.size.y; ++j)
            for (int i = 0; i < f.size.x; ++i) {
                const ivec3 c(i, j, k);
                const ivec3 low = glm::max(c - d, ivec3(0)), high = glm::min(c + d, f.size - 1);
                result(i, j, k) = 0.5f * f(i, j, k) + 0.25f * (f(low.x, low.y, low.z) + f(high.x, high.y, high.z));
            }
    });
    return result;
}

// The 26 directions from a cell to its neighbours.
std::vector<ivec3> neighbour_directions() {
    std::vector<ivec3> directions;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                if (x != 0 || y != 0 || z != 0)
                    directions.push_back(ivec3(x, y, z));
    return directions;
}

}  // namespace

Field<float> escape_fraction(const Field<float>& soot, float cell_size, float absorption) {
    const std::vector<ivec3> directions = neighbour_directions();
    Field<float> sigma = halved(soot);
    for (float& s : sigma.values)
        s *= absorption;
    std::vector<Field<float>> tau(directions.size(), Field<float>(sigma.size));
    parallel_for(directions.size(), [&](std::size_t d) { sweep(sigma, directions[d], 2.0f * cell_size, tau[d]); });

    Field<float> escape(sigma.size);
    for_slabs(sigma.size.z, [&](int k) {
        for (std::size_t c = sigma.index(0, 0, k); c < sigma.index(0, 0, k + 1); ++c) {
            float sum = 0.0f;
            for (const Field<float>& t : tau)
                sum += std::exp(-t.values[c]);
            escape.values[c] = sum / static_cast<float>(directions.size());
        }
    });
    // Sweeps along diagonals never mix neighbouring cells: without this the crust shows the grid.
    for (int axis = 0; axis < 3; ++axis)
        escape = blurred(escape, axis);
    return escape;
}

}  // namespace brisance::combustion
