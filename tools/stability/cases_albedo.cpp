// Albedo from 0 to 1, grey and coloured.
#include "lighting_grid/voxel_lights.h"
#include "stability/closed_forms.h"
#include "stability/scenes.h"

namespace brisance::stability {

namespace {

constexpr int kNodes = 12;
constexpr double kNearlyOne = 1.0 - 1e-7;  // 1 - 1.2e-7 in single precision

Tolerance of_the_ball() {
    return {0.03, 0.015, "a ball of 12 voxels' radius is not quite round, and its rim is a voxel wide"};
}

Measure middle(double radius, double albedo, double emission) {
    return [=](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        const double truth = ScatteringBall(radius, albedo, emission).radiance(0.0);
        return every_pixel_is(Rgb(static_cast<float>(truth)))(scene, frame, method, render);
    };
}

// A voxel of a thick ball is more than a mean free path: what its steps do is no longer what a smooth surface does.
void hold_against_the_tracer(Case& c) {
    c.truth = "path tracer";
    c.tolerance = {0.05, 0.005, "1.7 mean free paths to a voxel"};
    c.measure = like_the_reference(1024);
    c.quick = false;
}

Case isothermal(const std::string& name, double radius, double albedo) {
    Case c;
    c.name = "albedo/" + name;
    c.truth = "integral equation of the isothermal ball";
    c.scatters_twice = albedo > 0.0;
    c.tolerance = of_the_ball();
    c.scene = [=] { return scene_of(isothermal_ball(kNodes, radius, albedo), camera_on_centre(8), 512); };
    const double absorbed = 1.0 - double(static_cast<float>(albedo));
    c.measure = middle(radius, static_cast<float>(albedo), absorbed);
    c.quick = albedo == kNearlyOne;
    if (radius > 5.0)
        hold_against_the_tracer(c);
    return c;
}

// Emission of 1 per metre and steradian, so that the emitted part of the source function is 1 / extinction.
Case direct(const std::string& name, double radius, double albedo) {
    Case c;
    c.name = "albedo/" + name;
    c.truth = "integral equation of the uniformly emitting ball";
    c.tolerance = of_the_ball();
    c.scene = [=] { return scene_of(burning_ball(kNodes, radius, albedo), camera_on_centre(8), 512); };
    c.measure = middle(radius, static_cast<float>(albedo), 1.0 / radius);
    c.quick = albedo == 1.0;
    if (radius > 5.0)
        hold_against_the_tracer(c);
    return c;
}

Case conservation(const std::string& name, double radius) {
    Case c;
    c.name = "albedo/" + name;
    c.truth = "power out = power emitted";
    c.tolerance = {0.03, 0.005, "one direction stands for all: the lattice's ball is not quite round"};
    c.scene = [=] { return scene_of(burning_ball(kNodes, radius, 1.0), camera_on_ball(24), 64); };
    c.measure = power_is([](const Scene& scene) { return total(voxel_lights(scene.medium)).x; });
    return c;
}

// Channels are independent: each must equal the grey picture of its own albedo.
Case coloured() {
    constexpr double radius = 2.0;
    const dvec3 albedo(0.99, 0.6, 0.0);
    Case c;
    c.name = "albedo/coloured";
    c.truth = "integral equation of the isothermal ball, channel by channel";
    c.tolerance = of_the_ball();
    c.scene = [=] {
        media::Recipe r = isothermal_ball(kNodes, radius, 0.0);
        r.settings.smoke.albedo = Rgb(albedo);
        return scene_of(r, camera_on_centre(8), 1024);
    };
    c.measure = [=](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        Rgb truth;
        for (int k = 0; k < 3; ++k)
            truth[k] = static_cast<float>(ScatteringBall(radius, albedo[k], 1.0 - albedo[k]).radiance(0.0));
        return every_pixel_is(truth)(scene, frame, method, render);
    };
    return c;
}

}  // namespace

std::vector<Case> albedo_cases() {
    return {isothermal("0", 2.0, 0.0),
            isothermal("0.9", 2.0, 0.9),
            isothermal("0.9999999", 2.0, kNearlyOne),
            isothermal("0.9999999-thick", 20.0, kNearlyOne),
            direct("1-thin", 0.01, 1.0),
            direct("1", 2.0, 1.0),
            direct("1-thick", 20.0, 1.0),
            conservation("1-power", 2.0),
            conservation("1-power-thick", 20.0),
            coloured()};
}

}  // namespace brisance::stability
