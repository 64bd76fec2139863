// The light lost between microfacets when only its first reflection or refraction counts, tabulated over roughness and
// angle for one index of refraction. It is the basis of energy compensation (Kulla and Conty, Revisiting Physically
// Based Shading at Imageworks, SIGGRAPH 2017 course).
//
// Tables hold directional albedos: shares, 0..1, of light from one direction that leave after one facet. They are
// within 1e-3 of the exact integrals for every roughness that is not smooth and a Fresnel term of 1 beyond the critical
// angle. From inside a weaker dielectric (specular below 1) they are within 4e-3, because its Fresnel term jumps at
// that angle.
#pragma once

#include <array>
#include <vector>

namespace brisance {

// Below this alpha (roughness 0.01) an interface is smooth: its lobes are deltas.
constexpr double kSmoothAlpha = 1e-4;

// Below this index of refraction the interface is matched: nothing is reflected (less than 3e-7 would be), and light
// continues straight on.
constexpr double kMatchedIor = 1.001;

// With the blend s(angle) of fresnel.h, and a Fresnel term F = a + b s (1 beyond the critical angle):
// Reflected alone: E = sum of F over facets = a reflect + b (reflect_blend), from outside.
// Reflected and refracted: first[side] + a second[side] + b third[side]. Its parts jump at the critical angle; these
// sums do not.
struct Albedos {
    double reflect = 1.0, reflect_blend = 0.0;
    double first[2] = {1.0, 1.0}, second[2] = {0.0, 0.0}, third[2] = {0.0, 0.0};  // from outside, from inside

    // The total albedo with F = a + b s.
    double all(int side, double a, double b) const { return first[side] + a * second[side] + b * third[side]; }
};

class EnergyTables {
public:
    explicit EnergyTables(double ior);

    double ior() const { return ior_; }
    // Mean of the blend over the hemisphere outside, weighted by the cosine.
    double mean_blend() const { return mean_blend_; }

    // Where a roughness lies in the table: a BSDF asks for many cosines of its own.
    struct Row {
        double alpha;
        int first;     // of the two rows around it
        double above;  // the share of the second
    };
    // Of a rough interface (alpha >= kSmoothAlpha).
    static Row row(double alpha);
    // From directions of that cosine.
    Albedos at(const Row& row, double cosine) const;
    Albedos at(double alpha, double cosine) const { return at(row(alpha), cosine); }
    // The means of at() over the hemisphere, weighted by the cosine.
    Albedos mean(double alpha) const;

private:
    static constexpr int kNumbers = 8;
    using Entry = std::array<float, kNumbers>;

    double ior_, mean_blend_;
    std::vector<Entry> table_;  // [roughness][angle]
    std::vector<Entry> means_;  // [finer roughness]
};

// The exact integrals, by quadrature with at least this many points. The tables are made of them and tested against
// them.
Albedos integrate_albedos(double ior, double alpha, double cosine, int points = 4181);

// Tables of one index of refraction, made by the first call (1.5 s of one core) and kept until the program ends.
// Thread-safe. Throws Error for an index outside 1..10.
const EnergyTables& energy_tables(float ior);

}  // namespace brisance
