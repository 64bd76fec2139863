#include "medium_lighting/levels/lighting_level.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "gathering/settings.h"
#include "medium/coarse_medium.h"
#include "medium/extinction_met.h"
#include "medium/phase.h"
#include "medium_lighting/levels/coarse_lighting.h"
#include "medium_lighting/levels/lamps_in_smoke.h"
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

// Of lighting.error: what the interpolation of nodes may add.
constexpr float kShareOfInterpolation = 0.25f;

// Beyond this many times what is allowed, the next coarser lattice does not count, and no node is interpolated.
// Between, light is gathered on both lattices, which is dear: beside samples, which leave little of the difference, the
// stretch is shorter.
constexpr float kNearlyAllowed = 1.5f, kNearlyAllowedOfMore = 1.3f;

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

// Of lighting.lattice_error, or what it is by default.
float allowed_of_first(const LightingSettings& settings) {
    return settings.lattice_error >= 0.0f ? settings.lattice_error : kShareOfLattice * settings.error;
}

// Over the default.
float allowed_over_usual(const LightingSettings& settings) {
    const float usual = kShareOfLattice * settings.error;
    return usual > 0.0f ? allowed_of_first(settings) / usual : 1.0f;
}

// In proportion. Where lighting.error is more than usual, other errors grow, too.
float allowed_of_smoke(const LightingSettings& settings) {
    constexpr float kUsual = 0.02f;
    const float usual = settings.error <= kUsual ? settings.error : std::sqrt(kUsual * settings.error);
    return allowed_over_usual(settings) * usual;
}

// Where more is allowed than usual, for the sake of a correction: errors beside walls and lamps are too narrow for its
// samples and are seen as leaks. They count twice as much where three times as much is allowed.
float narrow_errors_count(const LightingSettings& settings) {
    return 0.5f + 0.5f * std::max(1.0f, allowed_over_usual(settings));
}

float nearly_allowed(const LightingSettings& settings) {
    const float more = std::max(1.0f, allowed_over_usual(settings)) - 1.0f;
    return std::max(kNearlyAllowedOfMore, kNearlyAllowed - 0.5f * more);
}

// Errors of light on ever coarser lattices. What they need of the medium is looked for when it is asked for, and once.
class LatticeErrors {
public:
    // `surfaces`: null: none reaches into the medium.
    explicit LatticeErrors(const Medium& medium, const Occluders* surfaces = nullptr,
                           const Surroundings* surroundings = nullptr)
        : medium_(medium), surfaces_(surfaces), depth_(medium.spacing * float(extinction_met(medium.extinction))) {
        if (surroundings && !surroundings->emitters().points().empty())
            lamps_ = LampsInSmoke(*surroundings, medium, fire_power());
    }

    // For how much errors beside walls and lamps count.
    void count_narrow_errors(float times) { narrow_errors_count_ = times; }

    // Relative, of the picture, on voxels 2^level wide; and with the light of their detail.
    float of_first_without_detail(int level) { return std::hypot(of_detail(level), of_small_fire(level)); }
    float of_first(int level) {
        const float left = medium_.emits() ? kLeftByDetail : 1.0f;  // not measured without fire
        return std::hypot(left * of_detail(level), of_small_fire(level), narrow(level));
    }
    float of_smoke(int level) {
        if (!albedo_)
            albedo_ = albedo_met(medium_);
        const float depth = std::exp2(float(level)) * depth_of_smoke();
        return std::hypot(kErrorOfSmoke * *albedo_ * *albedo_ * depth * depth,
                          kErrorOfEmissionInSmoke * unresolved_emission(level), narrow(level));
    }

    int widest_of_first() const { return medium_.emits() ? kWidest : kWidestWithoutFire; }
    float widest_of_smoke() const { return float(medium_.emits() ? kSmokeWider : kSmokeWiderWithoutFire); }

private:
    float narrow(int level) { return narrow_errors_count_ * std::hypot(of_walls(level), of_lamps(level)); }

    float of_detail(int level) {
        const float voxels = error_of_voxels(std::exp2(float(level)) * depth_) - error_of_voxels(depth_);
        return std::hypot(voxels, kErrorOfEmission * unresolved_emission(level));
    }

    float of_lamps(int level) const {
        return level > 0 ? kErrorBesideLamps * lamps_.scattered_beside_them(level) : 0.0f;
    }

    double fire_power() {
        double sum = 0.0;
        if (medium_.emits())
            for (const float j : emission())
                sum += j;
        return 4.0 * double(kPi) * double(medium_.voxel_volume) * sum;
    }

    // Light that smoke sends out on the other side of surfaces, of all of it.
    float of_walls(int level) {
        if (level == 0 || !surfaces_)
            return 0.0f;
        const auto [known, is_new] = beyond_.try_emplace(level);
        if (is_new)
            known->second = float(part_beyond_surfaces(medium_, level, *surfaces_));
        return known->second;
    }

    // Light that is scattered back runs the same short stretch again and again. Depths count (1 - g) / (1 + g) times as
    // much, as a walk of equal steps with the mean cosine g gets less far. With 1 - g, as of exponential steps, a ball
    // of g = -0.999 sent out 4.9 % too much; 2.3 % on its own lattice.
    float depth_of_smoke() const {
        const float g = std::min(0.0f, medium_.mean_cosine);
        return depth_ * (1.0f - g) / std::max(1.0f + g, 1e-3f);
    }

    // By the volume that the emission fills, (integral of j)^2 / (integral of j^2), as that of a ball.
    float of_small_fire(int level) {
        if (level == 0 || !medium_.emits())
            return 0.0f;
        if (!fire_radius_) {
            double sum = 0.0, squares = 0.0;
            for (const float j : emission()) {
                sum += j;
                squares += double(j) * j;
            }
            const double filled = squares > 0.0 ? sum * sum / squares : 0.0;
            fire_radius_ = float(std::cbrt(3.0 / (4.0 * double(kPi)) * filled));
        }
        const float wider = std::exp2(2.0f * float(level)) - 1.0f;
        return *fire_radius_ > 0.0f ? kErrorOfSmallFire * wider / (*fire_radius_ * *fire_radius_) : 0.0f;
    }

    const std::vector<float>& emission() {
        if (emission_.empty())
            emission_ = emission_luminance(medium_);
        return emission_;
    }

    // The square of the emission (relative, root mean square) that an interpolant through the lattice's means lacks.
    float unresolved_emission(int level) {
        if (level == 0 || !medium_.emits())
            return 0.0f;
        emission();
        const auto [known, is_new] = unresolved_.try_emplace(level);
        if (is_new)
            known->second = lacking_at(level);
        return known->second;
    }

    float lacking_at(int level) const {
        const BrickLattice& nodes = medium_.lattice;
        const Averages means = averaged_down(nodes, emission_, 1, level);
        const std::vector<float> found = scalars_at_fine_nodes(means.lattice, means.values, level, nodes);
        std::vector<double> off(nodes.brick_count()), all(nodes.brick_count());
        parallel_for(
            nodes.brick_count(),
            [&](std::size_t b) {
                for (std::size_t i = b * BrickLattice::kNodes; i < (b + 1) * BrickLattice::kNodes; ++i) {
                    const double value = emission_[i];
                    if (value > 0.0)
                        off[b] += (value - found[i]) * (value - found[i]);
                    all[b] += value * value;
                }
            },
            16);
        double off_sum = 0.0, sum = 0.0;
        for (std::size_t b = 0; b < all.size(); ++b) {
            off_sum += off[b];
            sum += all[b];
        }
        return sum > 0.0 ? float(off_sum / sum) : 0.0f;
    }

    const Medium& medium_;
    const Occluders* surfaces_;
    LampsInSmoke lamps_;
    float narrow_errors_count_ = 1.0f;
    float depth_;  // of a voxel
    std::optional<float> albedo_;
    std::optional<float> fire_radius_;  // in voxels
    std::vector<float> emission_;       // luminance per node
    std::map<int, float> unresolved_;
    std::map<int, float> beyond_;  // surfaces
};

// Light of a lattice and the next coarser one, whose errors are known.
LightingLevel between(int level, float error, float of_coarser, float allowed, float nearly) {
    const float share = of_coarser > 0.0f ? 1.0f - glm::smoothstep(allowed, nearly * allowed, of_coarser) : 1.0f;
    return {level, share, error, of_coarser};
}

ToleratedInterpolation interpolation_of(LatticeErrors& errors, const LightingSettings& settings, int level) {
    if (settings.interpolation >= 0.0f || !(settings.error > 0.0f))
        return {std::max(0.0f, settings.interpolation), 0.0f};
    const float more = errors.of_first_without_detail(level + 1) - errors.of_first_without_detail(level);
    return {kShareOfInterpolation * settings.error, more / settings.error};
}

// Both as a level and a share of the next in one number.
float position(const LightingLevel& level) {
    return float(level.level) + level.share_of_coarser;
}

// A hundredth of the light is not worth a lattice of its own: both differ by some percent, so that this leaves steps of
// less than a thousandth.
float without_traces(float level) {
    constexpr float kTrace = 0.01f;
    const float nearest = std::round(level);
    return std::abs(level - nearest) < kTrace ? nearest : level;
}

LightingLevel without_traces(const LightingLevel& light) {
    const float at = without_traces(position(light));
    if (at > position(light))
        return {light.level + 1, 0.0f, light.error_of_coarser};
    return {light.level, at - float(light.level), light.error, light.error_of_coarser};
}

// `error`: of a level.
template <class Error>
LightingLevel stated_level(int level, const Error& error) {
    return level > 0 ? LightingLevel{level, 0.0f, error(level)} : LightingLevel{};
}

LightingLevel level_of_first(LatticeErrors& errors, const LightingSettings& settings) {
    if (settings.lattice_level >= 0 || settings.interpolation >= 0.0f)
        return stated_level(settings.lattice_level, [&](int level) { return errors.of_first(level); });
    const float allowed = allowed_of_first(settings);
    if (!(allowed > 0.0f))
        return {};
    int level = 0;
    float error = 0.0f;
    for (;;) {
        const float next = errors.of_first(level + 1);
        if (next > allowed)
            return without_traces(between(level, error, next, allowed, nearly_allowed(settings)));
        error = next;
        if (++level == errors.widest_of_first())
            return {level, 0.0f, error};
    }
}

// The widest voxels that the error of the smoke's light allows, from a level on.
LightingLevel smoke_by_error(LatticeErrors& errors, const LightingSettings& settings, int from, float widest) {
    const float most = allowed_of_smoke(settings);
    int allowed = from;
    float error = errors.of_smoke(allowed), next = errors.of_smoke(allowed + 1);
    while (float(allowed) < widest && next <= most) {
        ++allowed;
        error = std::exchange(next, errors.of_smoke(allowed + 1));
    }
    return between(allowed, error, next, most, nearly_allowed(settings));
}

// Light of the smoke follows from that on the lattice of the first, and has nothing finer.
LightingLevel no_wider_than_smoke(LatticeErrors& errors, const LightingSettings& settings, const LightingLevel& first) {
    const bool stated =
        settings.lattice_level >= 0 || settings.smoke_lattice_level >= 0 || settings.interpolation >= 0.0f;
    if (stated || position(first) == 0.0f)
        return first;
    const float most = without_traces(position(smoke_by_error(errors, settings, 0, position(first))));
    if (position(first) <= most)
        return first;
    const int level = static_cast<int>(most);
    return {level, most - float(level), errors.of_first(level), errors.of_first(level + 1)};
}

LightingLevel level_of_smoke(LatticeErrors& errors, const LightingSettings& settings, const LightingLevel& first) {
    if (settings.smoke_lattice_level >= 0)
        return stated_level(std::max(settings.smoke_lattice_level, first.level),
                            [&](int level) { return errors.of_smoke(level); });
    if (settings.lattice_level >= 0 || settings.interpolation >= 0.0f)
        return {first.level};
    const float finest = position(first), widest = finest + errors.widest_of_smoke();
    const LightingLevel by_error = smoke_by_error(errors, settings, first.level, widest);
    const float at = without_traces(std::clamp(position(by_error), finest, widest));
    const int level = static_cast<int>(at);
    return {level, at - float(level), level == by_error.level ? by_error.error : errors.of_smoke(level),
            level == by_error.level ? by_error.error_of_coarser : errors.of_smoke(level + 1)};
}

LightingLevels levels_by(LatticeErrors& errors, const LightingSettings& settings) {
    errors.count_narrow_errors(narrow_errors_count(settings));
    const LightingLevel first = no_wider_than_smoke(errors, settings, level_of_first(errors, settings));
    return {first, level_of_smoke(errors, settings, first),
            interpolation_of(errors, settings, first.level).of(1.0f - first.share_of_coarser)};
}

}  // namespace

float error_of_voxels(float depth) {
    return kErrorOfVoxels * depth * depth;
}

std::vector<LightingLevels> levels_for_each(const Medium& medium, std::span<const LightingSettings> settings,
                                            const Surroundings* surroundings) {
    std::optional<SurfaceOccluders> surfaces;
    if (surfaces_reach_into(surroundings, medium))
        surfaces.emplace(surroundings->intersector(), medium.spacing);
    LatticeErrors errors(medium, surfaces ? &*surfaces : nullptr, surroundings);
    std::vector<LightingLevels> out;
    for (const LightingSettings& s : settings)
        out.push_back(levels_by(errors, s));
    return out;
}

LightingLevels lighting_levels(const Medium& medium, const LightingSettings& settings,
                               const Surroundings* surroundings) {
    return levels_for_each(medium, std::span(&settings, 1), surroundings).front();
}

std::optional<LightingLevels> stated_levels(const LightingSettings& settings) {
    if (settings.lattice_level < 0 || settings.smoke_lattice_level < 0)
        return std::nullopt;
    return LightingLevels{{settings.lattice_level}, {std::max(settings.lattice_level, settings.smoke_lattice_level)}};
}

float ToleratedInterpolation::of(float share) const {
    return most * (1.0f - glm::smoothstep(1.0f, kNearlyAllowed, share * of_coarser));
}

ToleratedInterpolation tolerated_interpolation(const Medium& medium, const LightingSettings& settings) {
    LatticeErrors errors(medium);
    return interpolation_of(errors, settings, 0);
}

}  // namespace brisance
