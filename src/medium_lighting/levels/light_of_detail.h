// Light of detail that a lattice cannot represent, on the lattice twice as fine.
//
// Let L be light that has not scattered, as gathered on a lattice whose nodes interpolate extinction s and emission j,
// and ds, dj what the finer lattice knows beyond that. To first order the light of the finer medium differs by dL with
//   w . grad dL = -s dL + dj - ds L.
// So detail sends out light dj - ds L, positive or negative, and its sum over any voxel of the lattice is nearly 0: it
// is felt no farther than a voxel away. Dense smoke hides its surroundings, and lights itself where it burns. Without
// that, light does not know the smoke that it is multiplied with along camera rays. L is replaced by its mean over
// directions. Of the fire's light, all is scaled such that as much collides and escapes as is emitted: what collides in
// clumps that light themselves does not go on.
//
// Light of the smoke needs none: detail scatters about as much light in as it takes out, and of the built-in explosion
// refined 2 and 4 times MM errs as much with it.
#pragma once

#include <optional>
#include <vector>

#include "medium/medium.h"

namespace brisance {

struct LightBeforeDetail {
    const Medium& coarse;          // with contrast (coarse_lighting.h), on the lattice twice as coarse
    const std::vector<Rgb>& mean;  // of the radiance over directions, at the nodes of the finer lattice [W/(m^2 sr)]
    bool of_fire;                  // sent by the medium's emission
    std::optional<vec3> eye = {};  // local [m]: light that the phase function scatters toward it; none: the mean
};

// Adds the light of detail to `radiance`, the light at the nodes of `fine` [W/(m^2 sr)], and leaves a fifth of it at
// least. `needed`: per node; others may be left as they are. `before.mean` may be `radiance` itself: it is read first.
void add_light_of_detail(const Medium& fine, const LightBeforeDetail& before, const std::vector<std::uint8_t>& needed,
                         std::vector<Rgb>& radiance);

}  // namespace brisance
