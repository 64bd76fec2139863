// Emitters one by one, for those who choose among them together with other lights: lamps, emissive triangles, suns, and
// the environment in parts.
#pragma once

#include <memory>
#include <vector>

#include "emitters/emitters.h"
#include "emitters/sky_parts.h"

namespace brisance {

class EmitterLights {
public:
    // Keeps a reference. `distance`: from which lights at infinity count as shining (LightBounds::distance) [m].
    EmitterLights(const Emitters& emitters, double distance);

    std::size_t size() const { return bounds_.size(); }
    const std::vector<LightBounds>& bounds() const { return bounds_; }
    // At which each light counts as being, however near it is: intensity over that is the most that it sends [m^2].
    // 0: a lamp of no extent.
    std::vector<double> least_squared_distances() const;

    // A point or a direction of that light; none if it contributes nothing. `weight` is not divided by the probability
    // of choosing it. `pdf` is that of Emitters::sample() for the same point or direction, against which rays by BSDF
    // are weighted: weights that sum to 1 keep the mean, however the light was chosen.
    std::optional<EmitterSample> sample(std::size_t light, const LitPoint& point, Rng& rng) const;

    std::uint64_t bytes() const;

private:
    // A sun, or a part of the environment.
    struct Far {
        std::size_t light;
        const SkyParts* sky = nullptr;  // null: the whole light
        std::size_t part = 0;
    };
    std::optional<EmitterSample> sample_far(const Far& far, PointNumbers on) const;

    const Emitters& emitters_;
    std::vector<std::unique_ptr<SkyParts>> skies_;
    std::vector<Far> far_;
    std::vector<LightBounds> bounds_;  // those at a finite distance first
};

}  // namespace brisance
