// Straight lines through panes: sheets of glass, which do not bend light.
//
// A path finds fire behind a window only where the ray that it draws happens to meet both. A line toward the fire need
// not end at the pane: it goes on, dimmed, as through a window it does.
#pragma once

#include "emitters/surroundings.h"

namespace brisance {

class Panes {
public:
    explicit Panes(const Surroundings& surroundings);

    bool any() const { return any_; }

    struct Passage {
        Rgb weight{1.0f};  // that panes let through
        int panes = 0;     // on the way
        bool blocked = false;
    };
    Passage along(Ray ray, double end) const;
    // What of the light along `direction` goes straight on at that place.
    static Rgb straight_on(const SurfacePoint& point, const dvec3& direction);

private:
    const Surroundings& surroundings_;
    bool any_;
};

}  // namespace brisance
