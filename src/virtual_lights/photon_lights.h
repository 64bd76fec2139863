// Lights of flux of their own: one wherever a particle meets a surface, with what that carries there and no more.
//
// A. Keller, Instant Radiosity, SIGGRAPH 1997; of a ball's radius: M. Hasan, J. Krivanek, B. Walter, K. Bala, Virtual
// Spherical Lights for Many-Light Rendering of Glossy Scenes, ACM Transactions on Graphics 28(5), 2009.
#pragma once

#include "virtual_lights/photon_splitting.h"

namespace brisance {

struct PhotonLights {
    std::vector<VirtualLight> lights;  // complete, but for a radius and an area of 1 m^2
    PhotonReport report;
};

// As many light paths as will make about `count` lights, which a pilot tells: all places of all of them, so that the
// mean is right whatever the number.
PhotonLights lights_at_photons(const DirectLight& scene, int count, std::uint32_t seed);

// What a light of its own flux sends along unit `toward`: radiance times the cosine to its normal [W/(m^2 sr)].
Rgb reflected_flux(const VirtualLight& light, const dvec3& toward);

// Of kind sphere: the radius [m] of each light is the distance to its k-th nearest. `otherwise`: of a single one.
void widen_to_neighbours(std::span<VirtualLight> lights, int k, double otherwise);

}  // namespace brisance
