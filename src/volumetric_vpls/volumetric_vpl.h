// A volumetric virtual point light: the position of a particle collision, from which its light scatters.
#pragma once

#include "light_selection/medium_light_tree.h"

namespace brisance {

struct VolumetricVpl {
    dvec3 position{0.0};             // local [m]
    dvec3 direction{0.0, 0.0, 1.0};  // unit, of the particle that arrived
    Rgb power{0.0f};                 // that scatters here, over the number of particles [W]
    int scatterings = 1;             // of its light, this one included
    double extinction = 0.0;         // here [1/m]
    double scattered = 0.0;          // luminance of `power` [W]
};

// Its bounds for the tree of ray lights: a box of no extent.
inline MediumLightBounds bounds_of(const VolumetricVpl& light) {
    return {light.position, light.position, light.scattered, light.extinction, light.direction};
}

}  // namespace brisance
