// A substitute medium for scattered light, where the medium itself is too stiff for lights on a lattice.
//
// A lattice does not resolve where in a voxel light comes from. That matters in three cases, and in each a milder
// medium emits nearly the same light:
//  - Many mean free paths to a voxel. What is seen of such smoke comes from a skin far thinner than a voxel. Layers of
//    constant albedo look the same however optical depth is laid out in them, so extinction is held down until a voxel
//    is about as thick as the skin. Smoke that scatters nearly all light is no skin: light diffuses through many
//    voxels, and what comes out must not change. With extinction sigma = x sigma' and 1 - albedo = e, albedo and
//    emission j are changed so that the flux out of a half-space stays the same,
//      j' / (sigma' e') E(e') = j / (sigma e) E(e),     e <= e' <= x^2 e,
//    with its emissivity E(e), nearly the square root of e: e' = x^2 e keeps power and diffusion, e' = e keeps the
//    source function. The first is taken as far as e' = 0.05, beyond which light dies within a voxel or two anyway.
//  - A phase function with a forward peak narrower than the angles between a lattice's lights. Light that scatters into
//    the peak has hardly scattered: a share f of all scattering counts as none (delta scaling: Joseph, Wiscombe,
//    Weinman, The delta-Eddington approximation for radiative flux transfer, J. Atmos. Sci. 33, 1976; Wiscombe, The
//    delta-M method, 34, 1977), with f = g^3, so that moments 0 to 2 are kept by the rest. Where light is followed for
//    one scattering alone that would be no scattering at all: the peak's share is then left out, and the camera adds
//    it along its own rays, where it has come straight on (SourceField).
//  - A backward peak as narrow. It cannot count as no scattering, and is widened.
// The camera still sees emission through the medium itself.
#pragma once

#include <optional>

#include "medium/medium.h"

namespace brisance {

// The share of scattering in Henyey-Greenstein's forward peak that counts as none: 0 up to g = 0.5, g^3 from 0.85.
float forward_share(float mean_cosine);

// The part of forward_share() that `bounces` scatterings leave to the camera's rays: all of it with one, else nothing.
float forward_left_out(float mean_cosine, int bounces);

// Returns nothing where the medium itself suffices. `bounces` is the number of scatterings to follow, -1: all orders.
// With 1 the forward share of single scattering is missing; with a number above, peaks stay as they are, since every
// order is computed by itself.
std::optional<Medium> similar_medium(const Medium& medium, int bounces);

}  // namespace brisance
