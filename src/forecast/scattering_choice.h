// Which solutions of a medium's scattered light a picture is made of.
//
// Light that scatters more than once (MM, SM), and light of lamps that scatters once (MA), have two solutions. The
// lighting grid has no noise and resolves fine, dense smoke, but its lights know directions to spherical harmonics of
// degree 2 only: forward peaks count as no scattering (medium/similar_medium.h), so that its MA and MM are right
// together and not one by one. Volumetric photons, with MA along the camera's rays, use the phase function itself and
// see lamps inside haze, but blur over voxels and have noise, which grows with the optical depth. So they are for haze
// that scatters sharply. Both limits are soft, and whole pictures are mixed:
//   thin(E) sharp(g)   by volumetric photons, MA along rays,
//   the rest           by the lighting grid, with the share thin(E) of its MA along rays, since beams of lamps may be
//                      narrower than voxels, and the rest at the nodes.
// E is the mean escape probability (mean_escape.h), g the mean cosine. Nothing depends on whether a file or a box holds
// the smoke.
#pragma once

#include <optional>
#include <string>

#include "medium/medium.h"
#include "shot/shot.h"
#include "statistics/statistics.h"

namespace brisance {

// 0 for smoke from which little light escapes, 1 for haze.
float thinness(double escape);
// 0 for phase functions that spherical harmonics of degree 2 hold well, 1 for sharp peaks.
float sharpness(float mean_cosine);

struct ScatteringChoice {
    std::string method;             // besides the lighting grid, or the grid itself
    float share = 0.0f;             // of the picture whose MM and SM the method computes; the grid's: 0
    float emitters_by_rays = 0.0f;  // share of MA along rays in the grid's picture
    std::string reason;             // half a sentence
    StageCost cost;                 // with E and the weights; no name: they were not needed
};

// `twice`: light that scatters more than once is needed; `lamps`: MA is. The path tracer has no choice.
ScatteringChoice choose_scattering(const Shot& shot, const Medium& medium, bool twice, bool lamps);

// Whether a medium's mean escape probability may matter to the shot, and the shot does not state it.
bool leaves_escape_open(const Shot& shot);

}  // namespace brisance
