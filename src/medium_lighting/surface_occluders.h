// A scene's surfaces as occluders of light inside of the medium.
#pragma once

#include "emitters/surroundings.h"
#include "geometry/intersector.h"
#include "medium/lattice/occluders.h"
#include "medium/medium.h"

namespace brisance {

// What lies on a surface has to be so far above it [m] to be on the right side of it all the same: a light in a ceiling
// would be moved through it.
inline float clear_of_surfaces(float spacing) {
    return 2.0f * glm::length(kBesidePlanes) * spacing;
}

class SurfaceOccluders : public Occluders {
public:
    // `spacing`: of the volume's voxels [m].
    SurfaceOccluders(const Intersector& intersector, float spacing);
    float first_hit(const vec3& from, const vec3& direction, float far) const override;
    bool any_within(const vec3& centre, float radius) const override;

private:
    const Intersector& intersector_;
    vec3 moved_;
};

// Whether some triangle comes between nodes of the medium that absorb, scatter or glow: whether it may touch the box
// around them. Where none does, light that goes from smoke to smoke meets no surface. Null: there are none.
bool surfaces_reach_into(const Surroundings* surroundings, const Medium& medium);

}  // namespace brisance
