#include "shadows/surface_shadows.h"

#include <algorithm>
#include <cmath>

#include "shadows/octahedral_directions.h"

namespace brisance {

namespace {

constexpr std::size_t kParts = 2;  // tested for each texel

float visible_share(const Occluders& occluders, const MappedLight& light, std::size_t texel, const vec3& to) {
    if (light.parts.empty())
        return occluders.visible(glm::mix(light.centre, to, 0.5f), to) ? 1.0f : 0.0f;
    float seen = 0.0f;
    const std::size_t count = light.parts.size(), stride = count % 5 != 0 ? 5 : 7;  // of 64, or up to 16: prime to it
    for (std::size_t k = 0; k < kParts; ++k) {
        const std::size_t part = (texel * stride + k * count / kParts) % count;
        seen += occluders.visible(light.parts[part], to) ? 1.0f / kParts : 0.0f;
    }
    return seen;
}

// Radius around the light's centre within which all of its rays to surfaces lie.
float reach_of(const MappedLight& light, const ShadowMapLayout& layout) {
    float reach = light.start + layout.far_distance;
    for (const vec3& part : light.parts)
        reach = std::max(reach, glm::length(part - light.centre));
    return reach;
}

}  // namespace

void cut_at_surfaces(const Occluders& occluders, const MappedLight& light, const ShadowMapLayout& layout,
                     std::span<std::uint16_t> interior) {
    if (!occluders.any_within(light.centre, reach_of(light, layout)))
        return;
    const int r = layout.resolution;
    const float step = layout.distances > 1 ? (layout.far_distance - layout.near_distance) / (layout.distances - 1) : 0;
    for (int i = 0; i < r * r; ++i) {
        std::uint16_t* const samples = &interior[std::size_t(i) * layout.distances];
        if (samples[0] == 0)
            continue;
        const int u = i / r, v = i % r;
        const vec3 direction = octahedral_direction((2.0f * u + 1.0f) / r - 1.0f, (2.0f * v + 1.0f) / r - 1.0f);
        const vec3 near = light.centre + (light.start + layout.near_distance) * direction;
        const float share = visible_share(occluders, light, i, near);
        const float beyond = layout.far_distance - layout.near_distance;
        const float hit = share > 0.0f ? occluders.first_hit(near, direction, beyond) : 0.0f;
        if (share == 1.0f && hit >= beyond)
            continue;
        for (int k = 0; k < layout.distances; ++k)
            samples[k] = hit >= beyond || float(k) * step <= hit ? std::uint16_t(share * float(samples[k]) + 0.5f) : 0;
    }
}

}  // namespace brisance
