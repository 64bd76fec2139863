// What glossy and specular surfaces reflect of the medium's light (parts of SV, SM, and behind panes SS).
//
// A direction is drawn from the lobes, and what the medium emits and scatters along it is seen. Small flames, and the
// smoke that they make glow, are rarely met so. A line toward the fire finds them, too; the balance heuristic weights
// both.
#pragma once

#include "light_selection/gloss_split.h"
#include "surface_lighting/medium_along_ray.h"

namespace brisance {

// All lobes but the base, and how rays and lights share them.
struct GlossyLobes {
    Bsdf bsdf;
    GlossSplit split;
    GlossyLobes(const SurfacePoint& point, const dvec3& toward_viewer, int light_samples)
        : bsdf(point.material, point.frame, Lobes::Specular), split(point, bsdf, toward_viewer, light_samples) {}
    GlossyLobes(const GlossyLobes&) = delete;
    GlossyLobes& operator=(const GlossyLobes&) = delete;
};

// Whether lobes other than the base are there and are not deltas.
bool has_wide_lobes(const SurfaceMaterial& m);

class GlossOfMedium {
public:
    // Keeps references. `through_panes`: light that passes panes is wanted.
    GlossOfMedium(const DirectLight& direct, const MediumAlongRay& medium, bool through_panes)
        : direct_(direct), medium_(medium), through_panes_(through_panes) {}

    // Adds one estimate. `numbers`: in [0, 1), of which the lobes' direction is made. Returns what that direction
    // meets: the mean of 1 / distance, of a surface or of smoke as far as that hides it [1/m].
    double reflect(const SurfacePoint& point, const dvec3& toward_viewer, const GlossyLobes& lobes,
                   const dvec3& numbers, Rng& ray_rng, CellSum& light) const;

private:
    const DirectLight& direct_;
    const MediumAlongRay& medium_;
    bool through_panes_;
};

}  // namespace brisance
