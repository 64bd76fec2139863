// Who lights a glossy surface: places on ray lights, or rays drawn from the lobe.
//
// Light that scatters at v in the smoke, goes on to u, scatters there and comes to the surface is found in two ways: by
// a place u on the ray light that set out at v, and by a ray drawn from the lobe that comes to u and asks the ray
// lights through v. A place is hardly ever where a sharp lobe looks; a ray of a wide lobe rarely comes by where the
// light is, and has to find two places at once. Every direction is shared between them by the balance heuristic (Veach
// and Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, SIGGRAPH 1995). Of places the density
// over directions is not known, as a tree and a roulette chose their lights; it is taken to be even over the
// hemisphere. As the two parts of a direction add up to 1 whatever they are, this guess costs variance, never bias.
// Light that comes to u straight from fire, emitters or surfaces is for rays alone: there it is known without noise.
#pragma once

#include "core/vec.h"
#include "geometry/surface_point.h"
#include "surfaces/bsdf.h"

namespace brisance {

class GlossSplit {
public:
    // Keeps references. `gloss`: the lobes that are shared; `places`: as many as are asked for each ray that is drawn.
    GlossSplit(const SurfacePoint& point, const Bsdf& gloss, const dvec3& toward_viewer, double places);

    // The part of light from there (unit) that is left to rays [1]: all of it where the surface lets light through.
    double of_rays(const dvec3& to_light) const;
    // BSDF times cosine [1/sr] for the rest.
    Rgb of_places(const dvec3& to_light) const;

private:
    const SurfacePoint& point_;
    const Bsdf& gloss_;
    dvec3 toward_viewer_;
    double density_;  // of places, over directions [1/sr]
};

// The lobes of a surface that lights are asked for: `whole` by all of them and, where it is given, what `shared` leaves
// to places by those that set out in smoke.
struct AskedLobes {
    // NOLINTNEXTLINE(google-explicit-constructor): lobes that nobody shares are asked for as they are
    AskedLobes(const Bsdf& all_lobes, const GlossSplit* split = nullptr) : whole(all_lobes), shared(split) {}
    const Bsdf& whole;
    const GlossSplit* shared;
};

}  // namespace brisance
