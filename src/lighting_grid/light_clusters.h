// Few lamps in the place of a fire: k-means over the light of its voxels.
//
// This is the baseline "few hand-placed lights" that the lighting grid hierarchy is compared with [1]
// (lighting_grid.h), with a rule instead of an artist's hand. The lamps minimise
//   sum_j Y_j |x_j - c(j)|^2,   Y_j the luminance of voxel j's intensity, c(j) the nearest lamp,
// by k-means++ (D. Arthur and S. Vassilvitskii, k-means++: The Advantages of Careful Seeding, SODA 2007) from a fixed
// seed and iterations of Lloyd (Least Squares Quantization in PCM, 1982). A lamp lies at the centroid of its voxels and
// has the sum of their intensities, so that power and first moment are those of the fire. To its surroundings it is a
// uniform ball with the second moment of its voxels, so that smoke within the cluster is not lit by a singular point:
//   a^2 = 5/3 s^2 + b^2,   s^2 = sum Y |x - c|^2 / sum Y,   b the radius of a ball of a voxel's volume.
// Its smoke counts as homogeneous, of the mean extinction sigma at its voxels by Y. Of the light that starts evenly in
// such a ball the part
//   P = 3 / (8 t^3) (2 t^2 - 1 + (1 + 2 t) exp(-2 t)),   t = sigma a,
// leaves it (K. M. Case, F. de Hoffmann, G. Placzek, Introduction to the Theory of Neutron Diffusion, 1953). Shadows
// therefore begin at its surface with transmittance P. Within it the mean of 1 / r^2 times
//   4 (1 - P) / (3 t)
// makes as much light collide as does not leave: no light is lost, however dense the smoke is.
// A voxel that changes its lamp from one frame to the next moves both: lamps flicker where hierarchies do not.
#pragma once

#include <vector>

#include "lighting_grid/lighting_grid.h"

namespace brisance {

// At most `count` lamps for the lights in `intensity` (per node of the medium's lattice [W/sr]); fewer where fewer
// voxels shine. They are a level of their own, with radii. The same on any number of threads.
GridLevel cluster_lights(const Medium& medium, const std::vector<Rgb>& intensity, int count);

}  // namespace brisance
