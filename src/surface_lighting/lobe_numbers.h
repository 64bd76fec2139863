// Of which numbers a sample's direction is made. Those of a pixel divide the directions of their lobes among
// themselves.
#pragma once

#include <cmath>

#include "camera_rays/picture.h"
#include "core/multi_jitter.h"

namespace brisance {

// For Bsdf::sample. `samples`: rays of a pixel. `rng`: of this sample.
inline dvec3 lobe_numbers(Stream stream, const SurfaceSample& sample, int samples, std::uint32_t seed, Rng& rng) {
    const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(double(samples))));
    const MultiJitter among(side, Rng(stream, sample.pixel | std::uint64_t(seed) << 32, sample.number >> 32));
    const dvec3 spread = among.at(static_cast<std::uint32_t>(sample.number), rng);
    return {spread.z, spread.x, spread.y};
}

}  // namespace brisance
