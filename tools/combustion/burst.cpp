#include "burst.h"

#include "noise.h"

namespace brisance::combustion {

float Puff::depth(const vec3& world) const {
    const vec3 d = world - centre;
    const float distance = glm::length(d);
    if (distance > 2.0f * radius)
        return -radius;
    return radius * (1.0f + 0.6f * fractal_noise(d * (1.3f / radius), seed, 4, 0.6f)) - distance;
}

std::vector<Puff> make_puffs(const Settings& settings) {
    constexpr float kTwoPi = 6.2831853f;
    std::vector<Puff> puffs;
    const float size = settings.burst_radius;
    for (int n = 0; n < settings.puffs; ++n) {
        const auto random = [&](std::uint32_t purpose) {
            return hashed_uniform(settings.seed, static_cast<std::uint32_t>(n), purpose);
        };
        // Stratified around the centre so that no seed leaves one side bare.
        const float angle = kTwoPi * (static_cast<float>(n) * 0.381966f + 0.25f * random(0));
        const float r = size * std::sqrt(random(1));
        const vec3 outwards(std::cos(angle), std::sin(angle), 0.0f);
        // Every fourth puff runs along the ground and makes the skirt; the others shoot up, leaning outwards.
        const bool skirt = n % 4 == 3;
        const float rise = skirt ? 0.15f : 0.7f + 0.8f * random(7);
        const float lean = skirt ? 0.8f : (r / size) * (0.25f + 0.75f * random(2));
        const float speed = settings.burst_speed * (skirt ? 0.5f : 0.45f + 0.8f * random(3) * random(4));
        Puff puff;
        puff.richness = 0.35f + 0.65f * random(10);
        puff.radius = size * (0.28f + 0.3f * random(5));
        puff.centre = outwards * r + vec3(0.0f, 0.0f, size * (skirt ? 0.15f : 0.25f + 0.9f * random(6)));
        puff.velocity = speed * glm::normalize(outwards * lean + vec3(0.0f, 0.0f, rise));
        puff.start = n == 0 ? 0.0f : settings.burst_duration * random(8);
        puff.duration = settings.burst_duration * (0.4f + 0.4f * random(9));
        puff.seed = settings.seed * 7919u + static_cast<std::uint32_t>(n) * 31u;
        puffs.push_back(puff);
    }
    return puffs;
}

}  // namespace brisance::combustion
