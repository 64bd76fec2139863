#include "scattering/lattice_level.h"

#include <algorithm>

namespace brisance {

namespace {

// Voxels in the volume that the smoke fills, and in all that holds smoke.
constexpr double kMostFilled = 90000.0, kMostOfAll = 1000000.0;
// Above this part of either, the next coarser level begins to count.
constexpr float kNearlyDue = 0.75f;

}  // namespace

double lattice_fullness(std::span<const float> extinction) {
    double sum = 0.0, squares = 0.0, all = 0.0;
    for (const float e : extinction) {
        sum += e;
        squares += double(e) * e;
        all += e > 0.0f;
    }
    const double filled = squares > 0.0 ? sum * sum / squares : 0.0;
    return std::max(filled / kMostFilled, all / kMostOfAll);
}

LatticeChoice automatic_lattice(const ExtinctionPyramid& pyramid) {
    const int last = pyramid.level_count() - 1;
    LatticeChoice choice;
    double full = lattice_fullness(pyramid.nodes(0));
    while (choice.level < last && full > 1.0)
        full = lattice_fullness(pyramid.nodes(++choice.level));
    if (choice.level < last)
        choice.share_of_coarser = glm::smoothstep(kNearlyDue, 1.0f, float(full));
    return choice;
}

}  // namespace brisance
