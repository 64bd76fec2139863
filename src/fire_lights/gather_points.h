// Points at which the light of the fire is gathered, on a camera ray through smoke or on the surface that it meets, and
// how it is chosen.
#pragma once

#include <cstdint>
#include <span>

#include "transport/path_vertex.h"

namespace brisance {

struct GatherPoint {
    PathVertex vertex;
    Rgb weight;         // of what it scatters, by its phase function or BSDF alone, in the light of the ray
    double extinction;  // there [1/m]
};

class FireGatherer {
public:
    virtual ~FireGatherer() = default;
    // The light of the fire at all points of a ray, which come in their order along it, or at a single point of a
    // surface [W/(m^2 sr)].
    virtual Rgb at(std::span<const GatherPoint> points, Rng& rng) const = 0;
    virtual std::uint64_t bytes() const = 0;
};

}  // namespace brisance
