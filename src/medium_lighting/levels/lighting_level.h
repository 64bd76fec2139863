// The lattices on which the light of a medium lives: coarser than the medium's own where the error is allowed.
//
// A picture errs with the square of the optical depth of the voxels on which light is gathered, and by the emission
// that a coarser lattice cannot represent.
//
// - Light that has not scattered yet is given the light of its voxels' detail (light_of_detail.h), which leaves a part
//   of that error. Of this light the first constant is that of the believed errors
//   (forecast/expected_errors.cpp), the second was chosen by pictures of one volume. A third part is what light does
//   around a small fire. Half of lighting.error is allowed. Its voxels are no wider than the errors of the smoke's
//   light allow, which could not be finer.
// - Whether nodes may be interpolated at all follows from the same error, of the next coarser lattice: from it hidden
//   smoke is lit. How many are is decided node by node, by what the picture shows (adaptive_gather.h).
// - Light of the smoke is smooth where smoke is thin, whatever the fire does. Its voxels are the widest whose whole
//   error lighting.error allows: they depend on the smoke in the world, not on the voxels that it is stored in.
// - Lamps without extent inside of smoke need the finest voxels around them (lamps_in_smoke.h).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "medium_lighting/input.h"

namespace brisance {

// lighting.lattice_error over lighting.error, by default.
constexpr float kShareOfLattice = 0.5f;

struct LightingLevel {
    int level = 0;                  // voxels 2^level wide
    float share_of_coarser = 0.0f;  // of the light of level + 1, in [0, 1)
    float error = 0.0f;             // relative, of the picture, that light on `level` is expected to add
    float error_of_coarser = 0.0f;  // that light on level + 1 would add; 0 where it was not asked for
};

struct LightingLevels {
    LightingLevel first;         // of light that has not scattered yet
    LightingLevel smoke;         // of light that has; never finer
    float interpolation = 0.0f;  // that is tolerated on the lattice of `first`
};

// As LightingSettings say, or by the errors; where an error of interpolation is stated, the medium's own lattice.
// Beside surfaces that reach into the medium light is interpolated between what is seen (corners_seen.h). What wider
// voxels would send out on the other side of surfaces counts as an error.
// `surroundings`: null: there are no surfaces.
LightingLevels lighting_levels(const Medium& medium, const LightingSettings& settings,
                               const Surroundings* surroundings = nullptr);
inline LightingLevels lighting_levels(const MediumLightingInput& input) {
    return lighting_levels(input.medium, input.lighting, input.surroundings);
}
// For each of several settings. What they need of the medium is looked for once.
std::vector<LightingLevels> levels_for_each(const Medium& medium, std::span<const LightingSettings> settings,
                                            const Surroundings* surroundings);
// Where the settings state both lattices: these, and none of their errors.
std::optional<LightingLevels> stated_levels(const LightingSettings& settings);

// The error that interpolation between nodes of a medium may add to the picture: as stated, or a quarter of
// lighting.error where light on the lattice twice as coarse errs by no more than lighting.error, falling to 0 where it
// errs by 1.5 times that. It depends on the smoke, the fire and the width of voxels, on no count of them. Where this
// lattice has a share of the light only, that of the lattice twice as coarse adds as much less to the picture.
struct ToleratedInterpolation {
    float most = 0.0f;
    float of_coarser = 0.0f;  // error of the lattice twice as coarse over lighting.error; 0: interpolation is stated

    // `share`: of the picture's light, in (0, 1].
    float of(float share) const;
};

ToleratedInterpolation tolerated_interpolation(const Medium& medium, const LightingSettings& settings);

}  // namespace brisance
