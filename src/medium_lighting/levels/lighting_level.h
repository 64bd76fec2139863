// The lattices on which the light of a medium lives: coarser than the medium's own where the error is allowed.
//
// A picture errs with the square of the optical depth of the voxels on which light is gathered, and by the emission
// that a coarser lattice cannot represent.
//
// - Of light that has not scattered yet the first constant is that of the believed errors
//   (forecast/expected_errors.cpp), the second was chosen by pictures of one volume. What is allowed is what
//   interpolation may add (gathering/settings.h): nothing where lighting every node takes no more than a minute.
// - Light of the smoke is smooth where smoke is thin, whatever the fire does. Its voxels are the widest whose whole
//   error lighting.error allows: they depend on the smoke in the world, not on the voxels that it is stored in.
#pragma once

#include "medium_lighting/input.h"

namespace brisance {

struct LightingLevel {
    int level = 0;                  // voxels 2^level wide
    float share_of_coarser = 0.0f;  // of the light of level + 1, in [0, 1)
    float error = 0.0f;             // relative, of the picture, that light on `level` is expected to add
    float error_of_coarser = 0.0f;  // that light on level + 1 would add; 0 where it was not asked for
};

struct LightingLevels {
    LightingLevel first;  // of light that has not scattered yet
    LightingLevel smoke;  // of light that has; never finer
};

// As LightingSettings say, or by the errors; where an error of interpolation is stated, the medium's own lattice.
// Beside surfaces that reach into the medium light stays on the medium's own lattice: it would be interpolated through
// walls.
LightingLevels lighting_levels(const MediumLightingInput& input);
// The same without surfaces.
LightingLevels lighting_levels(const Medium& medium, const LightingSettings& settings);

// Relative error of light gathered on voxels of this optical depth, as a collision meets it.
float error_of_voxels(float depth);

}  // namespace brisance
