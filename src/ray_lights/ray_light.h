// A virtual ray light: a flight of a particle through the medium, or a piece of one, whose light scatters all along it.
#pragma once

#include "light_selection/medium_light_tree.h"
#include "tracking/segment.h"

namespace brisance {

struct RayLight {
    Segment segment;
    Rgb power{0.0f};          // that arrives at its start, over the number of particles [W]
    bool from_smoke = false;  // its particle set out where it had collided
    bool dimmed = false;      // of a long flight: what arrives at v passed the smoke from the start to there
    double extinction = 0.0;  // mean along it [1/m]
    double scattered = 0.0;   // luminance [W] that scatters along it, about: the optical depth times its power
    double radius = 0.0;      // of a beam [m] (beam.h)
};

// Its box, for the tree.
MediumLightBounds bounds_of(const RayLight& light);

}  // namespace brisance
