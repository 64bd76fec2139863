#include "scattering/lattice_level.h"

#include <algorithm>

namespace brisance {

namespace {

// Voxels in the volume that the smoke fills, and in all that holds smoke.
constexpr double kMostFilled = 90000.0, kMostOfAll = 1000000.0;
// What a bounce on the medium's own lattice corrects, the series need not know: voxels 1.65 times as wide will do.
constexpr double kCrowding = 4.5;
// The errors at which such bounces begin, and at which they are whole. Below, finer lattices err less.
constexpr float kErrorOfNoBounce = 0.01f, kErrorOfBounce = 0.02f;
// Above this part of either, the next coarser level begins to count.
constexpr float kNearlyDue = 0.75f;

float weight_of_fine_bounces(const ScatteringSettings& settings, float error) {
    if (settings.fine_bounces >= 0)
        return settings.fine_bounces > 0 ? 1.0f : 0.0f;
    return std::clamp((error - kErrorOfNoBounce) / (kErrorOfBounce - kErrorOfNoBounce), 0.0f, 1.0f);
}

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

double crowding(const ScatteringSettings& settings, float error) {
    return 1.0 + (kCrowding - 1.0) * weight_of_fine_bounces(settings, error);
}

LatticeChoice automatic_lattice(const ExtinctionPyramid& pyramid, double crowding) {
    const int last = pyramid.level_count() - 1;
    LatticeChoice choice;
    double full = crowding * lattice_fullness(pyramid.nodes(0));
    while (choice.level < last && full > 1.0)
        full = crowding * lattice_fullness(pyramid.nodes(++choice.level));
    if (choice.level < last)
        choice.share_of_coarser = glm::smoothstep(kNearlyDue, 1.0f, float(full));
    return choice;
}

float share_of_fine_bounces(const LatticeChoice& lattice, const ScatteringSettings& settings, float error) {
    return weight_of_fine_bounces(settings, error) * (lattice.level > 0 ? 1.0f : lattice.share_of_coarser);
}

LatticeChoice lattice_of_series(const ExtinctionPyramid& pyramid, const ScatteringSettings& settings, float error) {
    const int wish = settings.lattice_level;
    return wish < 0 ? automatic_lattice(pyramid, crowding(settings, error))
                    : LatticeChoice{std::min(wish, pyramid.level_count() - 1), 0.0f};
}

}  // namespace brisance
