// Light that changes slowly over surfaces, at the virtual lights: for surfaces that mirrors and narrow lobes show. An
// irradiance cache (G. Ward, F. Rubinstein, R. Clear, A Ray Tracing Solution for Diffuse Interreflection, SIGGRAPH
// 1988).
//
// Pixels share what arrives at the surfaces that they see. What a window shows of a facade lies elsewhere for each of
// them, and a path of its own at each of its points has much noise. The virtual lights lie where it is needed: where
// paths of the camera meet surfaces a second time. So each of these lights gathers once, by many paths, the same as
// would each of the points, and points take the mean of the lights that cover them, by the partition of unity. That is
// light between surfaces (SS), and of emitters what is even (Emitters::even_share). Light that fire, smoke and lamps
// send there straight is not part of it, and keeps its edges.
//
// Such light changes over a part of the distance to surrounding surfaces. Where lights are wider than that, as in
// corners, they are trusted less, and the rest is left to the point's own paths.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "virtual_lights/virtual_lights.h"

namespace brisance {

class BounceCache {
public:
    // Radiance that a Lambert base reflects, over its albedo toward the viewer [W/(m^2 sr)].
    struct Light {
        Rgb surfaces{0.0f}, sky{0.0f};
    };
    // One path at a white base: what it reflects, and the inverse distance of the surface that it met first [1/m].
    struct Sample {
        Light light;
        double closeness = 0.0;
    };
    using Gather = std::function<Sample(const PathVertex& base, std::uint64_t light, int path, Rng& rng)>;

    // Keeps a reference. `paths`: at each light, numbered from 0. `gather` is called from any thread.
    BounceCache(const VirtualLights& lights, int paths, std::uint32_t seed, Gather gather);

    // Gathers at the lights among `wanted` that have not been asked for before.
    void gather(std::span<const std::uint32_t> wanted);

    struct Found {
        Light light;         // of the share
        float share = 0.0f;  // of all that the base reflects of such light: the rest is to be gathered at the point
    };
    // Where all lights have been gathered.
    Found at(const LightShares& lights) const;

    int paths() const { return paths_; }

private:
    struct Entry {
        Light light;
        float trust = 0.0f;
        bool known = false;
    };
    Entry gathered(std::uint32_t light) const;

    const VirtualLights& lights_;
    int paths_;
    std::uint32_t seed_;
    Gather gather_;
    std::vector<Entry> entries_;
};

}  // namespace brisance
