// The GGX distribution of microfacet normals with Smith's masking. Walter et al., Microfacet Models for Refraction
// through Rough Surfaces, EGSR 2007; Heitz, Understanding the Masking-Shadowing Function, JCGT 3(2), 2014.
//
// Directions are unit and local (z along the mean normal), `cosine`s those to the mean normal, 0..1. Written without
// 1 - cos^2 and without division by a cosine: stable at grazing angles, and for any alpha above 0.
#pragma once

#include <cmath>
#include <numbers>

#include "core/vec.h"

namespace brisance {

struct Ggx {
    double alpha;  // 0 < alpha <= 1

    // Facet area per area and solid angle of normals, D(h) [1/sr]; its projection integrates to 1 (Walter, eq. 33).
    double density(const dvec3& h) const {
        const double square = alpha * alpha;
        const double d = (h.x * h.x + h.y * h.y) / square + h.z * h.z;
        return 1.0 / (std::numbers::pi * square * d * d);
    }

    // G1 / cosine: masking of one direction (Walter, eq. 34).
    double masking_per_cosine(double cosine) const { return 2.0 / (cosine + root(cosine)); }
    double masking(double cosine) const { return cosine * masking_per_cosine(cosine); }

    // G2 / (cos_o cos_i) of two directions on one side, whose masking is correlated by height (Heitz, eq. 99).
    double correlated_masking_per_cosines(double cos_o, double cos_i) const {
        return 2.0 / (cos_o * root(cos_i) + cos_i * root(cos_o));
    }

    // Density of the normals that are visible from wo [1/sr].
    double visible_density(const dvec3& wo, const dvec3& h) const {
        return masking_per_cosine(wo.z) * std::max(0.0, glm::dot(wo, h)) * density(h);
    }

    // Samples a normal by that density, from two numbers in [0, 1); wo.z >= 0. Dupuy and Benyoub, Sampling Visible GGX
    // Normals with Spherical Caps, HPG 2023.
    dvec3 sample_visible(const dvec3& wo, double u, double v) const;

private:
    double root(double cosine) const {
        return std::sqrt(alpha * alpha * (1.0 - cosine) * (1.0 + cosine) + cosine * cosine);
    }
};

}  // namespace brisance
