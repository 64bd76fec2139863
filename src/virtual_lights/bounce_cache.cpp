#include "virtual_lights/bounce_cache.h"

#include <algorithm>
#include <utility>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr Stream kPaths = stream_of("virtual_lights/bounce cache");

// Of a light's radius over the distance to surrounding surfaces (the harmonic mean): up to the first it is trusted,
// from the second on not at all.
constexpr float kTrusted = 0.5f, kNotTrusted = 1.0f;

// A white Lambert base under the coat of the light's surface, seen from above.
PathVertex white_base(const VirtualLight& light) {
    SurfacePoint point;
    point.position = light.position;
    point.geometric_normal = light.frame.normal;
    point.frame = light.frame;
    point.material = light.material;
    point.material.base_colour = Rgb(1.0f);
    point.material.metallic = 0.0f;
    point.clearance = light.clearance;
    return {point, Bsdf(point.material, point.frame, Lobes::Base), -light.frame.normal};
}

Rgb albedo_of(const VirtualLight& light) {
    SurfaceMaterial white = light.material;
    white.base_colour = Rgb(1.0f);
    white.metallic = 0.0f;
    return Bsdf(white, light.frame, Lobes::Base).base_albedo(light.frame.normal);
}

}  // namespace

BounceCache::BounceCache(const VirtualLights& lights, int paths, std::uint32_t seed, Gather gather)
    : lights_(lights), paths_(paths), seed_(seed), gather_(std::move(gather)), entries_(lights.lights().size()) {}

BounceCache::Entry BounceCache::gathered(std::uint32_t number) const {
    const VirtualLight& light = lights_.lights()[number];
    const PathVertex vertex = white_base(light);
    Rng rng(kPaths, light.number, seed_);
    Light sum;
    double closeness = 0.0;
    for (int i = 0; i < paths_; ++i) {
        const Sample found = gather_(vertex, light.number, i, rng);
        sum.surfaces += found.light.surfaces;
        sum.sky += found.light.sky;
        closeness += found.closeness;
    }
    Entry out;
    out.known = true;
    const Rgb albedo = albedo_of(light) * float(paths_);
    if (!(albedo.x > 0.0f))
        return out;
    out.light = {sum.surfaces / albedo, sum.sky / albedo};
    const auto wide = static_cast<float>(light.radius * closeness / paths_);
    out.trust = std::clamp((kNotTrusted - wide) / (kNotTrusted - kTrusted), 0.0f, 1.0f);
    return out;
}

void BounceCache::gather(std::span<const std::uint32_t> wanted) {
    std::vector<std::uint32_t> now;
    for (const std::uint32_t light : wanted)
        if (!std::exchange(entries_[light].known, true))
            now.push_back(light);
    parallel_for(now.size(), [&](std::size_t i) { entries_[now[i]] = gathered(now[i]); });
}

BounceCache::Found BounceCache::at(const LightShares& lights) const {
    Found out;
    for (int i = 0; i < lights.count; ++i) {
        const Entry& entry = entries_[lights.light[i]];
        const float trusted = lights.weight[i] * entry.trust;
        out.light.surfaces += trusted * entry.light.surfaces;
        out.light.sky += trusted * entry.light.sky;
        out.share += trusted;
    }
    return out;
}

}  // namespace brisance
