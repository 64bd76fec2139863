#include "shot/keys.h"

namespace brisance {

void add_virtual_light_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "virtual_lights.count", "of them; 0: none, all light from surfaces is found by paths", whole(0, 100000000),
        [](Shot & s) -> auto& { return s.virtual_lights.count; }));
    keys.push_back(make_key(
        "virtual_lights.placement", "blue_noise: from the camera, thinned out evenly; the others are for comparison",
        choice<LightPlacement>({{"blue_noise", LightPlacement::BlueNoise},
                                {"random", LightPlacement::Random},
                                {"light_paths", LightPlacement::LightPaths}}),
        [](Shot & s) -> auto& { return s.virtual_lights.placement; }));
    keys.push_back(make_key(
        "virtual_lights.kind",
        "patch: the surface itself; sphere, point: for comparison, with sampling power or light_tree, no extension",
        choice<VirtualLightKind>({{"patch", VirtualLightKind::Patch},
                                  {"sphere", VirtualLightKind::Sphere},
                                  {"point", VirtualLightKind::Point}}),
        [](Shot & s) -> auto& { return s.virtual_lights.kind; }));
    keys.push_back(make_key(
        "virtual_lights.point_bound", "of kind point: greatest cosine over squared distance; the rest is lost [1/m^2]",
        real(above(0.0)), [](Shot & s) -> auto& { return s.virtual_lights.point_bound; }));
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
        "virtual_lights.photons", "particles from fire and lights", whole(0, 2000000000),
        [](Shot & s) -> auto& { return s.virtual_lights.photons; }));
    keys.push_back(make_key(
        "virtual_lights.profile_resolution", "of directions, where surfaces are glossy: texels along a side",
        whole(1, 256), [](Shot & s) -> auto& { return s.virtual_lights.profile_resolution; }));
    keys.push_back(make_key(
        "virtual_lights.sampling", "who is asked: combined is best, the others are for comparison",
        choice<LightSampling>({{"combined", LightSampling::Combined},
                               {"combined_tree", LightSampling::CombinedTree},
                               {"power", LightSampling::Power},
                               {"light_tree", LightSampling::LightTree},
                               {"bsdf", LightSampling::Bsdf}}),
        [](Shot & s) -> auto& { return s.virtual_lights.sampling; }));
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
