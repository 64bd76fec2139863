// Surfaces to test, and integrals over their directions that do not use their sampling.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "surfaces/bsdf.h"

namespace brisance::testing {

struct NamedSurface {
    std::string name;
    SurfaceMaterial material;
    double side = 1.0;        // that wo lies on: 1 outside, -1 inside
    double tolerance = 1e-3;  // of the white furnace
};

// White and lossless: a conductor with F0 = 1, diffuse under a coat, dielectrics that refract (from either side), and
// their blends.
std::vector<NamedSurface> conserving_surfaces();

// Coloured, in every combination of lobes.
std::vector<NamedSurface> coloured_surfaces();

// Unit, in the frame's xz plane and turned about the normal by `azimuth`; `cosine` to the normal, negative from inside.
dvec3 direction(double cosine, double azimuth = 0.3);

double alpha_of(const SurfaceMaterial& material);

// Integral of f over the sphere of directions, for f with the peaks of that material seen from wo. Uses Fibonacci
// lattices of at least that many points in each of five sampling techniques, weighted by the balance
// heuristic (Veach 1997, section 9.2): error below 2e-4 for directional albedos at the default.
Rgb integrate_sphere(const SurfaceMaterial& material, const dvec3& wo, const std::function<Rgb(const dvec3&)>& f,
                     int points = 4000);

// Share of power arriving along wo that leaves, delta lobes included.
Rgb directional_albedo(const SurfaceMaterial& material, const dvec3& wo);

// Each delta lobe of the surface once.
std::vector<BsdfSample> delta_lobes(const Bsdf& bsdf, const dvec3& wo, Transport transport = Transport::Importance);

}  // namespace brisance::testing
