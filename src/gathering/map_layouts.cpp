#include "gathering/map_layouts.h"

#include <algorithm>
#include <cmath>

#include "gathering/node_receivers.h"
#include "gathering/separations.h"
#include "medium/lattice/local_bounds.h"

namespace brisance {

namespace {

constexpr float kNearestOfBalls = 0.25f;  // first distance of the maps of the finest level's lights, over their spacing

// Distance from any light of the level to the farthest corner of the medium. Nothing attenuates light beyond it.
float farthest_distance(const GridLevel& level, const Medium& medium) {
    Box lights;
    for (const vec3& p : level.position)
        lights.add(p);
    const LocalBounds corners = local_bounds(medium);
    const vec3 far = glm::max(glm::abs(lights.high - corners.low), glm::abs(corners.high - lights.low));
    return glm::length(far);
}

// Maps of 12^2 texels and 10 distances add about 1 % to the error of a picture of dense smoke, in quadrature to the
// rest (balls and explosions against maps of 20^2 and of 8^2 texels). The error falls as the resolution's power 4/3, so
// that these are of half the error asked for.
constexpr float kKnownError = 0.02f, kKnownResolution = 12.0f, kKnownDistances = 10.0f;
constexpr float kLeastError = 1e-3f;  // beyond it, other errors of the hierarchy remain

// The errors of many lights' maps average out. A level of fewer lights than this has finer maps, so that the error of
// their sum is that of so many lights. All maps together still cost less.
constexpr float kFewLights = 4096.0f;

float growth_for_few(std::size_t lights) {
    return std::pow(std::max(1.0f, kFewLights / float(std::max<std::size_t>(lights, 1))), 0.375f);
}

float times_finer(const LightingSettings& settings) {
    return std::pow(kKnownError / std::max(settings.error, kLeastError), 0.75f);
}

}  // namespace

int shadow_resolution(const LightingSettings& settings) {
    if (settings.shadow_resolution > 0)
        return settings.shadow_resolution;
    return std::max(4, static_cast<int>(std::lround(kKnownResolution * times_finer(settings))));
}

int shadow_distances(const LightingSettings& settings) {
    if (settings.shadow_distances > 0)
        return settings.shadow_distances;
    return std::max(4, static_cast<int>(std::lround(kKnownDistances * std::sqrt(times_finer(settings)))));
}

ShadowMapLayout map_layout(const LightField& field, const GridLevel& level, bool top) {
    ShadowMapLayout layout;
    // A coarser light's map covers more voxels but its own size blurs its shadows: resolution grows as the square root
    // of the spacing (more gained less than the hierarchy's own error on real smoke), to even numbers.
    const float growth =
        std::max(std::sqrt(float(1 << std::min(level.level - 1, 6))), growth_for_few(level.position.size()));
    layout.resolution =
        std::min(128, 2 * static_cast<int>(std::lround(0.5f * growth * shadow_resolution(field.settings))));
    layout.distances = shadow_distances(field.settings);
    const float radius = field.alpha * level.spacing;
    layout.near_distance = level.level == field.bottom ? kNearestOfBalls * level.spacing : 0.5f * radius;
    layout.far_distance = 2.0f * radius;
    layout.for_outside = field.escape != nullptr;
    layout.range = layout.for_outside ? 1.0f / FootprintPicker::kLeastShare : 1.0f;
    if (top) {
        const float far = std::max(layout.far_distance, farthest_distance(level, field.pyramid->medium()));
        layout.distances = std::min(64, static_cast<int>(std::ceil(layout.distances * far / layout.far_distance)));
        layout.far_distance = far;
    }
    if (!field.intensity) {  // lights outside of the medium
        layout.geometric = true;
        const float range = layout.far_distance - layout.near_distance;
        layout.distances = std::max(layout.distances, std::min(256, 1 + int(range / field.pyramid->medium().spacing)));
    }
    return layout;
}

std::uint64_t map_bytes(const LightField& field) {
    std::uint64_t sum = 0;
    for (const GridLevel& level : field.grid->levels)
        if (level.size() > 0 && field.settings.shadows == ShadowMethod::Maps &&
            (field.occluders || !gathers_by_separations(field, level, coarsening_of(field, level))))
            sum += level.size() * map_layout(field, level, &level == &field.grid->levels.back()).bytes_per_light();
    return sum;
}

void fit_to_memory(ShadowMapLayout& layout, std::size_t lights, std::uint64_t limit, int level, Progress& progress) {
    const ShadowMapLayout wish = layout;
    const auto too_large = [&] { return layout.bytes_per_light() * std::min(lights, kLeastBatch) > limit; };
    while (too_large() && layout.resolution > 4)
        layout.resolution /= 2;
    while (too_large() && layout.distances > 2)
        layout.distances = std::max(2, layout.distances / 2);
    if (layout.resolution != wish.resolution || layout.distances != wish.distances)
        progress.notice("shadow maps of level " + std::to_string(level) + " lowered from " +
                        std::to_string(wish.resolution) + "^2 x " + std::to_string(wish.distances) + " to " +
                        std::to_string(layout.resolution) + "^2 x " + std::to_string(layout.distances) +
                        " to stay within the memory limit of " + std::to_string(limit >> 20) +
                        " MiB; raise lighting.memory_limit_mebibytes to keep them");
}

}  // namespace brisance
