// The light lost between microfacets when only its first reflection or refraction counts, tabulated over roughness and
// angle for one index of refraction. It is the basis of energy compensation (Kulla and Conty, Revisiting Physically
// Based Shading at Imageworks, SIGGRAPH 2017 course).
//
// Tables hold directional albedos: shares, 0..1, of light from one direction that leave after one facet. They are
// within 1e-3 of the exact integrals for every roughness that is not smooth and a Fresnel term of 1 beyond the critical
// angle. From inside a weaker dielectric (specular below 1) they are within 4e-3, because its Fresnel term jumps at
// that angle. That jump asks for seven times the points, which glass alone pays for: it has tables of its own.
#pragma once

#include "surfaces/albedo_table.h"

namespace brisance {

// With the blend s(angle) of fresnel.h, and a Fresnel term F = a + b s, the sum of F over facets that reflect to the
// outside is a reflect + b reflect_blend.
struct Albedos {
    double reflect = 1.0, reflect_blend = 0.0;
};

// Reflected and refracted, with F beyond the critical angle 1. The parts jump at that angle; these sums do not.
struct InterfaceAlbedos {
    double first[2] = {1.0, 1.0}, second[2] = {0.0, 0.0}, third[2] = {0.0, 0.0};  // from outside, from inside
    double all(int side, double a, double b) const { return first[side] + a * second[side] + b * third[side]; }
};

// Of metal and coats.
class EnergyTables {
public:
    explicit EnergyTables(double ior);

    double ior() const { return ior_; }
    // Mean of the blend over the hemisphere outside, weighted by the cosine.
    double mean_blend() const { return mean_blend_; }

    // From directions of that cosine.
    Albedos at(const AlbedoRow& row, double cosine) const;
    // The means of at() over the hemisphere, weighted by the cosine.
    Albedos mean(double alpha) const;

private:
    double ior_, mean_blend_;
    AlbedoTable<2> table_;
    AlbedoMeans<2> means_;
};

// Of glass.
class InterfaceTables {
public:
    explicit InterfaceTables(double ior);

    double ior() const { return ior_; }
    InterfaceAlbedos at(const AlbedoRow& row, double cosine) const;
    InterfaceAlbedos mean(double alpha) const;

private:
    double ior_;
    AlbedoTable<6> table_;
    AlbedoMeans<6> means_;
};

// The exact integrals, by quadrature with at least this many points. The tables are made of them and tested against
// them.
Albedos integrate_albedos(double ior, double alpha, double cosine, int points);
InterfaceAlbedos integrate_interface_albedos(double ior, double alpha, double cosine, int points);

// Tables of one index of refraction, made by the first call (0.25 and 2 s of one core) and kept until the program
// ends. Thread-safe. Throw Error for an index outside 1..10.
const EnergyTables& energy_tables(float ior);
const InterfaceTables& interface_tables(float ior);

}  // namespace brisance
