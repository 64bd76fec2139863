// Optical depth of one voxel from 1e-8 to 1e8, without and with scattering.
#include <cmath>
#include <limits>

#include "stability/closed_forms.h"
#include "stability/scenes.h"

namespace brisance::stability {

namespace {

constexpr int kSlabNodes = 20;
constexpr int kBallNodes = 8;
constexpr double kAlbedo = 0.8;

Case absorbing(int decade) {
    const double voxel = std::pow(10.0, decade);
    Case c;
    c.name = "depth/absorbing-1e" + std::to_string(decade);
    c.truth = "1 - exp(-20 tau)";
    c.scatters_twice = false;
    c.tolerance = {3e-5, 3e-5, "single precision; rays may end at a transmittance of 1e-5"};
    c.scene = [=] {
        const double edge = 0.1;
        return scene_of(absorbing_slab(kSlabNodes, edge, voxel), camera_on_slab(kSlabNodes, edge), 16);
    };
    c.measure = every_pixel_is(Rgb(static_cast<float>(one_minus_transmittance(kSlabNodes * voxel))));
    c.quick = decade % 4 == 0;
    return c;
}

// The middle of an isothermal ball while that can be looked through; then the face of a block, since a ball's surface
// is steps of voxels, which see each other (1.6 % at an optical depth of 1 per voxel).
Case scattering(int decade) {
    const double voxel = std::pow(10.0, decade), radius = kBallNodes * voxel;
    const bool thin = decade < 0;
    Case c;
    c.name = "depth/scattering-1e" + std::to_string(decade);
    c.truth = thin ? "integral equation of the isothermal ball" : "sqrt(1 - albedo) H(1)";
    c.tolerance = {0.03, 0.005,
                   thin ? "the ball's rim is a voxel wide, an eighth of its radius"
                        : "the hierarchy does not resolve the skin that is seen"};
    // Lights scatter nothing that is seen of thin smoke, and nothing is seen of them behind the skin of thick smoke.
    if (decade <= -4 || decade >= 4)
        c.paths["ray_lights"] = 16384;
    if (decade > 0) {
        // Nearly all light ends within a part of a voxel: what a flight or a track leaves is known per voxel only.
        c.tolerance.limits["ray_lights"] = {1.0, "flights are far shorter than the skin's voxel, which few rays meet"};
        c.tolerance.limits["photon_density"] = {1.0,
                                                "few photons start in the skin, and those elsewhere never reach it"};
        c.tolerance.limits["volumetric_photons"] = {
            std::numeric_limits<double>::infinity(),
            "track lengths are counted for whole voxels, of which only a skin is seen: take the lighting grid"};
    }
    c.scene = [=] {
        if (thin)
            return scene_of(isothermal_ball(kBallNodes, radius, kAlbedo), camera_on_centre(8), 1024);
        media::Recipe r = absorbing_slab(12, 0.1, voxel);
        r.settings.smoke.albedo = Rgb(static_cast<float>(kAlbedo));
        return scene_of(r, camera_on_slab(12, 0.1), 1024);
    };
    c.measure = [=](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        const double truth =
            thin ? ScatteringBall(radius, kAlbedo, 1.0 - kAlbedo).radiance(0.0) : isothermal_half_space(kAlbedo, 1.0);
        return every_pixel_is(Rgb(static_cast<float>(truth)))(scene, frame, method, render);
    };
    c.quick = decade % 4 == 0;
    return c;
}

}  // namespace

std::vector<Case> depth_cases() {
    std::vector<Case> cases;
    for (int decade = -8; decade <= 8; ++decade)
        cases.push_back(absorbing(decade));
    for (int decade = -8; decade <= 8; ++decade)
        cases.push_back(scattering(decade));
    return cases;
}

}  // namespace brisance::stability
