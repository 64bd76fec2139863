// A point to shade: what is known of it, the state of its random numbers, and what is left to others.
#pragma once

#include <optional>
#include <vector>

#include "pixel_sharing/shared_bounce.h"
#include "surface_lighting/bound_account.h"
#include "surface_lighting/light_reuse.h"
#include "surface_lighting/mirrors.h"
#include "surface_lighting/surface_shader.h"

namespace brisance {

struct SurfaceShader::ShadedPoint {
    BehindMirrors seen;
    Rng ray_rng;  // for rays through the medium
    int vertices;
    float stands_for = 1.0f;                                                        // that of SurfaceRounds
    std::optional<SharedBounce::Sample> base = std::nullopt, gloss = std::nullopt,  // left to all pixels
        sky = std::nullopt;
    SharedBounce::Aparts of_gloss = {};              // left to them with the gloss, ...
    std::optional<double> closeness = std::nullopt;  // ... by what its ray met [1/m]
    std::vector<LightReuse::Sample> chosen = {};     // left to samples around
    BoundTally bound = {};                           // of what is not left to all pixels
};

inline bool has_base(const SurfaceMaterial& m) {
    return m.metallic < 1.0f && m.transmission < 1.0f && m.base_colour != Rgb(0.0f);
}

inline bool has_specular(const SurfaceMaterial& m) {
    return needs_energy_tables(m);
}

inline Rng rng_of(Stream stream, const SurfaceSample& sample, std::uint32_t seed) {
    return Rng(stream, sample.pixel | std::uint64_t(seed) << 32, sample.number);
}

}  // namespace brisance
