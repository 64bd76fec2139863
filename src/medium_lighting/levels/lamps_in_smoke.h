// Lamps without extent inside of smoke: their light changes within the voxel around them, however wide it is.
#pragma once

#include <vector>

#include "emitters/surroundings.h"
#include "medium/medium.h"

namespace brisance {

class LampsInSmoke {
public:
    LampsInSmoke() = default;
    // `fire_power`: what the medium emits, luminance [W].
    LampsInSmoke(const Surroundings& surroundings, const Medium& medium, double fire_power);

    // The part of all light that scatters within the voxels around them, on voxels 2^level as wide.
    float scattered_beside_them(int level) const;

private:
    struct Lamp {
        double depth;  // optical, of the radius of the ball that is as large as a voxel
        double share;  // of the power of all light
    };
    std::vector<Lamp> lamps_;
};

}  // namespace brisance
