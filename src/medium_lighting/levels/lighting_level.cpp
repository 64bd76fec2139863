#include "medium_lighting/levels/lighting_level.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "gathering/settings.h"
#include "medium_lighting/levels/lattice_errors.h"
#include "medium_lighting/surface_occluders.h"

namespace brisance {

namespace {

// Of lighting.error: what the interpolation of nodes may add.
constexpr float kShareOfInterpolation = 0.25f;

// Beyond this many times what is allowed, the next coarser lattice does not count, and no node is interpolated.
// Between, light is gathered on both lattices, which is dear: beside samples, which leave little of the difference, the
// stretch is shorter.
constexpr float kNearlyAllowed = 1.5f, kNearlyAllowedOfMore = 1.3f;

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
