// Shares the light of a glossy surface between points on ray lights and rays sampled from the lobe.
//
// Light that scatters at v in the smoke, travels to u, scatters there and reaches the surface is found by two
// techniques: a point u on the ray light that starts at v, and a ray sampled from the lobe that reaches u and samples
// the ray lights through v. A point on a light rarely lies in a sharp lobe. A ray of a wide lobe rarely passes near the
// light, and has to find two points at once. The balance heuristic shares every direction between them (Veach and
// Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, SIGGRAPH 1995). The density of points on
// lights over directions is unknown, as a tree and a roulette chose the lights; it is taken to be uniform over the
// hemisphere. As the two shares of a direction always add up to 1, this approximation costs variance and adds no bias.
// Light that reaches u directly from fire, emitters or surfaces is left to rays alone, which find it without noise.
#pragma once

#include "core/vec.h"
#include "geometry/surface_point.h"
#include "surfaces/bsdf.h"

namespace brisance {

class GlossSplit {
public:
    // Keeps references. `gloss`: the shared lobes; `light_samples`: samples of lights for each ray that is sampled.
    GlossSplit(const SurfacePoint& point, const Bsdf& gloss, const dvec3& toward_viewer, double light_samples);

    // Share [1] of rays in the light from that direction (unit); 1 where the surface transmits the light.
    double of_rays(const dvec3& to_light) const;
    // BSDF times cosine [1/sr] times the share of the lights.
    Rgb of_lights(const dvec3& to_light) const;

private:
    const SurfacePoint& point_;
    const Bsdf& gloss_;
    dvec3 toward_viewer_;
    double density_;  // of points on lights, over directions [1/sr]
};

// The lobes of a surface that lights are evaluated with: all lights use `whole`; lights that start in smoke add, if
// `shared` is given, their share of its lobes.
struct ReceiverLobes {
    // NOLINTNEXTLINE(google-explicit-constructor): lobes that are not shared need no wrapping
    ReceiverLobes(const Bsdf& all_lobes, const GlossSplit* split = nullptr) : whole(all_lobes), shared(split) {}
    const Bsdf& whole;
    const GlossSplit* shared;
};

}  // namespace brisance
