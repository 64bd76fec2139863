// Surfaces that a lamp of no extent lies in: lamps are hung exactly on ceilings and walls.
#pragma once

#include <array>

#include "geometry/intersector.h"

namespace brisance {

// Light that starts at such a lamp, or ends there, must not meet these surfaces, on whichever side it goes: it starts
// just beside them (SurfacePoint::clearance).
class OwnSurfaces {
public:
    OwnSurfaces() = default;
    // `position`: of the lamp, local [m]. `extent`: Scene::largest_coordinate().
    OwnSurfaces(const Intersector& surfaces, const dvec3& position, double extent);

    // The same position just beside the surfaces, on the side that `direction` goes to.
    dvec3 start(const dvec3& position, const dvec3& direction) const;

private:
    // Surfaces' normals, as long as what clears them; unused ones are zero. More than three planes share no point but
    // by chance.
    std::array<dvec3, 3> clear_{dvec3(0.0), dvec3(0.0), dvec3(0.0)};
};

}  // namespace brisance
