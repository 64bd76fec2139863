// Light of the fire, gathered from its single lights: MV along a ray of the camera, and SV at a point of a surface.
//
// The points on a ray are stratified ends of free flights (transport/gather_points.h). A point of a surface is asked by
// itself: it is the one gather point of its camera ray. Both are unbiased where the gatherer is; the number of points
// trades noise for time.
#pragma once

#include <memory>

#include "fire_lights/fire_lights.h"
#include "fire_lights/samplings.h"

namespace brisance {

class SampledFire {
public:
    // Keeps a reference to the scene.
    SampledFire(const DirectLight& scene, const FireLightSampling& sampling, const FireLightSettings& settings);
    SampledFire(const SampledFire&) = delete;
    SampledFire& operator=(const SampledFire&) = delete;

    // For a ray of a pixel of the camera. Pictures of different seeds share no random numbers.
    Rng rng(std::uint32_t pixel, std::uint64_t number) const;
    // `seen`: the medium on `ray` [W/(m^2 sr)].
    Rgb along(const RayMedium& seen, const Ray& ray, Rng& rng) const;

    // For the surface that such a ray meets.
    Rng surface_rng(std::uint32_t pixel, std::uint64_t number) const;
    // What a vertex on a surface scatters by its lobes, which may not all be deltas. Surfaces and smoke between it and
    // the fire hide light; panes do, too [W/(m^2 sr)].
    Rgb on_surface(const PathVertex& vertex, Rng& rng) const;

    std::size_t lights() const { return lights_.size(); }
    std::uint64_t bytes() const { return lights_.bytes() + gatherer_->bytes(); }

private:
    const DirectLight& scene_;
    FireLights lights_;
    std::unique_ptr<FireGatherer> gatherer_;
    int points_;
    std::uint32_t seed_;
};

}  // namespace brisance
