#include "shot/keys.h"

namespace brisance {

void add_virtual_light_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "virtual_lights.count", "of them, of flux own about; 0: none, all light from surfaces is found by paths",
        whole(0, 100000000), [](Shot & s) -> auto& { return s.virtual_lights.count; }));
    keys.push_back(make_key(
        "virtual_lights.placement", "blue_noise: from the camera, thinned out evenly; the others are for comparison",
        choice<LightPlacement>({{"blue_noise", LightPlacement::BlueNoise},
                                {"random", LightPlacement::Random},
                                {"light_paths", LightPlacement::LightPaths},
                                {"relaxed_light_paths", LightPlacement::RelaxedLightPaths}}),
        [](Shot & s) -> auto& { return s.virtual_lights.placement; }));
    keys.push_back(make_key(
        "virtual_lights.flux",
        "gathered: of all photons around; own: of the one that placed the light, with placement light_paths, not patch",
        choice<LightFlux>({{"gathered", LightFlux::Gathered}, {"own", LightFlux::Own}}),
        [](Shot & s) -> auto& { return s.virtual_lights.flux; }));
    keys.push_back(make_key(
        "virtual_lights.kind",
        "patch: the surface itself; sphere, point: for comparison, with sampling not by rays and without extension",
        choice<VirtualLightKind>({{"patch", VirtualLightKind::Patch},
                                  {"sphere", VirtualLightKind::Sphere},
                                  {"point", VirtualLightKind::Point}}),
        [](Shot & s) -> auto& { return s.virtual_lights.kind; }));
    keys.push_back(make_key(
        "virtual_lights.point_bound", "of kind point: greatest cosine over squared distance; the rest is lost [1/m^2]",
        real(above(0.0)), [](Shot & s) -> auto& { return s.virtual_lights.point_bound; }));
    keys.push_back(make_key(
        "virtual_lights.sphere_neighbours", "of kind sphere: its radius is the distance to the light that is this near",
        whole(1, 100000), [](Shot & s) -> auto& { return s.virtual_lights.sphere_neighbours; }));
    keys.push_back(make_key(
        "virtual_lights.sphere_samples", "of kind sphere: directions into one that is asked", whole(1, 65536),
        [](Shot & s) -> auto& { return s.virtual_lights.sphere_samples; }));
    keys.push_back(make_key(
        "virtual_lights.candidates_per_pixel", "camera paths to choose places from; at least eight to a light",
        real({0.0, 1024.0}), [](Shot & s) -> auto& { return s.virtual_lights.candidates_per_pixel; }));
    keys.push_back(make_key(
        "virtual_lights.radius", "adaptive: small where the camera looks; uniform: for comparison",
        choice<LightRadius>({{"adaptive", LightRadius::Adaptive}, {"uniform", LightRadius::Uniform}}),
        [](Shot & s) -> auto& { return s.virtual_lights.radius; }));
    keys.push_back(make_key(
        "virtual_lights.neighbours", "candidates from whose distance their density is taken", whole(1, 100000),
        [](Shot & s) -> auto& { return s.virtual_lights.neighbours; }));
    keys.push_back(make_key(
        "virtual_lights.radius_factor", "a light's radius over the distance that it keeps from others",
        real({0.0, 100.0, true}), [](Shot & s) -> auto& { return s.virtual_lights.radius_factor; }));
    keys.push_back(make_key(
        "virtual_lights.photons", "particles from fire and lights, of flux gathered; 0: no virtual lights",
        whole(0, 2000000000), [](Shot & s) -> auto& { return s.virtual_lights.photons; }));
    keys.push_back(make_key(
        "virtual_lights.profile_resolution", "of directions, where surfaces are glossy: texels along a side",
        whole(1, 256), [](Shot & s) -> auto& { return s.virtual_lights.profile_resolution; }));
    keys.push_back(make_key(
        "virtual_lights.sampling", "who is asked: combined is best, the others are for comparison",
        choice<LightSampling>({{"combined", LightSampling::Combined},
                               {"combined_tree", LightSampling::CombinedTree},
                               {"power", LightSampling::Power},
                               {"light_tree", LightSampling::LightTree},
                               {"bsdf", LightSampling::Bsdf},
                               {"resampled", LightSampling::Resampled},
                               {"all", LightSampling::All}}),
        [](Shot & s) -> auto& { return s.virtual_lights.sampling; }));
    keys.push_back(make_key(
        "virtual_lights.resampling_candidates", "of sampling resampled: lights to choose one from", whole(1, 65536),
        [](Shot & s) -> auto& { return s.virtual_lights.resampling_candidates; }));
    keys.push_back(make_key(
        "virtual_lights.extension", "camera paths go on where a ray's footprint covers few lights", flag(),
        [](Shot & s) -> auto& { return s.virtual_lights.extension; }));
    keys.push_back(make_key(
        "virtual_lights.n_min", "lights in the footprint: with fewer the path goes on", real(at_least(0.0)),
        [](Shot & s) -> auto& { return s.virtual_lights.n_min; }));
    keys.push_back(make_key(
        "virtual_lights.n_max", "with more it ends; between them it does both in part", real(at_least(0.0)),
        [](Shot & s) -> auto& { return s.virtual_lights.n_max; }));
    keys.push_back(make_key(
        "virtual_lights.seed", "other seeds draw other random numbers", whole(0, 2147483647),
        [](Shot & s) -> auto& { return s.virtual_lights.seed; }));
}

}  // namespace brisance
