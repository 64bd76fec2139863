// One absorbing voxel in a vacuum: before the fire as the camera sees it, and between fire and smoke.
#include <cmath>

#include "stability/closed_forms.h"
#include "stability/scenes.h"

namespace brisance::stability {

namespace {

constexpr double kEdge = 0.1;
constexpr double kDepth = 2.0;  // of the voxel, through its middle
constexpr int kFire = 14;       // the fire's first layer, or the smoke's position, above the voxel at 0

double hat(double nodes) {
    return std::max(0.0, 1.0 - std::abs(nodes));
}

media::Recipe nothing() {
    media::Recipe r;
    r.box = {ivec3(-10, -10, -kFire), ivec3(10, 10, kFire + 8)};
    r.world_from_index = media::cubic(kEdge);
    r.settings = media::black_smoke();
    r.settings.smoke.extinction_per_metre = static_cast<float>(1.0 / kEdge);
    return r;
}

Case seen() {
    Case c;
    c.name = "shadow/voxel-before-the-fire";
    c.truth = "exp(-tau), tau the column through the voxel's hat";
    c.scatters_twice = false;
    c.tolerance = {1e-4, 2e-3, "Gauss points are exact along a ray; the tracer averages over pixels"};
    c.scene = [] {
        media::Recipe r = nothing();
        r.density = [](const ivec3& n) {
            return n == ivec3(0) ? static_cast<float>(kDepth) : (n.z >= kFire ? 1000.0f : 0.0f);
        };
        r.flame = [](const ivec3& n) { return n.z >= kFire - 2 ? 1.0f : 0.0f; };
        Scene scene = scene_of(r, camera_at({0.0, 0.0, -1000.0}, dvec3(0.0), 0.4, 16), 64);
        scene.shot.camera.samples_per_axis = 1;
        scene.shot.camera.filter_width_pixels = 0.01f;
        return scene;
    };
    c.measure = every_ray_is([](const dvec3& eye, const dvec3& w) {
        return std::exp(-kDepth * hat(w.x / w.z * -eye.z / kEdge) * hat(w.y / w.z * -eye.z / kEdge));
    });
    c.quick = true;
    return c;
}

// Optical depth of the voxel's hat between two points, in nodes.
double depth_between(const dvec3& a, const dvec3& b) {
    const auto density = [&](double t) {
        const dvec3 p = glm::mix(a, b, t);
        return hat(p.x) * hat(p.y) * hat(p.z);
    };
    // The hat reaches one node from z = 0.
    const double from = (-1.0 - a.z) / (b.z - a.z), to = (1.0 - a.z) / (b.z - a.z);
    return kDepth * glm::length(b - a) * integrate(density, from, to, 40);
}

// Fluence at a point [nodes] from a hat of fire around (0, 0, -kFire / 2), times the square of an edge.
double fluence(const dvec3& p) {
    constexpr int n = 10;
    double sum = 0.0;
    for (int i = 0; i < n * n * n; ++i) {
        const dvec3 o = (dvec3(i / (n * n), i / n % n, i % n) + 0.5) * (2.0 / n) - 1.0;
        const dvec3 from = o + dvec3(0.0, 0.0, -kFire / 2), offset = p - from;
        sum += hat(o.x) * hat(o.y) * hat(o.z) * std::exp(-depth_between(from, p)) / glm::dot(offset, offset);
    }
    return sum * 8.0 / (n * n * n);
}

// Fire, absorber and smoke are single voxels seven apart in a row; all but a sixth of the light is held up.
Case scattered() {
    constexpr double thin = 1e-3;
    Case c;
    c.name = "shadow/voxel-between-fire-and-smoke";
    c.truth = "integral over the fire's and the smoke's hats (single scattering)";
    c.scatters_twice = false;
    c.tolerance = {0.1, 0.01, "the shadow's edge is as narrow as the smoke"};
    c.tolerance.limits["lighting_grid"] = {
        0.4, "seven voxels away lights stand for several voxels, and their shadow maps blur what one voxel covers"};
    c.scene = [] {
        media::Recipe r = nothing();
        r.density = [](const ivec3& n) {
            return n == ivec3(0) ? static_cast<float>(kDepth) : (n == ivec3(0, 0, kFire / 2) ? float(thin) : 0.0f);
        };
        r.flame = [](const ivec3& n) { return n == ivec3(0, 0, -kFire / 2) ? 1e4f : 0.0f; };
        r.settings.smoke.albedo = Rgb(0.5f);
        r.settings.fire.convention = EmissionConvention::Direct;
        const dvec3 target = kEdge * dvec3(0.0, 0.0, kFire / 2);
        Scene scene = scene_of(r, camera_at(target + dvec3(0.0, -1000.0, 0.0), target, 0.002, 4), 4096);
        scene.shot.scattering.bounces = 1;
        return scene;
    };
    c.measure = [](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        const auto along = [](double y) { return hat(y) * fluence(dvec3(0.0, y, kFire / 2)); };
        const double truth = 0.5 * thin * 1e4 * kEdge / (4.0 * kExactPi) * integrate(along, -1.0, 1.0, 20);
        return every_pixel_is(Rgb(static_cast<float>(truth)), "MV")(scene, frame, method, render);
    };
    c.quick = true;
    return c;
}

}  // namespace

std::vector<Case> shadow_cases() {
    return {seen(), scattered()};
}

}  // namespace brisance::stability
