// The ledger's cell MV along a ray of the camera, gathered from the fire's single lights.
//
// The points on the ray are stratified ends of free flights. With opacity O of the ray and n points of albedo a, every
// one counts by O a / n. Unbiased where the gatherer is; the number of points trades noise for time.
#pragma once

#include <memory>

#include "fire_lights/fire_lights.h"
#include "fire_lights/gather_points.h"
#include "fire_lights/samplings.h"
#include "tracking/ray_medium.h"

namespace brisance {

class FireOnRays {
public:
    // Keeps a reference to the scene.
    FireOnRays(const DirectLight& scene, const FireLightSampling& sampling, const FireLightSettings& settings);
    FireOnRays(const FireOnRays&) = delete;
    FireOnRays& operator=(const FireOnRays&) = delete;

    // For a ray of a pixel of the camera. Pictures of different seeds share no random numbers.
    Rng rng(std::uint32_t pixel, std::uint64_t number) const;
    // `seen`: the medium on `ray` [W/(m^2 sr)].
    Rgb along(const RayMedium& seen, const Ray& ray, Rng& rng) const;

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
