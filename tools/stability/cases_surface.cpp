// Difficult surfaces: walls against the fire, two coincident walls, walls that reflect nothing or
// everything, mirrors, and walls behind smoke that is hardly there or hides all.
#include <algorithm>
#include <cmath>

#include "stability/closed_forms.h"
#include "stability/scenes.h"

namespace brisance::stability {

namespace {

constexpr double kEdge = 0.1;  // of a slab's voxels [m]
constexpr int kNodes = 12;     // of a slab along z

QuickMaterial matt(double colour) {
    QuickMaterial m;
    m.colour = Rgb(static_cast<float>(colour));
    return m;
}

QuickMaterial mirror() {
    QuickMaterial m = matt(1.0);
    m.metallic = 1.0f;
    m.roughness = 0.0f;
    return m;
}

// Across z, `half` metres to all sides of the axis; its front looks down, toward -z.
QuickQuad ceiling(double z, double half, const QuickMaterial& material) {
    return {{dvec3(-half, -half, z), dvec3(-half, half, z), dvec3(half, half, z), dvec3(half, -half, z)}, material};
}

// Fewer virtual lights than by default: pictures are small.
Scene with_walls(Scene scene, const std::vector<QuickQuad>& walls) {
    SceneSettings set;
    set.quads = walls;
    scene.shot.virtual_lights.count = 500;
    scene.shot.virtual_lights.photons = 50000;
    return with_set(std::move(scene), set);
}

// The six walls of a room of 2 m, the first of them of its own material.
std::vector<QuickQuad> room(const QuickMaterial& first, const QuickMaterial& others) {
    std::vector<QuickQuad> walls;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) {
            QuickQuad wall;
            wall.material = walls.empty() ? first : others;
            for (int k = 0; k < 4; ++k) {
                wall.corners[k][axis] = side;
                wall.corners[k][(axis + 1) % 3] = k == 1 || k == 2 ? 1.0 : -1.0;
                wall.corners[k][(axis + 2) % 3] = k >= 2 ? 1.0 : -1.0;
            }
            walls.push_back(wall);
        }
    return walls;
}

// The room full of isothermal smoke of 2 mean free paths from wall to wall, which reaches a voxel into the walls; the
// camera within looks at the first wall and a corner.
Scene smoky_room(double albedo, const std::vector<QuickQuad>& walls) {
    media::Recipe r;
    r.box = media::cube(-9, 9);
    r.world_from_index = media::cubic(0.125);
    r.density = [](const ivec3&) { return 1.0f; };
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = media::black_smoke();
    r.settings.smoke.albedo = Rgb(static_cast<float>(albedo));
    return with_walls(scene_of(r, camera_at({-0.3, -0.4, 0.1}, {1.0, 0.7, 0.2}, 2.0, 8), 256), walls);
}

// An isothermal enclosure whose walls absorb nothing: the source function everywhere, whatever scatters.
Case furnace(const std::string& name, const QuickMaterial& first) {
    Case c;
    c.name = "surface/" + name;
    c.truth = "isothermal enclosure: the source function everywhere";
    c.tolerance = {0.05, 0.005, "light of surfaces on smoke is 1 to 2 % too dark in rooms, and more beside walls"};
    c.tolerance.limits["lighting_grid"] = {
        0.2, "smoke is dimmed in voxels that walls cut, and walls that absorb nothing return the loss many times"};
    c.scene = [=] { return smoky_room(0.8, room(first, matt(1.0))); };
    c.measure = every_pixel_is(Rgb(1.0f));
    return c;
}

Case black_walls() {
    Case c;
    c.name = "surface/black-walls";
    c.truth = "walls send nothing: SV, SM and SS are exactly 0";
    c.pictures = 1;  // 0 has no noise
    c.paths = {{"ray_lights", 2048}, {"volumetric_vpls", 2048}, {"volumetric_photons", 2048}, {"photon_density", 2048}};
    c.tolerance = {0.0, 0.0, "nothing to be found"};
    c.scene = [] { return smoky_room(0.8, room(matt(0.0), matt(0.0))); };
    c.measure = [](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        Measured worst;
        for (const char* cell : {"SV", "SM", "SS"})
            worst.error = std::max(worst.error, every_pixel_is(Rgb(0.0f), cell)(scene, frame, method, render).error);
        return worst;
    };
    c.quick = true;
    return c;
}

// Opaque fire of source function 1 that fills a wall's sky but for a hundredth of it. Its extinction rises over a
// voxel, which begins a tenth of a voxel before the wall; the camera is in between.
Case wall_at_the_fire() {
    Case c;
    c.name = "surface/wall-a-tenth-of-a-voxel-from-the-fire";
    c.truth = "reflectance times the fire's source function";
    c.tolerance = {0.05, 0.01, "the fire is 2.4 m wide, so that up to 1 % of the wall's sky is dark"};
    c.scene = [] {
        const dvec3 eye(0.013, 0.027, -1.04 * kEdge), target(0.013, 0.027, -1.1 * kEdge);
        return with_walls(scene_of(absorbing_slab(kNodes, kEdge, 10.0), camera_at(eye, target, 0.5 * kEdge, 8), 256),
                          {ceiling(-1.1 * kEdge, 1.2, matt(0.5))});
    };
    c.measure = every_pixel_is(Rgb(0.5f), "SV");
    return c;
}

Scene burning_over_floors(int floors) {
    Scene scene = scene_of(isothermal_ball(8, 5.0, 0.3), camera_at({-3.0, -6.0, 2.0}, {0.0, 0.0, -0.5}, 4.0, 8), 256);
    return with_walls(std::move(scene), std::vector<QuickQuad>(floors, ceiling(-1.5, 4.0, matt(0.5))));
}

// Which of two coincident surfaces a ray hits is chance; neither may hide the other's light.
Case touching() {
    Case c;
    c.name = "surface/two-in-one-place";
    c.truth = "the picture with one of them";
    c.tolerance = {0.02, 0.005, "virtual lights lie elsewhere"};
    c.scene = [] { return burning_over_floors(2); };
    c.measure = same_picture_as([] { return burning_over_floors(1); });
    return c;
}

// Part of the sphere that a square of side 2 `half` fills at `distance` from its middle.
double share_of_sphere(double half, double distance) {
    return std::atan(half * half / (distance * std::sqrt(2.0 * half * half + distance * distance))) / kExactPi;
}

// Smoke of 1e-6 in all before a wall of radiance 1.
Case thin_smoke_before_a_wall() {
    constexpr double albedo = 0.8, depth = 1e-6, wall = 1.3, half = 20.0;
    Case c;
    c.name = "surface/wall-behind-smoke-of-1e-6";
    c.truth = "single scattering of the wall's light, at this depth all there is (MA)";
    c.tolerance = {0.03, 0.005, "24 rays from each voxel toward the wall"};
    c.tolerance.limits["lighting_grid"] = {
        0.5, "24 points on a lamp 40 m wide, most of them far off, stand for what is 0.15 m away; pixels share voxels"};
    c.scene = [=] {
        media::Recipe r = absorbing_slab(kNodes, kEdge, depth / kNodes);
        r.flame = nullptr;
        r.settings.smoke.albedo = Rgb(static_cast<float>(albedo));
        r.settings.fire.model = FireModel::None;
        QuickMaterial glowing = matt(0.0);
        glowing.emission = Rgb(1.0f);
        return with_walls(scene_of(r, camera_on_slab(kNodes, kEdge), 256), {ceiling(wall, half, glowing)});
    };
    // Nodes reach half a voxel beyond the outermost.
    const auto along = [=](double z) { return share_of_sphere(half, wall - z); };
    const double begin = -0.5 * kEdge, end = (kNodes - 0.5) * kEdge;
    const double truth = albedo * depth * integrate(along, begin, end, 100) / (end - begin);
    c.measure = every_pixel_is(Rgb(static_cast<float>(truth)), "MA");
    c.quick = true;
    return c;
}

// A wall against the back of smoke that nothing passes.
Case thick_smoke_before_a_wall() {
    constexpr double albedo = 0.8;
    Case c;
    c.name = "surface/wall-behind-smoke-of-1e6";
    c.truth = "sqrt(1 - albedo) H(1), as if there were no wall";
    c.tolerance = {0.03, 0.005, "the hierarchy does not resolve the skin that is seen"};
    c.tolerance.limits["photon_density"] = {1.0, "few photons start in the skin, and those elsewhere never reach it"};
    c.scene = [=] {
        media::Recipe r = absorbing_slab(kNodes, kEdge, 1e6 / kNodes);
        r.settings.smoke.albedo = Rgb(static_cast<float>(albedo));
        return with_walls(scene_of(r, camera_on_slab(kNodes, kEdge), 1024),
                          {ceiling((kNodes - 0.5) * kEdge, 4.0, matt(0.9))});
    };
    c.measure = [](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        const Rgb truth(static_cast<float>(isothermal_half_space(albedo, 1.0)));
        return every_pixel_is(truth)(scene, frame, method, render);
    };
    return c;
}

}  // namespace

std::vector<Case> surface_cases() {
    return {wall_at_the_fire(),
            touching(),
            black_walls(),
            furnace("white-walls", matt(1.0)),
            furnace("mirror-and-white-walls", mirror()),
            thin_smoke_before_a_wall(),
            thick_smoke_before_a_wall()};
}

}  // namespace brisance::stability
