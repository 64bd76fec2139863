// A point to shade: what is known of it, the state of its random numbers, and what is left to others.
#pragma once

#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "pixel_sharing/shared_bounce.h"
#include "surface_lighting/bound_account.h"
#include "surface_lighting/light_reuse.h"
#include "surface_lighting/mirrors.h"
#include "surface_lighting/surface_shader.h"

namespace brisance {

struct SurfaceShader::ShadedPoint {
    BehindMirrors seen;
    Rng ray_rng{Stream::RayLightSurface, 0};  // for rays through the medium
    int vertices = 0;
    float stands_for = 0.0f;                                                        // that of SurfaceRounds
    std::optional<SharedBounce::Sample> base = std::nullopt, gloss = std::nullopt,  // left to all pixels
        sky = std::nullopt;
    SharedBounce::Aparts of_gloss = {};              // left to them with the gloss, ...
    std::optional<double> closeness = std::nullopt;  // ... by what its ray met [1/m]
    std::vector<LightReuse::Sample> chosen = {};     // left to samples around
    BoundTally bound = {};                           // of what is not left to all pixels

    // What the pixel shows of that, had all pixels nothing to add [W/(m^2 sr)].
    Rgb left_to_all() const {
        Rgb sum(0.0f);
        for (const auto* s : {&base, &gloss, &sky})
            if (*s)
                sum += (*s)->shown();
        return sum;
    }
};

// The points of those samples of a call that are shaded. They are large, so that other samples have none.
class SurfaceShader::Points {
public:
    explicit Points(std::size_t samples) : place_(samples, kNone) {}
    // Of all samples.
    explicit Points(std::vector<ShadedPoint> made) : place_(made.size()), made_(std::move(made)) {
        std::iota(place_.begin(), place_.end(), 0u);
    }

    bool has(std::size_t sample) const { return place_[sample] != kNone; }
    ShadedPoint& operator[](std::size_t sample) { return made_[place_[sample]]; }
    const ShadedPoint& operator[](std::size_t sample) const { return made_[place_[sample]]; }

    // Appends points for those of `some` that have none, and returns these.
    std::vector<std::size_t> add(const std::vector<std::size_t>& some) {
        std::vector<std::size_t> added;
        for (const std::size_t i : some)
            if (!has(i)) {
                place_[i] = static_cast<std::uint32_t>(made_.size() + added.size());
                added.push_back(i);
            }
        made_.resize(made_.size() + added.size());
        return added;
    }

private:
    static constexpr std::uint32_t kNone = ~0u;
    std::vector<std::uint32_t> place_;  // in made_, of each sample; kNone
    std::vector<ShadedPoint> made_;
};

inline bool has_specular(const SurfaceMaterial& m) {
    return needs_energy_tables(m);
}

inline Rng rng_of(Stream stream, const SurfaceSample& sample, std::uint32_t seed) {
    return Rng(stream, sample.pixel | std::uint64_t(seed) << 32, sample.number);
}

}  // namespace brisance
