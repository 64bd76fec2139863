// Henyey-Greenstein phase functions from backward to forward.
#include <fmt/format.h>
#include <cmath>

#include "lighting_grid/voxel_lights.h"
#include "stability/scenes.h"

namespace brisance::stability {

namespace {

constexpr int kNodes = 10;
constexpr double kRadius = 2.0;

media::Recipe with_mean_cosine(media::Recipe recipe, double g) {
    recipe.settings.smoke.mean_cosine = static_cast<float>(g);
    return recipe;
}

Case conservation(double g) {
    Case c;
    c.name = fmt::format("phase/{}-power", g);
    c.truth = "power out = power emitted, albedo 1";
    c.tolerance = {0.03, 0.005, "one direction stands for all, and moments stop at degree 2"};
    const Limit beyond{0.6, "a peak hardly ever meets the next light: what it carries is in few bright samples"};
    if (std::abs(g) >= 0.99)
        c.tolerance.limits["volumetric_vpls"] = beyond;
    if (g == -0.999) {
        // What more lights would show are some of those samples, and with them a noise as large as the limit.
        c.tolerance.limits["ray_lights"] = beyond;
        c.paths = {{"ray_lights", 4096}, {"volumetric_vpls", 4096}};
    }
    c.scene = [=] { return scene_of(with_mean_cosine(burning_ball(kNodes, kRadius, 1.0), g), camera_on_ball(24), 64); };
    c.measure = power_is([](const Scene& scene) { return total(voxel_lights(scene.medium)).x; });
    c.quick = g == -0.999;
    return c;
}

Case picture(double g) {
    Case c;
    c.name = fmt::format("phase/{}-picture", g);
    c.truth = "path tracer";
    c.tolerance = {0.05, 0.005, "radiance that arrives is kept as moments up to degree 2"};
    c.scene = [=] {
        return scene_of(with_mean_cosine(isothermal_ball(kNodes, kRadius, 0.9), g), camera_on_ball(16), 64);
    };
    c.measure = like_the_reference(256);
    c.quick = g == 0.9;
    return c;
}

Case single(double g) {
    Case c = picture(g);
    c.name = fmt::format("phase/{}-single", g);
    c.tolerance = {0.05, 0.005, "directions between lights of a lattice"};
    c.scatters_twice = false;
    c.scene = [scene = c.scene] {
        Scene once = scene();
        once.shot.scattering.bounces = 1;
        return once;
    };
    c.quick = g == 0.999;
    return c;
}

}  // namespace

std::vector<Case> phase_cases() {
    std::vector<Case> cases;
    for (const double g : {0.0, 0.9, -0.9, 0.999, -0.999}) {
        cases.push_back(conservation(g));
        cases.push_back(picture(g));
        cases.push_back(single(g));
    }
    return cases;
}

}  // namespace brisance::stability
