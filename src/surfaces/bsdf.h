// BSDFs of glTF's metallic-roughness materials: they are evaluated for a pair of directions, and sampled in proportion.
// Directions are unit, in world space, and point away from the surface.
//
// A surface blends three BSDFs (glTF 2.0, appendix B). Each conserves energy and is reciprocal:
//   metal           GGX with Schlick's Fresnel term;
//   coated diffuse  a GGX dielectric over a Lambert base, which gets what the coat lets through both ways (Kelemen and
//                   Szirmay-Kalos, A Microfacet Based Coupled Specular-Matte BRDF Model, EG 2001);
//   rough interface a GGX dielectric that reflects and refracts (Walter et al., Microfacet Models for Refraction
//                   through Rough Surfaces, EGSR 2007); the base colour tints refracted light.
// A thin material has a sheet instead of the interface: it reflects as the coat does, and light that it transmits
// continues straight on, tinted and without blur. The sheet must face the viewer, as opaque surfaces must.
// Light that more than one facet scatters leaves by lobes proportional to the cosine times the energy that single
// scattering loses in either direction (Kulla and Conty 2017, course notes "Revisiting Physically Based Shading at
// Imageworks"). Metal and coated diffuse are black from below.
//
// Where roughness^2 < kSmoothAlpha the interface is smooth, and where ior < kMatchedIor there is none. Those lobes are
// deltas: evaluate() and pdf() leave them out, and sample() includes them.
#pragma once

#include <optional>

#include "core/vec.h"
#include "surfaces/energy_tables.h"
#include "surfaces/ggx.h"
#include "surfaces/material.h"
#include "surfaces/shading_frame.h"

namespace brisance {

// The quantity carried along `wo`. Radiance grows by the square of the index of the side it enters, power does not:
// refracted Radiance carries the factor (index on wo's side / index on wi's side)^2, Importance (photons that arrive
// along wo and leave along wi) carries 1. Veach, Robust Monte Carlo Methods, 1997, section 5.2.
enum class Transport { Radiance, Importance };

struct BsdfSample {
    dvec3 wi;            // unit, world
    Rgb weight;          // [1] value times cosine, divided by pdf
    double pdf = 0.0;    // [1/sr]; of a delta lobe the probability of choosing it
    bool delta = false;  // no other direction could have been drawn
    bool transmitted = false;
};

// Which part of the scattering: the Lambert base, everything else, or both.
enum class Lobes { All, Base, Specular };

class Bsdf {
public:
    // Tables of the material's ior are looked up; the first such call makes them (energy_tables.h). Every number of the
    // material must lie in the range that its comment gives.
    Bsdf(const SurfaceMaterial& material, const ShadingFrame& frame, Lobes lobes = Lobes::All);

    // BSDF times |cosine of wi to the normal| [1/sr], without delta lobes.
    Rgb evaluate(const dvec3& wo, const dvec3& wi, Transport transport = Transport::Radiance) const;

    // evaluate() for one `wo`.
    class Viewed;

    // Density [1/sr] by which sample() draws wi, without delta lobes. Over the sphere it integrates to 1 less the
    // probabilities of delta lobes and of drawing nothing.
    double pdf(const dvec3& wo, const dvec3& wi) const;

    // Samples a direction from three numbers in [0, 1). None for wo from which nothing is scattered (opaque surfaces
    // from below), and where a facet reflects into its neighbours (the lobes of evaluate() contain that energy).
    std::optional<BsdfSample> sample(const dvec3& wo, const dvec3& u, Transport transport = Transport::Radiance) const;

    // The share of light along -wo that continues as if there were no surface: through sheets and matched interfaces.
    Rgb straight_on(const dvec3& wo) const;

    // The share of the power arriving along wo that the Lambert base scatters.
    Rgb base_albedo(const dvec3& wo) const;

private:
    friend class BsdfBound;

    // Everything that depends on wo alone. Directions are local, and mirrored where wo lies inside: wo.z >= 0.
    struct View {
        dvec3 wo;
        int side;                                 // 0 outside, 1 inside
        double eta;                               // index of the other side relative to wo's
        double lost;                              // energy that single scattering from wo loses: of metal and coat
        double lost_both;                         // ... of the rough interface
        float base_share;                         // of light that the coat lets through to its base
        double facets, base, up, down, straight;  // probabilities of lobes
    };

    View view_from(const dvec3& wo) const;
    void choose_lobes(View& view) const;
    Rgb straight_weight(const View& view) const;
    Albedos albedos(double cosine) const;
    double lost_both(int side, double cosine) const;
    double lost_both(int side, const InterfaceAlbedos& albedos) const;
    float coat_albedo(const Albedos& albedos, double cosine) const;

    float blend(double cosine, double eta) const;
    Rgb coat_fresnel(double cosine, double eta) const;
    float max_coat_fresnel(double cosine, double eta) const;
    Rgb facet_reflectance(const View& view, double cosine) const;
    Rgb facet_transmittance(const View& view, double cosine) const;
    double reflecting_probability(const View& view, double cosine) const;

    Rgb reflected(const View& view, const dvec3& wi) const;
    Rgb refracted(const View& view, const dvec3& wi) const;
    Rgb value(const View& view, const dvec3& wi) const;
    Rgb evaluate(const View& view, const dvec3& wi, Transport transport) const;
    double density(const View& view, const dvec3& wi) const;

    std::optional<dvec3> draw_facet(const View& view, const dvec3& u, double choice) const;
    std::optional<BsdfSample> draw_delta(const View& view, double choice) const;
    BsdfSample finished(const View& view, BsdfSample sample, Transport transport) const;

    ShadingFrame frame_;
    const EnergyTables* tables_;
    const InterfaceTables* interface_;  // of rough glass alone
    AlbedoRow row_;                     // of rough surfaces that have tables
    Ggx ggx_;
    double ior_;
    bool smooth_, matched_;
    bool has_base_, has_specular_;
    Rgb base_;
    float metal_, coated_, glass_, sheet_;  // shares of the surface; their sum is 1
    float specular_, f0_max_ = 0.0f;        // the dielectric's F90, and its largest F0 / F90
    Rgb f0_;                                // its F0 / F90
    // Albedo of multiple scattering: the share that returns of light lost by single scattering.
    Rgb metal_multiple_{0.0f}, coat_multiple_{0.0f};
    double lost_mean_ = 0.0;  // mean of View::lost
    double lost_both_mean_[2] = {0.0, 0.0};
    double crossing_[2] = {0.0, 0.0};  // share of View::lost_both that crosses to the other side
    float base_share_mean_ = 1.0f;
};

// What depends on `wo` alone is computed once, for many `wi`.
class Bsdf::Viewed {
public:
    // Keeps a reference.
    Viewed(const Bsdf& bsdf, const dvec3& wo) : bsdf_(bsdf), view_(bsdf.view_from(wo)) {}
    Rgb evaluate(const dvec3& wi, Transport transport = Transport::Radiance) const {
        return bsdf_.evaluate(view_, wi, transport);
    }

private:
    const Bsdf& bsdf_;
    View view_;
};

}  // namespace brisance
