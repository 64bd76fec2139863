// One voxel 1e10 times its neighbours, in emission and in extinction.
#include <cmath>

#include "stability/closed_forms.h"
#include "stability/scenes.h"

namespace brisance::stability {

namespace {

// Haze in a cube of 24 voxels of 0.1 m about the origin; fire in its middle voxel.
constexpr int kHalf = 12;
constexpr double kEdge = 0.1;
constexpr double kExtinction = 0.4;  // of the haze [1/m]
constexpr double kAlbedo = 0.5;
constexpr float kHot = 1e10f, kWarm = 1.0f;
const dvec3 kEye(0.0, -1000.0, 0.0);

// Half the length of a ray along y through the haze: nodes reach half a voxel beyond the outermost.
constexpr double kReach = (kHalf + 0.5) * kEdge;

media::Recipe haze() {
    media::Recipe r;
    r.box = media::cube(-kHalf, kHalf);
    r.world_from_index = media::cubic(kEdge);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = media::black_smoke();
    r.settings.smoke.extinction_per_metre = kExtinction;
    r.settings.smoke.albedo = Rgb(kAlbedo);
    return r;
}

media::Recipe hot_voxel() {
    media::Recipe r = haze();
    r.flame = [](const ivec3& n) { return n == ivec3(0) ? kHot : kWarm; };
    r.settings.fire.convention = EmissionConvention::Direct;
    return r;
}

double hat(double nodes) {
    return std::max(0.0, 1.0 - std::abs(nodes));
}

// Fire seen directly along y at (x, z): the warm haze, and the hot voxel's hat.
double fire_seen(double x, double z) {
    const auto seen = [](double y) { return std::exp(-kExtinction * (y + kReach)); };
    const double warm = kWarm * one_minus_transmittance(2.0 * kReach * kExtinction) / kExtinction;
    const double across = (kHot - kWarm) * hat(x / kEdge) * hat(z / kEdge);
    return warm + across * integrate([&](double y) { return seen(y) * hat(y / kEdge); }, -kEdge, kEdge, 2000);
}

Case hot_seen() {
    Case c;
    c.name = "contrast/emission-seen";
    c.truth = "integral of the field along each ray";
    c.scatters_twice = false;
    c.tolerance = {2e-3, 2e-3, "two Gauss points to a cell for emission and transmittance together"};
    c.scene = [] {
        // Rays at a fifth and three fifths of a voxel from the hot node and beyond.
        Scene scene = scene_of(hot_voxel(), camera_at(kEye, {0.0, 0.0, 0.0}, 8 * 0.4 * kEdge, 8), 64);
        scene.shot.camera.samples_per_axis = 1;
        scene.shot.camera.filter_width_pixels = 0.01f;
        scene.shot.scattering.bounces = 0;
        return scene;
    };
    c.measure = every_ray_is(
        [](const dvec3& eye, const dvec3& w) { return fire_seen(w.x / w.y * -eye.y, w.z / w.y * -eye.y); });
    c.quick = true;
    return c;
}

Case hot_scattered() {
    Case c;
    c.name = "contrast/emission-scattered";
    c.truth = "airlight of a point light (single scattering)";
    c.scatters_twice = false;
    c.tolerance = {0.03, 0.01, "the voxel's hat taken for a point, 4 voxels away and more"};
    c.scene = [] {
        const dvec3 off(0.75, 0.0, 0.55);
        Scene scene = scene_of(hot_voxel(), camera_at(kEye + off, off, 0.4, 8), 16384);
        scene.shot.scattering.bounces = 1;
        return scene;
    };
    c.measure = every_ray_is(
        [](const dvec3& eye, const dvec3& w) {
            const double x = eye.x + w.x / w.y * -eye.y, z = eye.z + w.z / w.y * -eye.y;
            return kHot * std::pow(kEdge, 3.0) *
                   airlight(kExtinction, kAlbedo * kExtinction, 0.0, 2.0 * kReach, kReach, std::hypot(x, z));
        },
        "MV");
    return c;
}

// A voxel of optical depth 1e8 in haze that glows: it hides what is behind it and shades what is beside it, no more.
Case dense_voxel() {
    Case c;
    c.name = "contrast/extinction";
    c.truth = "path tracer";
    c.tolerance = {0.2, 0.005, "the voxel's faces lie within the cells of one node, which has one brightness"};
    c.scene = [] {
        media::Recipe r = haze();
        r.density = [](const ivec3& n) { return n == ivec3(0) ? 1e10f : 1.0f; };
        r.flame = [](const ivec3&) { return 1.0f; };
        return scene_of(r, camera_at(kEye, {0.04, 0.0, 0.02}, 10 * kEdge, 16), 64);
    };
    c.measure = like_the_reference(256);
    return c;
}

}  // namespace

std::vector<Case> contrast_cases() {
    return {hot_seen(), hot_scattered(), dense_voxel()};
}

}  // namespace brisance::stability
