// How a path vertex gathers the light of many virtual lights. Type erasure happens here, once per vertex: what is
// called for every light is a template over its kind.
#pragma once

#include "virtual_lights/bounded_light.h"
#include "virtual_lights/gatherers/light_reservoir.h"
#include "virtual_lights/light_set.h"
#include "virtual_lights/placement/placement.h"

namespace brisance {

class Gatherer {
public:
    virtual ~Gatherer() = default;

    // Whether lights themselves are sampled; if not, from_lights() is black.
    virtual bool samples_lights() const { return true; }
    // One sample of what the vertex scatters of the light of all lights, as far as it is not found by rays, and what
    // their bound takes away.
    virtual BoundedLight from_lights(const PathVertex& vertex, Rng& rng) const = 0;
    // The radiance that a ray finds at its end, weighted against sampling the lights. `pdf`: of the ray, which the
    // vertex sampled [1/sr].
    virtual Rgb from_ray(const PathVertex&, const CoveredHit&, double /*pdf*/) const { return Rgb(0.0f); }
    // Null: the gatherer does not resample.
    virtual const ReservoirLights* reservoirs() const { return nullptr; }
    virtual std::uint64_t bytes() const { return 0; }
};

}  // namespace brisance
