// Lattices that are hardly three-dimensional: needles, one plane of voxels, one voxel.
#include <cmath>

#include "stability/closed_forms.h"
#include "stability/scenes.h"

namespace brisance::stability {

namespace {

using glm::ivec2;

constexpr int kNeedles = 8;  // along a side of their bundle

// Voxels of 0.1 x 0.1 x 100 m: a square column of isothermal smoke. Its source reaches one node beyond the smoke.
media::Recipe needles(double albedo) {
    media::Recipe r;
    r.box = {ivec3(-kNeedles / 2 - 1, -kNeedles / 2 - 1, -2), ivec3(kNeedles / 2, kNeedles / 2, 2)};
    r.world_from_index = media::transform(dmat3(dvec3(0.1, 0, 0), dvec3(0, 0.1, 0), dvec3(0, 0, 100.0)), dvec3(0.0));
    r.density = [](const ivec3& n) {
        const ivec2 across(n.x, n.y);
        return glm::all(glm::greaterThanEqual(across, ivec2(-kNeedles / 2))) &&
                       glm::all(glm::lessThan(across, ivec2(kNeedles / 2))) && std::abs(n.z) < 2
                   ? 1.0f
                   : 0.0f;
    };
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = media::black_smoke();
    r.settings.smoke.extinction_per_metre = 2.0f;
    r.settings.smoke.albedo = Rgb(static_cast<float>(albedo));
    return r;
}

Case needles_absorbing() {
    Case c;
    c.name = "lattice/1:1:1000-absorbing";
    c.truth = "1 - exp(-8 tau)";
    c.scatters_twice = false;
    c.tolerance = {3e-5, 3e-5, "single precision; rays may end at a transmittance of 1e-5"};
    c.scene = [] { return scene_of(needles(0.0), camera_at({0.013, -100.0, 3.0}, {0.013, 0.0, 3.0}, 0.5, 8), 64); };
    c.measure = every_pixel_is(Rgb(static_cast<float>(one_minus_transmittance(kNeedles * 0.2))));
    c.quick = true;
    return c;
}

Case needles_scattering() {
    Case c;
    c.name = "lattice/1:1:1000-scattering";
    c.truth = "path tracer";
    c.tolerance = {0.05, 0.005, "lights are points, voxels are needles"};
    c.scene = [] { return scene_of(needles(0.8), camera_at({30.0, -100.0, 3.0}, {0.0, 0.0, 3.0}, 1.2, 16), 64); };
    c.measure = like_the_reference(256);
    return c;
}

// Sheets of one layer of nodes: whatever the profile across, a slab of optical depth 1 (adding-doubling tables).
Case plane(const std::string& name, double albedo, double truth, double lattice_tolerance) {
    Case c;
    c.name = "lattice/plane-" + name;
    c.truth = "isothermal slab of optical depth 1 seen along its normal";
    c.scatters_twice = albedo > 0.0;
    c.tolerance = {
        lattice_tolerance, 0.005,
        albedo > 0.0 ? "one node samples the sheet's whole thickness" : "single precision; two Gauss points to a cell"};
    c.scene = [=] {
        media::Recipe r;
        r.box = {ivec3(-24, -24, -1), ivec3(24, 24, 1)};
        r.world_from_index = media::cubic(0.1);
        r.density = [](const ivec3& n) { return n.z == 0 ? 1.0f : 0.0f; };
        r.flame = [](const ivec3&) { return 1.0f; };
        r.settings = media::black_smoke();
        r.settings.smoke.extinction_per_metre = 10.0f;
        r.settings.smoke.albedo = Rgb(static_cast<float>(albedo));
        return scene_of(r, camera_at({0.0, 0.0, 1000.0}, dvec3(0.0), 0.4, 8), 512);
    };
    c.measure = every_pixel_is(Rgb(static_cast<float>(truth)));
    c.quick = true;
    return c;
}

media::Recipe single_voxel(double depth, double albedo) {
    media::Recipe r;
    r.box = media::cube(-1, 1);
    r.world_from_index = media::cubic(0.1);
    r.density = [](const ivec3& n) { return n == ivec3(0) ? 1.0f : 0.0f; };
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = media::black_smoke();
    r.settings.smoke.extinction_per_metre = static_cast<float>(depth / 0.1);
    r.settings.smoke.albedo = Rgb(static_cast<float>(albedo));
    return r;
}

Case voxel_absorbing(double depth) {
    Case c;
    c.name = depth > 100.0 ? "lattice/one-voxel-opaque" : "lattice/one-voxel-absorbing";
    c.truth = "1 - exp(-tau), tau the column through the hat";
    c.scatters_twice = false;
    c.tolerance = {1e-3, 1e-3, "rays as far as a hundredth of a voxel from the axis"};
    c.scene = [=] { return scene_of(single_voxel(depth, 0.0), camera_at({0.0, 0.0, 100.0}, dvec3(0.0), 1e-4, 8), 64); };
    c.measure = every_pixel_is(Rgb(static_cast<float>(one_minus_transmittance(depth))));
    c.quick = true;
    return c;
}

Case voxel_scattering() {
    Case c;
    c.name = "lattice/one-voxel-scattering";
    c.truth = "path tracer";
    c.tolerance = {0.1, 0.005, "one node is all the light there is"};
    c.scene = [] { return scene_of(single_voxel(1.0, 0.8), camera_at({30.0, 10.0, 100.0}, dvec3(0.0), 0.3, 16), 128); };
    c.measure = like_the_reference(512);
    c.quick = true;
    return c;
}

}  // namespace

std::vector<Case> lattice_cases() {
    // Emissivities 1 - R - T of the slab of optical depth 1 at normal view, adding-doubling with 16 Gauss angles.
    return {needles_absorbing(),
            needles_scattering(),
            plane("absorbing", 0.0, one_minus_transmittance(1.0), 3e-5),
            plane("scattering-0.5", 0.5, 0.45482, 0.05),
            plane("scattering-0.9", 0.9, 0.14096, 0.05),
            voxel_absorbing(1.0),
            voxel_absorbing(1e6),
            voxel_scattering()};
}

}  // namespace brisance::stability
