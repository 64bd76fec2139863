// Light of emitters that a surface scatters toward the camera (SA): a point on one of the emitters, and a ray sampled
// from the BSDF, which meets emitters and background.
//
// What is even of the background (Emitters::even_share) casts no sharp shadows. It is told apart, since pixels may
// share it.
#pragma once

#include <limits>

#include "camera_rays/picture.h"
#include "transport/direct_light.h"

namespace brisance {

class LightOfEmitters {
public:
    // Keeps a reference. `samples`: of a pixel. Other seeds draw other numbers.
    LightOfEmitters(const DirectLight& direct, int samples, std::uint32_t seed = 0)
        : direct_(direct), samples_(samples), seed_(seed) {}

    // Radiance [W/(m^2 sr)].
    struct Seen {
        Rgb other{0.0f}, even{0.0f};                                // from infinity, evenly
        double distance = std::numeric_limits<double>::infinity();  // of the surface that the ray met [m]

        Rgb all() const { return other + even; }
        void add(const Rgb& light, float even_share) {
            even += even_share * light;
            other += (1.0f - even_share) * light;
        }
    };
    Seen at(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng) const;
    // What a ray by BSDF alone brings of that, weighted against the other.
    Seen by_ray(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng) const {
        Seen seen;
        follow_ray(sample, vertex, rng, seen);
        return seen;
    }

private:
    void follow_ray(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng, Seen& seen) const;
    void choose(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng, Seen& seen) const;
    float even_share(const dvec3& direction) const { return direct_.surroundings()->emitters().even_share(direction); }

    const DirectLight& direct_;
    int samples_;
    std::uint32_t seed_;
};

}  // namespace brisance
