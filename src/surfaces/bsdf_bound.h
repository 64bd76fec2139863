// Upper bounds of a BSDF over cones of directions, for choosing among groups of lights.
//
// Walter et al., Lightcuts: A Scalable Approach to Illumination, SIGGRAPH 2005, section 3.2, bounds Phong's and Ward's
// lobes; this is the same for GGX. The half vector between wo and a direction in a cone of half angle a lies within
// a / (2 cos(t / 2)) of that of the cone's axis, where t is the largest angle of the cone to wo: it is the middle of
// the arc from wo. Masking times the cosine, G2 cos_i / (cos_o cos_i), rises with cos_i, and counts at the largest
// cosine in the cone.
#pragma once

#include "surfaces/bsdf.h"

namespace brisance {

class BsdfBound {
public:
    // For light scattered toward `wo`. Keeps a reference.
    BsdfBound(const Bsdf& bsdf, const dvec3& wo);

    // At least the largest channel of evaluate(wo, wi) for every wi in the cone [1/sr]. `axis`: unit, world;
    // `cos_around`: of the cone's half angle, -1 for all directions. `most_cosine`: only directions whose cosine to the
    // normal is no larger count. Rough glass has no bound: there it is a guess above zero.
    double over(const dvec3& axis, double cos_around, double most_cosine = 1.0) const;

private:
    double facets_over(const dvec3& axis, double cos_around, double cosine) const;

    const Bsdf& bsdf_;
    Bsdf::View view_;
    dvec3 wo_, normal_;          // world; the normal on the side of wo
    double cosine_lobes_ = 0.0;  // over cos / pi: of all that is about proportional to the cosine
    bool has_facets_ = false;    // rough ones
    double transmitted_ = 0.0;   // [1/sr]
};

}  // namespace brisance
