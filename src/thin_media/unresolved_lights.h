// Where the lights of the hierarchy are too coarse for what a node sees.
//
// A light of spacing h is used at distances of about h. Its shadow map follows rays that converge, from as many voxels
// as light the region. If the region is opaque, hardly any of these rays leaves it, and a node that sees the region
// from outside gets too little light. In dense smoke this does not matter: what is opaque over h is not seen across h.
// For a node x this is measured as
//   D(x) = max over h of  h (S2^2 / S1)^(1/3)  exp(-sigma(x) h)
// with S1 and S2 the means of extinction and of its square around x, over a distance h. The middle factor is the
// extinction that light meets, S2 / S1, times the edge of a cube that holds all of it, (S1^2 / S2)^(1/3) h, over h. D
// is thus the optical depth of what x sees at the distance at which x sees it, and 1/e in homogeneous smoke, however
// dense. It depends on the extinction at points of space: on voxels only in how near h begins, not on a volume's
// bounds, and hardly on smoke that is too thin to be seen. The factor before exp counts up to 100.
//
// Where there is dense smoke nearby, lights of D up to 2.5 are right to some percent. Haze that lies apart has all of
// its light from afar: with the usual lights it lacks 5 % at D = 0.3, 24 % at 1.2 and 62 % at 5 (measured on bursts of
// three densities), about 1 - exp(-D / 5). There D counts five times. A node lies apart where the extinction that light
// meets within a quarter of the distance h is a twentieth or less of what it meets at h; nearer than 8 voxels nothing
// is told, so that h begins at 16, with a half of it. The constructions are this project's own.
#pragma once

#include <vector>

#include "medium/medium.h"

namespace brisance {

// D per node of the medium. Distances h are 8, 16, ... times the medium's spacing, up to the extent of the medium.
std::vector<float> depth_of_seen_lights(const Medium& medium);

// Per node, in [0, 1].
struct UnresolvedLights {
    std::vector<float> weight;  // how far the light that arrives comes from lights that are too coarse
    std::vector<float> lost;    // about the part of that light which they lose, times how far it comes from them
};
UnresolvedLights unresolved_lights(const Medium& medium);

}  // namespace brisance
