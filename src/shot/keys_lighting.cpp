#include "shot/keys.h"

namespace brisance {

namespace {

void add_ray_light_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "scattering.method",
        "lighting_grid: hierarchies of scattered light; ray_lights: virtual ray lights, unbiased and noisy; "
        "point_lights: volumetric virtual point lights; particles: counted along their ways and where they land; auto: "
        "particles for boxes of haze alone that scatter forward, else the grid",
        choice<ScatteringMethod>({{"auto", ScatteringMethod::Automatic},
                                  {"lighting_grid", ScatteringMethod::LightingGrid},
                                  {"ray_lights", ScatteringMethod::RayLights},
                                  {"point_lights", ScatteringMethod::PointLights},
                                  {"particles", ScatteringMethod::Particles}}),
        [](Shot & s) -> auto& { return s.ray_lights.method; }));
    keys.push_back(make_key(
        "ray_lights.paths", "particles whose flights through the smoke become ray lights", whole(1, 100000000),
        [](Shot & s) -> auto& { return s.ray_lights.paths; }));
    keys.push_back(make_key(
        "ray_lights.count", "pieces of their flights that are kept, on average: the important ones",
        whole(1, 100000000), [](Shot & s) -> auto& { return s.ray_lights.count; }));
    keys.push_back(make_key(
        "ray_lights.samples", "ray lights asked by every ray of the camera, and by every surface it meets",
        whole(1, 65536), [](Shot & s) -> auto& { return s.ray_lights.samples; }));
    keys.push_back(make_key(
        "ray_lights.length", "short: to the particle's next collision; long: to where the smoke or a surface ends it",
        choice<RayLength>({{"short", RayLength::Short}, {"long", RayLength::Long}}),
        [](Shot & s) -> auto& { return s.ray_lights.length; }));
    keys.push_back(make_key(
        "ray_lights.seed", "another number gives other rays", whole(0, 2147483647),
        [](Shot & s) -> auto& { return s.ray_lights.seed; }));
    keys.push_back(make_key(
        "ray_lights.radius",
        "of beams in the first pass [m]: a blur that lowers the noise of sharp lobes; 0: none, without bias; "
        "auto: from how far the lights are apart",
        or_word(real(at_least(0.0)), "auto", kAutomaticRadius), [](Shot & s) -> auto& { return s.ray_lights.radius; }));
    keys.push_back(make_key(
        "ray_lights.passes", "whole pictures that are averaged, each by ray lights of its own and thinner beams",
        whole(1, 65536), [](Shot & s) -> auto& { return s.ray_lights.passes; }));
    keys.push_back(make_key(
        "ray_lights.shrink",
        "of beams from pass to pass: alpha of r^2 (i + alpha) / (i + 1); small ones lose their blur sooner",
        real({0.0, 1.0, true, true}), [](Shot & s) -> auto& { return s.ray_lights.shrink; }));
}

void add_point_light_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "point_lights.paths", "particles whose collisions in the smoke become point lights", whole(1, 100000000),
        [](Shot & s) -> auto& { return s.point_lights.paths; }));
    keys.push_back(make_key(
        "point_lights.count", "collisions that are kept, on average: the important ones", whole(1, 100000000),
        [](Shot & s) -> auto& { return s.point_lights.count; }));
    keys.push_back(make_key(
        "point_lights.samples", "point lights asked by every ray of the camera, and by every surface it meets",
        whole(1, 65536), [](Shot & s) -> auto& { return s.point_lights.samples; }));
    keys.push_back(make_key(
        "point_lights.bound_per_metre2",
        "the most that 1 / distance^2 to a light may be [1/m^2]; 0: unbounded; auto: from the smoke and `paths`",
        or_word(real(at_least(0.0)), "auto", kAutomaticBound), [](Shot & s) -> auto& { return s.point_lights.bound; }));
    keys.push_back(make_key(
        "point_lights.compensation",
        "of what the bound takes away. none: lost; exact: found by paths, unbiased; local: guessed as if the smoke "
        "around every place were alike",
        choice<BiasCompensation>(
            {{"none", BiasCompensation::None}, {"exact", BiasCompensation::Exact}, {"local", BiasCompensation::Local}}),
        [](Shot & s) -> auto& { return s.point_lights.compensation; }));
    keys.push_back(make_key(
        "point_lights.compensation_samples", "of it, on every ray of the camera and at every surface it meets",
        whole(1, 65536), [](Shot & s) -> auto& { return s.point_lights.compensation_samples; }));
    keys.push_back(make_key(
        "point_lights.seed", "another number gives other lights", whole(0, 2147483647),
        [](Shot & s) -> auto& { return s.point_lights.seed; }));
}

void add_particle_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "particles.paths", "particles that are followed through smoke and surfaces", whole(1, 1000000000),
        [](Shot & s) -> auto& { return s.particles.paths; }));
    keys.push_back(make_key(
        "particles.neighbours", "particles that land around a point of a surface and tell how much arrives there",
        whole(1, 65536), [](Shot & s) -> auto& { return s.particles.neighbours; }));
    keys.push_back(make_key(
        "particles.seed", "another number gives other particles", whole(0, 2147483647),
        [](Shot & s) -> auto& { return s.particles.seed; }));
}

}  // namespace

void add_lighting_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "lighting.alpha", "a light of level l serves up to about alpha spacings of its level: larger is more exact",
        real_float({1.0, 64.0}), [](Shot & s) -> auto& { return s.lighting.alpha; }));
    keys.push_back(make_key(
        "lighting.levels", "of the hierarchy above the voxels; auto: from the volume's extent",
        or_word(whole(1, 24), "auto", 0), [](Shot & s) -> auto& { return s.lighting.levels; }));
    keys.push_back(make_key(
        "lighting.shadows", "maps: precomputed; exact: per light and point, slow; none: for study",
        choice<ShadowMethod>(
            {{"maps", ShadowMethod::Maps}, {"exact", ShadowMethod::Exact}, {"none", ShadowMethod::None}}),
        [](Shot & s) -> auto& { return s.lighting.shadows; }));
    keys.push_back(make_key(
        "lighting.shadow_resolution", "texels along one side of a light's octahedral map", whole(2, 256),
        [](Shot & s) -> auto& { return s.lighting.shadow_resolution; }));
    keys.push_back(make_key(
        "lighting.shadow_distances", "transmittance samples along a texel's ray", whole(2, 256),
        [](Shot & s) -> auto& { return s.lighting.shadow_distances; }));
    keys.push_back(make_key(
        "lighting.memory_limit_mebibytes",
        "for shadow maps [MiB]; their resolution is lowered to respect it, with a notice", mebibytes(1.0, 16777216.0),
        [](Shot & s) -> auto& { return s.lighting.memory_limit_bytes; }));
    keys.push_back(make_key(
        "lighting.gather", "cache: in-scattered light on a lattice; ray_march: at every sample, slow",
        choice<GatherMethod>({{"cache", GatherMethod::Cache}, {"ray_march", GatherMethod::RayMarch}}),
        [](Shot & s) -> auto& { return s.lighting.gather; }));
    keys.push_back(make_key(
        "lighting.energy_balance", "scale each bounce so that emitted = collided + escaped", flag(),
        [](Shot & s) -> auto& { return s.lighting.energy_balance; }));
    keys.push_back(make_key(
        "scattering.bounces", "0: emission only, 1: single scattering, all: until the remainder",
        or_word(whole(0, 10000), "all", -1), [](Shot & s) -> auto& { return s.scattering.bounces; }));
    keys.push_back(make_key(
        "scattering.remainder", "with all bounces: the share of the light that may be left over",
        real_float({0.0, 1.0, true, true}), [](Shot & s) -> auto& { return s.scattering.remainder; }));
    keys.push_back(make_key(
        "scattering.lattice_level", "bounces above one are solved on voxels 2^n wide",
        or_word(whole(0, 16), "auto", -1), [](Shot & s) -> auto& { return s.scattering.lattice_level; }));
    keys.push_back(make_key(
        "scattering.alpha", "as lighting.alpha, for scattered light", real_float({1.0, 64.0}),
        [](Shot & s) -> auto& { return s.scattering.alpha; }));
    add_ray_light_keys(keys);
    add_point_light_keys(keys);
    add_particle_keys(keys);
}

}  // namespace brisance
