#include "stability/scenes.h"

#include <cmath>

#include "scene/load_scene.h"
#include "stability/closed_forms.h"

namespace brisance::stability {

CameraSettings camera_at(const dvec3& eye, const dvec3& target, double width, int pixels) {
    CameraSettings camera;
    camera.eye = eye;
    camera.target = target;
    const dvec3 view = glm::normalize(target - eye);
    camera.up = std::abs(view.z) < 0.9 ? dvec3(0.0, 0.0, 1.0) : dvec3(0.0, 1.0, 0.0);
    camera.width = camera.height = pixels;
    camera.vertical_fov_degrees = 2.0 * std::atan(0.5 * width / glm::length(target - eye)) * 180.0 / kExactPi;
    return camera;
}

Scene scene_of(const media::Recipe& recipe, const CameraSettings& camera, int paths) {
    Scene scene{media::make_medium(recipe), {}};
    scene.shot.medium = recipe.settings;
    scene.shot.camera = camera;
    scene.shot.camera_given = true;
    scene.shot.tracing.samples = paths;
    return scene;
}

Scene with_set(Scene scene, const SceneSettings& set) {
    constexpr std::uint64_t kMemory = std::uint64_t{1} << 30;
    Progress silent;
    scene.surroundings = std::make_shared<const Surroundings>(
        load_scene(set, {}, 0.0, scene.medium.world_of_local(vec3(0.0f)), kMemory, silent), set.lights);
    scene.shot.scene = set;
    return scene;
}

media::Recipe isothermal_ball(int nodes, double optical_radius, double albedo) {
    media::Recipe r = media::glowing_ball(nodes, 1.0f);
    r.settings.smoke.extinction_per_metre = static_cast<float>(optical_radius);
    r.settings.smoke.albedo = Rgb(static_cast<float>(albedo));
    return r;
}

media::Recipe burning_ball(int nodes, double optical_radius, double albedo) {
    media::Recipe r = isothermal_ball(nodes, optical_radius, albedo);
    r.flame = r.density;
    r.settings.fire.convention = EmissionConvention::Direct;
    return r;
}

namespace {

const dvec3 kFromAfar = dvec3(-310.0, -930.0, 200.0);  // no symmetry of the lattice

}  // namespace

CameraSettings camera_on_ball(int pixels) {
    return camera_at(kFromAfar, dvec3(0.0), 2.4, pixels);
}

CameraSettings camera_on_centre(int pixels) {
    return camera_at(kFromAfar, dvec3(0.0), 0.1, pixels);
}

media::Recipe absorbing_slab(int nodes, double edge, double voxel_depth) {
    media::Recipe r;
    r.box = {ivec3(-12, -12, -1), ivec3(11, 11, nodes)};
    r.world_from_index = media::cubic(edge);
    r.density = [=](const ivec3& n) { return n.z >= 0 && n.z < nodes ? 1.0f : 0.0f; };
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = media::black_smoke();
    r.settings.smoke.extinction_per_metre = static_cast<float>(voxel_depth / edge);
    return r;
}

CameraSettings camera_on_slab(int nodes, double edge) {
    const dvec3 target = edge * dvec3(0.13, 0.27, 0.5 * nodes);
    return camera_at(target - edge * dvec3(0.0, 0.0, 1e4), target, 0.2 * edge, 8);
}

}  // namespace brisance::stability
