#include "medium_lighting/levels/lattice_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "medium/extinction_met.h"
#include "medium/phase.h"
#include "medium_lighting/levels/coarse_lighting.h"
#include "medium_lighting/surface_occluders.h"

namespace brisance {

namespace {

constexpr float kErrorOfVoxels = 0.05f;

// Of the square of the emission that a coarser lattice lacks, relative: about the part of the light of a node in fire
// that comes from the fire within its own voxel.
constexpr float kErrorOfEmission = 0.1f;

// Around a fire of radius R an interpolant through nodes h apart errs by about the square of h / R: voxels twice as
// wide changed MV by 2 % where a small fire in thin smoke had 18 voxels across, and four times as wide by 11 %.
constexpr float kErrorOfSmallFire = 0.45f;

// What is left of the error of voxels where the light of their detail is restored on the lattice twice as fine
// (light_of_detail.h). Pictures of the built-in explosion refined 2 and 4 times err by 0.6 and 0.9 % more on the voxels
// of the unrefined one than on voxels half as wide, 2.45 % being expected without that light.
constexpr float kLeftByDetail = 0.28f;

// Wider voxels were not measured, and are not chosen; nor those without fire.
constexpr int kWidest = 2, kWidestWithoutFire = 1;
// Of the smoke's, above those. Without fire nothing is known of where its light changes.
constexpr int kSmokeWider = 3, kSmokeWiderWithoutFire = 1;
// Of light that has scattered twice, over the square of the optical depth of a voxel. Pictures of an explosion, a ball
// and a cloud of albedo 1 changed by 0.04 to 0.1 of it. About the square of the albedo of what the picture shows is
// such light.
constexpr float kErrorOfSmoke = 0.1f;
// Smoke around a small fire is bright near it: what kErrorOfEmission is to the fire's light. Half of it, as the light
// that arrives has flown a way.
constexpr float kErrorOfEmissionInSmoke = 0.05f;

// Of light that scatters within the voxel around a lamp. A lamp in a ball of smoke had a third of its light there on
// voxels twice as wide, and MM 7 to 12 % too bright, the picture 4 to 7 %.
constexpr float kErrorBesideLamps = 0.2f;

// The mean albedo, as a collision meets it.
float albedo_met(const Medium& medium) {
    double sum = 0.0, all = 0.0;
    for (std::size_t i = 0; i < medium.extinction.size(); ++i) {
        const double weight = double(medium.extinction[i]) * medium.extinction[i];
        sum += weight * luminance(medium.albedo_at(i));
        all += weight;
    }
    return all > 0.0 ? float(sum / all) : 0.0f;
}

}  // namespace

float error_of_voxels(float depth) {
    return kErrorOfVoxels * depth * depth;
}

LatticeErrors::LatticeErrors(const Medium& medium, const Occluders* surfaces, const Surroundings* surroundings)
    : medium_(medium), surfaces_(surfaces), depth_(medium.spacing * float(extinction_met(medium.extinction))) {
    if (surroundings && !surroundings->emitters().points().empty())
        lamps_ = LampsInSmoke(*surroundings, medium, fire_power());
}

float LatticeErrors::of_first_without_detail(int level) {
    return std::hypot(of_detail(level), of_small_fire(level));
}

float LatticeErrors::of_first(int level) {
    const float left = medium_.emits() ? kLeftByDetail : 1.0f;  // not measured without fire
    return std::hypot(left * of_detail(level), of_small_fire(level), narrow(level));
}

float LatticeErrors::of_smoke(int level) {
    if (!albedo_)
        albedo_ = albedo_met(medium_);
    const float depth = std::exp2(float(level)) * depth_of_smoke();
    return std::hypot(kErrorOfSmoke * *albedo_ * *albedo_ * depth * depth,
                      kErrorOfEmissionInSmoke * unresolved_emission(level), narrow(level));
}

int LatticeErrors::widest_of_first() const {
    return medium_.emits() ? kWidest : kWidestWithoutFire;
}

float LatticeErrors::widest_of_smoke() const {
    return float(medium_.emits() ? kSmokeWider : kSmokeWiderWithoutFire);
}

float LatticeErrors::narrow(int level) {
    return narrow_errors_count_ * std::hypot(of_walls(level), of_lamps(level));
}

float LatticeErrors::of_detail(int level) {
    const float voxels = error_of_voxels(std::exp2(float(level)) * depth_) - error_of_voxels(depth_);
    return std::hypot(voxels, kErrorOfEmission * unresolved_emission(level));
}

float LatticeErrors::of_lamps(int level) const {
    return level > 0 ? kErrorBesideLamps * lamps_.scattered_beside_them(level) : 0.0f;
}

// Light that smoke sends out on the other side of surfaces, of all of it.
float LatticeErrors::of_walls(int level) {
    if (level == 0 || !surfaces_)
        return 0.0f;
    const auto [known, is_new] = beyond_.try_emplace(level);
    if (is_new)
        known->second = float(part_beyond_surfaces(medium_, level, *surfaces_));
    return known->second;
}

// Light that is scattered back runs the same short stretch again and again. Depths count (1 - g) / (1 + g) times as
// much, as a walk of equal steps with the mean cosine g gets less far. With 1 - g, as of exponential steps, a ball of
// g = -0.999 sent out 4.9 % too much; 2.3 % on its own lattice.
float LatticeErrors::depth_of_smoke() const {
    const float g = std::min(0.0f, medium_.mean_cosine);
    return depth_ * (1.0f - g) / std::max(1.0f + g, 1e-3f);
}

// By the volume that the emission fills, (integral of j)^2 / (integral of j^2), as that of a ball.
float LatticeErrors::of_small_fire(int level) {
    if (level == 0 || !medium_.emits())
        return 0.0f;
    if (!fire_radius_) {
        double sum = 0.0, squares = 0.0;
        for (const float j : fire(0).values) {
            sum += j;
            squares += double(j) * j;
        }
        const double filled = squares > 0.0 ? sum * sum / squares : 0.0;
        fire_radius_ = float(std::cbrt(3.0 / (4.0 * double(kPi)) * filled));
    }
    const float wider = std::exp2(2.0f * float(level)) - 1.0f;
    return *fire_radius_ > 0.0f ? kErrorOfSmallFire * wider / (*fire_radius_ * *fire_radius_) : 0.0f;
}

const Averages& LatticeErrors::fire(int level) {
    if (fire_.empty())
        fire_.push_back({medium_.lattice, emission_luminance(medium_)});
    for (int l = static_cast<int>(fire_.size()); l <= level; ++l)
        fire_.push_back(averaged_down(fire_.back().lattice, fire_.back().values, 1, 1));
    return fire_[std::size_t(level)];
}

double LatticeErrors::fire_power() {
    if (!medium_.emits())
        return 0.0;
    const std::vector<float>& emission = fire(0).values;
    return 4.0 * double(kPi) * double(medium_.voxel_volume) * std::accumulate(emission.begin(), emission.end(), 0.0);
}

// The square of the emission (relative, root mean square) that an interpolant through the lattice's means lacks.
float LatticeErrors::unresolved_emission(int level) {
    if (level == 0 || !medium_.emits())
        return 0.0f;
    const auto [known, is_new] = unresolved_.try_emplace(level);
    if (is_new)
        known->second = lacking_at(level);
    return known->second;
}

float LatticeErrors::lacking_at(int level) {
    const Averages &own = fire(0), &means = fire(level);
    constexpr std::size_t kNodes = BrickLattice::kNodes;
    std::vector<double> off(own.lattice.brick_count()), all(off.size());
    parallel_for(
        off.size(),
        [&](std::size_t b) {
            std::array<float, kNodes> found;
            scalars_at_fine_nodes(means.lattice, means.values, level, own.lattice, b, found);
            for (std::size_t k = 0; k < kNodes; ++k) {
                const double value = own.values[b * kNodes + k];
                if (value > 0.0)
                    off[b] += (value - found[k]) * (value - found[k]);
                all[b] += value * value;
            }
        },
        16);
    const double sum = std::accumulate(all.begin(), all.end(), 0.0);
    return sum > 0.0 ? float(std::accumulate(off.begin(), off.end(), 0.0) / sum) : 0.0f;
}

}  // namespace brisance
