// Difficult cameras: inside fire, inside opaque smoke, on faces of voxels, looking along axes.
#include "stability/closed_forms.h"
#include "stability/scenes.h"

namespace brisance::stability {

namespace {

constexpr int kNodes = 20;
constexpr double kEdge = 0.1;

Tolerance of_absorption() {
    return {5e-5, 5e-5, "single precision; rays may end at a transmittance of 1e-5"};
}

// Looking up along z from inside the slab, `ahead` voxels of it in front.
Case in_slab(const std::string& name, double voxel_depth, const dvec3& eye_nodes, double ahead) {
    Case c;
    c.name = "camera/" + name;
    c.truth = "1 - exp(-tau) of what is ahead";
    c.scatters_twice = false;
    c.tolerance = of_absorption();
    c.scene = [=] {
        const dvec3 eye = kEdge * eye_nodes;
        return scene_of(absorbing_slab(kNodes, kEdge, voxel_depth), camera_at(eye, eye + dvec3(0.0, 0.0, 1.0), 1e-3, 8),
                        16);
    };
    c.measure = every_pixel_is(Rgb(static_cast<float>(one_minus_transmittance(ahead * voxel_depth))));
    c.quick = true;
    return c;
}

// The middle one of an odd number of rays goes exactly along z, on a line of nodes; the others within rounding of it.
Case along_axis(const std::string& name, double sign) {
    Case c;
    c.name = "camera/" + name;
    c.truth = "1 - exp(-20 tau)";
    c.scatters_twice = false;
    c.tolerance = of_absorption();
    c.scene = [=] {
        CameraSettings camera;
        camera.eye = {0.0, 0.0, 1.0 - sign * 50.0};
        camera.target = {0.0, 0.0, 1.0};
        camera.up = {0.0, 1.0, 0.0};
        camera.width = camera.height = 9;
        camera.vertical_fov_degrees = 1e-6;
        camera.samples_per_axis = 1;
        return scene_of(absorbing_slab(kNodes, kEdge, 0.1), camera, 64);
    };
    c.measure = every_pixel_is(Rgb(static_cast<float>(one_minus_transmittance(kNodes * 0.1))));
    c.quick = true;
    return c;
}

// From the centre of a ball every ray sees the same.
Case in_ball(const std::string& name, double radius, double albedo) {
    Case c;
    c.name = "camera/" + name;
    c.truth = "integral equation of the isothermal ball, seen from its centre";
    c.tolerance = {0.03, 0.005, "the hierarchy's own error in a ball of 12 voxels' radius"};
    c.scene = [=] {
        CameraSettings camera = camera_at(dvec3(0.0), {0.3, 1.0, 0.2}, 1.0, 8);
        return scene_of(isothermal_ball(12, radius, albedo), camera, 512);
    };
    c.measure = [=](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        const double truth = ScatteringBall(radius, albedo, 1.0 - albedo).radiance_from_centre();
        return every_pixel_is(Rgb(static_cast<float>(truth)))(scene, frame, method, render);
    };
    return c;
}

// A dense voxel around the eye hides everything.
Case in_dense_voxel() {
    Case c;
    c.name = "camera/in-dense-voxel";
    c.truth = "the voxel's own source function";
    c.scatters_twice = false;
    c.tolerance = of_absorption();
    c.scene = [] {
        media::Recipe r = absorbing_slab(kNodes, kEdge, 0.1);
        r.density = [](const ivec3& n) {
            return n == ivec3(0, 0, 10) ? 1e8f : (n.z >= 0 && n.z < kNodes ? 1.0f : 0.0f);
        };
        r.flame = [](const ivec3& n) { return glm::length(dvec3(n - ivec3(0, 0, 10))) < 2.0 ? 3.0f : 1e4f; };
        const dvec3 eye = kEdge * dvec3(0.1, -0.2, 10.1);
        return scene_of(r, camera_at(eye, eye + dvec3(0.4, 0.3, 1.0), 1.0, 8), 16);
    };
    c.measure = every_pixel_is(Rgb(3.0f));
    c.quick = true;
    return c;
}

}  // namespace

std::vector<Case> camera_cases() {
    return {in_slab("in-fire", 0.1, {0.13, 0.27, 7.3}, 12.2),
            in_slab("in-opaque-smoke", 1e6, {0.13, 0.27, 7.3}, 12.2),
            in_slab("on-a-face", 0.1, {0.13, 0.27, 7.0}, 12.5),
            in_slab("on-a-node", 0.1, {0.0, 0.0, 7.0}, 12.5),
            along_axis("up-an-axis", 1.0),
            along_axis("down-an-axis", -1.0),
            in_ball("in-scattering-fire", 2.0, 0.9),
            in_dense_voxel()};
}

}  // namespace brisance::stability
