// A scene's surfaces as occluders of light inside of the medium.
#pragma once

#include "emitters/surroundings.h"
#include "geometry/intersector.h"
#include "medium/lattice/occluders.h"
#include "medium/medium.h"

namespace brisance {

class SurfaceOccluders : public Occluders {
public:
    explicit SurfaceOccluders(const Intersector& intersector) : intersector_(intersector) {}
    float first_hit(const vec3& from, const vec3& direction, float far) const override;
    bool any_within(const vec3& centre, float radius) const override;

private:
    const Intersector& intersector_;
};

// Whether some triangle comes between nodes of the medium that absorb, scatter or glow: whether it may touch the box
// around them. Where none does, light that goes from smoke to smoke meets no surface. Null: there are none.
bool surfaces_reach_into(const Surroundings* surroundings, const Medium& medium);

}  // namespace brisance
