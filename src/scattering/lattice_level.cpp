#include "scattering/lattice_level.h"

#include <algorithm>

namespace brisance {

namespace {

// Voxels in the volume that the smoke fills, and in all that holds smoke.
constexpr double kMostFilled = 90000.0, kMostOfAll = 1000000.0;
// The same, over that of a coarse lattice whose light is corrected by a bounce on the medium's own: as much as is left
// of the voxels where the medium's own lattice is full, so that no lattice is passed over.
constexpr double kRoomOfCorrected = 4.5;
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

double least_room(int level, bool corrected) {
    return corrected && level > 0 ? kRoomOfCorrected : 1.0;
}

LatticeChoice automatic_lattice(const ExtinctionPyramid& pyramid, bool corrected) {
    const int last = pyramid.level_count() - 1;
    LatticeChoice choice;
    const auto fullness = [&](int level) {
        return least_room(level, corrected) * lattice_fullness(pyramid.nodes(level));
    };
    double full = fullness(0);
    while (choice.level < last && full > 1.0)
        full = fullness(++choice.level);
    if (choice.level < last)
        choice.share_of_coarser = glm::smoothstep(kNearlyDue, 1.0f, float(full));
    return choice;
}

float share_of_fine_bounces(const LatticeChoice& lattice) {
    return lattice.level > 0 ? 1.0f : lattice.share_of_coarser;
}

LatticeChoice lattice_of_series(const ExtinctionPyramid& pyramid, const ScatteringSettings& settings) {
    const int wish = settings.lattice_level;
    return wish < 0 ? automatic_lattice(pyramid, settings.fine_bounces > 0)
                    : LatticeChoice{std::min(wish, pyramid.level_count() - 1), 0.0f};
}

}  // namespace brisance
