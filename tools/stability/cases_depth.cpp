// Optical depth of one voxel from 1e-8 to 1e8, without and with scattering.
#include <cmath>

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
    c.tolerance = {3e-5, 3e-5, "single precision; rays may end at a transmittance of 1e-5"};
    c.scene = [=] {
        const double edge = 0.1;
        return scene_of(absorbing_slab(kSlabNodes, edge, voxel), camera_on_slab(kSlabNodes, edge), 16);
    };
    c.measure = every_pixel_is(Rgb(static_cast<float>(one_minus_transmittance(kSlabNodes * voxel))));
    c.quick = decade % 4 == 0;
    return c;
}

// The middle of an isothermal ball. Beyond an optical radius of 30 it is a half-space to 2 %.
double middle_of_ball(double radius) {
    return radius < 30.0 ? ScatteringBall(radius, kAlbedo, 1.0 - kAlbedo).radiance(0.0)
                         : isothermal_half_space(kAlbedo, 1.0);
}

Case scattering(int decade) {
    const double radius = kBallNodes * std::pow(10.0, decade);
    Case c;
    c.name = "depth/scattering-1e" + std::to_string(decade);
    c.truth = radius < 30.0 ? "integral equation of the isothermal ball" : "sqrt(1 - albedo) H(1)";
    // A ball of 8 voxels' radius has a rim of one voxel in which extinction falls off.
    c.tolerance = {0.03, 0.005, "the ball's rim is a voxel wide, an eighth of its radius"};
    c.scene = [=] { return scene_of(isothermal_ball(kBallNodes, radius, kAlbedo), camera_on_centre(8), 1024); };
    c.measure = [=](const Scene& scene, const RenderedFrame& frame, RenderMethod method, const Render& render) {
        return every_pixel_is(Rgb(static_cast<float>(middle_of_ball(radius))))(scene, frame, method, render);
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
