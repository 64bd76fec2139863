// A virtual ray light: a flight of a particle through the medium, or a piece of one, along which its light scatters.
#pragma once

#include "light_selection/medium_light_tree.h"
#include "tracking/segment.h"

namespace brisance {

struct RayLight {
    Segment segment;
    Rgb power{0.0f};          // that arrives at its start, over the number of particles [W]
    bool from_smoke = false;  // its flight starts at a collision
    bool dimmed = false;      // of a long flight: light at v is attenuated by the smoke from the start to v
    double extinction = 0.0;  // mean along it [1/m]
    double scattered = 0.0;   // approximate luminance [W] that scatters along it: optical depth times power
    double radius = 0.0;      // of a beam [m] (beam.h)
};

// Its box, for the tree.
MediumLightBounds bounds_of(const RayLight& light);

}  // namespace brisance
