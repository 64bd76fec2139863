// Bias compensation: the light that the bound of point lights removes, along a ray of the camera and at a surface
// point.
//
// At a vertex u the bounded lights omit the fraction 1 - b w^2 of the light from the medium at v, where the distance w
// is below r = 1 / sqrt(b):
//   integral over directions and w of  p(u) sigma_s(v) T(u, v) (1 - b w^2) S(v -> u)      [W/(m^2 sr)]
// S is all light scattered at v: direct light of fire and emitters, light of surfaces, and light of the rest of the
// medium, which is that of the bounded lights plus what they omit at v.
//
// Exact [1, 2]: a path that samples the phase function or the BSDF at u and collides at v. There it gathers direct
// light (transport/path_step.h) and one of the bounded lights, and continues. A collision within r is weighted by the
// fraction omitted there. Collisions beyond r do not count, as the bounded lights hold their light. Surfaces, fire and
// emitters count in full, as the lights hold none of theirs. After a delta lobe, which the lights do not reach, every
// collision counts in full. Unbiased, except for what paths from the camera cannot find: a point lamp in a mirror.
// Where r is many mean free paths this is a path tracer.
//
// Local (after the idea of [3], whose formulas are not public; these are this program's own): the medium within r is
// taken to be homogeneous, with the extinction and albedo at u and transmittance in closed form, and without surfaces
// between u and v. v is sampled from this model, and S is estimated there from fire, emitters and one bounded light.
// The fraction k = albedo * Bound::share_left_out(extinction) that is omitted at v is taken to be constant within r,
// which gives S / (1 - k). Its bias: too bright or too dark where the medium changes within r, above all
// at its edge and behind walls thinner than r; light of surfaces that scatters at v is missing; S / (1 - k) is wrong
// where the light changes within r, the more so the denser the medium and the higher its albedo, as k nears 1.
//
// [1] Raab, Seibert, Keller, Unbiased Global Illumination with Participating Media, MCQMC 2006.
// [2] Kollig, Keller, Illumination in the Presence of Weak Singularities, MCQMC 2004.
// [3] Engelhardt, Novak, Schmidt, Dachsbacher, Approximate Bias Compensation for Rendering Scenes with Heterogeneous
//     Participating Media, CGF 31(7), 2012.
#pragma once

#include "volumetric_vpls/settings.h"
#include "volumetric_vpls/vpl_sum.h"

namespace brisance {

struct PathState;

class Compensation {
public:
    // Keeps references to scene and lights. `bounces`: the most scatterings of a path; -1: all.
    Compensation(const DirectLight& scene, const VplSum& lights, const VolumetricVplSettings& settings, int bounces);

    Rgb along_ray(const RayMedium& seen, Rng& rng) const;      // [W/(m^2 sr)]
    Rgb at_surface(const PathVertex& vertex, Rng& rng) const;  // of its lobes other than deltas [W/(m^2 sr)]

private:
    class LostPath;
    bool enabled() const;
    Rgb lost_exactly(const PathVertex& vertex, Rng& rng) const;
    Rgb lost_locally(const PathVertex& vertex, const Collision& smoke, Rng& rng) const;
    Rgb follow(PathState first, Rng& rng) const;

    const DirectLight& scene_;
    const VplSum& lights_;
    BiasCompensation how_;
    int samples_;
    int bounces_;
};

}  // namespace brisance
