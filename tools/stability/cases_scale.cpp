// The same picture at another scale or another position.
#include <fmt/format.h>

#include "stability/scenes.h"

namespace brisance::stability {

namespace {

// Noisy smoke in a box, with fire in a part of it, scattering and lit by itself.
media::Recipe explosion() {
    media::Recipe r;
    r.box = {ivec3(-10, -10, -8), ivec3(9, 11, 9)};
    r.world_from_index = media::cubic(0.125);
    r.density = [](const ivec3& n) { return media::ball(n, {-0.5, 0.5, 0.5}, 8.0) * (0.5f + media::noise(n >> 1, 1)); };
    r.flame = [](const ivec3& n) { return media::ball(n, {-2.0, 0.0, 1.0}, 4.0) * media::noise(n, 2); };
    r.settings.smoke.extinction_per_metre = 3.0f;
    r.settings.smoke.albedo = Rgb(0.8f);
    r.settings.smoke.mean_cosine = 0.3f;
    r.settings.fire.convention = EmissionConvention::Direct;
    return r;
}

// Everything `scale` times as large and moved by `shift` [m], coefficients `scale` times as small.
Scene moved(double scale, const dvec3& shift) {
    media::Recipe r = explosion();
    r.world_from_index = media::transform(scale * dmat3(r.world_from_index), shift);
    r.settings.smoke.extinction_per_metre = static_cast<float>(3.0 / scale);
    r.settings.fire.strength = static_cast<float>(1.0 / scale);
    return scene_of(r, camera_at(shift + scale * dvec3(2.0, -6.0, 1.5), shift, scale * 2.6, 16), 64);
}

Scene unmoved() {
    return moved(1.0, dvec3(0.0));
}

Case scaled(double scale) {
    Case c;
    c.name = fmt::format("scale/by-{:g}", scale);
    c.truth = "the same picture at scale 1";
    c.tolerance = {1e-4, 1e-4, "rounding; the tracer's random numbers are the same"};
    c.scene = [=] { return moved(scale, dvec3(0.0)); };
    c.measure = same_paths_as(unmoved);
    c.pictures = 1;
    c.quick = scale == 1e-4;
    return c;
}

Case voxel_of(double edge) {
    Case c = scaled(edge / 0.125);
    c.name = fmt::format("scale/voxel-{:g}m", edge);
    c.quick = false;
    return c;
}

// By whole voxels, so that the lattice's levels lie where they lay, up to what doubles hold at 1e7 m.
Case far_away(const std::string& name, double scale, const dvec3& shift) {
    Case c;
    c.name = "scale/" + name;
    c.truth = "the same picture at the origin";
    c.tolerance = {1e-4, 1e-4, "rounding; the levels' lattices are anchored to the world every 2^20 voxels"};
    c.scene = [=] { return moved(scale, shift); };
    c.measure = same_paths_as([=] { return moved(scale, dvec3(0.0)); });
    c.pictures = 1;
    c.quick = scale == 1.0;
    return c;
}

// The world turned with the camera; the lattice's own axes turn with it, the shadow maps' do not.
Case turned() {
    Case c;
    c.name = "scale/turned";
    c.truth = "the same picture unturned";
    c.tolerance = {0.02, 0.01, "shadow maps and escape rays keep the world's axes"};
    c.scene = [] {
        Scene scene = unmoved();
        const dmat3 turn(dvec3(0.36, 0.48, -0.8), dvec3(-0.8, 0.6, 0.0), dvec3(0.48, 0.64, 0.6));
        media::Recipe r = explosion();
        r.world_from_index = media::transform(turn * dmat3(r.world_from_index), dvec3(0.0));
        scene.medium = media::make_medium(r);
        scene.shot.camera.eye = turn * scene.shot.camera.eye;
        scene.shot.camera.target = turn * scene.shot.camera.target;
        scene.shot.camera.up = turn * scene.shot.camera.up;
        return scene;
    };
    c.measure = same_picture_as(unmoved);
    return c;
}

}  // namespace

std::vector<Case> scale_cases() {
    const double far = 0.125 * (1 << 20) * 76.0;  // 9.96e6 m
    std::vector<Case> cases = {scaled(1e-4),
                               scaled(1e4),
                               voxel_of(1e-5),
                               voxel_of(1e5),
                               far_away("1e7m-away", 1.0, {far, -far, far}),
                               far_away("1e7m-away-millimetres", 0.008, {far, -far, far}),
                               turned()};
    // Pictures that are the same number by number are so with few particles, too; the others meet more of the roundings
    // that many particles find.
    for (Case& c : cases)
        if (c.quick)
            c.paths = {{"ray_lights", 2048}, {"volumetric_vpls", 2048}};
    return cases;
}

}  // namespace brisance::stability
