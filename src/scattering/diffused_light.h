// Orders of scattering above the first as one solution of the diffusion equation (diffusion.h).
#pragma once

#include "diffusion/diffusion.h"
#include "scattering/coarse_operator.h"

namespace brisance {

struct DiffusedLight {
    ScatteredLight light;  // on the fine lattice: scattered twice or more often
    DiffusionCounts counts;
    std::size_t nodes = 0;  // with extinction, of the coarse lattice
    std::uint64_t bytes = 0;
};

// `once`: light scattered once, on the fine lattice. It is the equation's source, so that the fluence found is that of
// light scattered once or more often; scattered once more, it leaves as what is returned. `level` of the pyramid: where
// the equation is solved.
DiffusedLight diffused_light(const ExtinctionPyramid& fine, int level, const ScatteredLight& once,
                             const DiffusionSettings& settings);

}  // namespace brisance
