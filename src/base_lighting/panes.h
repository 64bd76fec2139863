// Straight lines through panes: sheets of glass that do not bend light.
//
// A path finds fire behind a window only if the ray that it samples happens to meet both. A shadow ray toward the fire
// can pass through the pane instead, attenuated by the glass.
#pragma once

#include "emitters/surroundings.h"

namespace brisance {

class Panes {
public:
    explicit Panes(const Surroundings& surroundings);

    bool any() const { return any_; }

    struct Passage {
        Rgb weight{1.0f};  // transmittance of the panes
        int panes = 0;     // along the line
        bool blocked = false;
    };
    Passage along(Ray ray, double end) const;
    // The fraction of the light along `direction` that the surface transmits undeflected at the point.
    static Rgb straight_on(const SurfacePoint& point, const dvec3& direction);

private:
    const Surroundings& surroundings_;
    bool any_;
};

}  // namespace brisance
