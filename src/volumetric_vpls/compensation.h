// The light that the bound of point lights takes away: along a ray of the camera, and at a point of a surface.
//
// At a place u the bounded lights leave out, of all that arrives from smoke at v at a distance w below r = 1 / sqrt(b),
// the part 1 - b w^2:
//   integral over directions and w of  p(u) sigma_s(v) T(u, v) (1 - b w^2) S(v -> u)      [W/(m^2 sr)]
// S is all that is scattered at v: light that has come to v straight from fire and emitters, from surfaces, and from
// other smoke, that is, from the bounded lights, and what they leave out at v in turn.
//
// Exact (Raab, Seibert, Keller, Unbiased Global Illumination with Participating Media, MCQMC 2006; after Kollig and
// Keller 2004): a path by the phase function or the BSDF of u that collides at v. There it asks lines toward the fire
// and emitters, and one of the bounded lights, and goes on: into smoke nearer than r with the part left out there, no
// farther; to surfaces, and to fire and emitters along its way, as any path does, as the lights hold none of these.
// After mirrors smoke counts whole, as lights do not shine into delta lobes. Unbiased, but for what paths from the
// camera cannot find: a point lamp in a mirror. Where r is many mean free paths this is a path tracer.
//
// Local (after the idea of Engelhardt, Novak, Schmidt, Dachsbacher, Approximate Bias Compensation for Rendering Scenes
// with Heterogeneous Participating Media, CGF 31(7), 2012; its formulas are not public, these are this program's own
// reading): the smoke within r is taken to be like that at u, of its extinction, albedo and transmittance in closed
// form, and nothing is taken to hide v from u. v is drawn by them alone; S is asked there, from fire, emitters and one
// bounded light. What is left out at v in turn is taken to be the same part k of all light there as anywhere near:
// S / (1 - k), k = albedo * Bound::share_left_out(extinction). Its bias: too bright or dark where smoke changes within
// r, at the smoke's edge above all, and behind walls thinner than r; light that comes from a surface to v and scatters
// there is missing; S / (1 - k) is wrong where light changes within r, the more so the whiter and denser the smoke, as
// k nears 1.
#pragma once

#include "volumetric_vpls/settings.h"
#include "volumetric_vpls/vpl_sum.h"

namespace brisance {

class Compensation {
public:
    // Keeps references to scene and lights. `bounces`: the most scatterings of a path; -1: all.
    Compensation(const DirectLight& scene, const VplSum& lights, const VolumetricVplSettings& settings, int bounces);

    Rgb along_ray(const RayMedium& seen, Rng& rng) const;     // [W/(m^2 sr)]
    Rgb at_surface(const PathVertex& place, Rng& rng) const;  // of its lobes without delta [W/(m^2 sr)]

private:
    struct Vertex;
    struct Step;
    bool wanted() const;
    Rgb lost_exactly(const PathVertex& place, Rng& rng) const;
    Rgb lost_locally(const PathVertex& place, const Collision& smoke, Rng& rng) const;
    Rgb follow(Vertex vertex, Rng& rng) const;
    Step gather(const Vertex& vertex, Rng& rng) const;
    bool go_on(Vertex& vertex, const Step& step) const;

    const DirectLight& scene_;
    const VplSum& lights_;
    BiasCompensation how_;
    int samples_;
    int bounces_;
};

}  // namespace brisance
