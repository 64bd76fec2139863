#include "shot/keys/keys.h"
#include "virtual_lights/choices.h"

namespace brisance {

namespace {

// One of the names in the table of techniques.
Codec<std::string> name_in(const std::vector<TechniqueChoice>& choices) {
    std::vector<std::pair<std::string, std::string>> words;
    words.reserve(choices.size());
    for (const TechniqueChoice& c : choices)
        words.emplace_back(c.name, c.name);
    return choice(words);
}

// One of the names; shots from before there were several say true or false, for exact and none.
Codec<BoundCompensation> compensation() {
    std::vector<std::pair<std::string, BoundCompensation>> words;
    for (const CompensationChoice& c : light_compensations())
        words.emplace_back(c.name, c.value);
    const Codec<BoundCompensation> named = choice(words);
    Codec<BoundCompensation> out = named;
    out.expected = named.expected + ", true (exact) or false (none)";
    out.schema = {{"anyOf", Json::array({named.schema, flag().schema})}};
    out.read = [named](const Json& json) -> std::optional<BoundCompensation> {
        if (const std::optional<bool> exact = flag().read(json))
            return *exact ? BoundCompensation::Exact : BoundCompensation::None;
        return named.read(json);
    };
    return out;
}

std::string help_of_compensation() {
    std::string out = "for kind point, of the light that the bound takes away";
    for (const CompensationChoice& c : light_compensations())
        out += "; " + c.name + ": " + c.help;
    return out;
}

Codec<int> whole_in(const SettingRange<int>& range) {
    return whole(range.low, range.high);
}

Codec<double> real_in(const SettingRange<double>& range) {
    return real(Range{range.low, range.high, range.without_low});
}

using Ranges = VirtualLightRanges;

void add_choice_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "virtual_lights.placement", help_of(light_placements()), name_in(light_placements()),
        [](Shot & s) -> auto& { return s.virtual_lights.placement; }));
    keys.push_back(make_key(
        "virtual_lights.flux", help_of(light_fluxes()), name_in(light_fluxes()),
        [](Shot & s) -> auto& { return s.virtual_lights.flux; }));
    keys.push_back(make_key(
        "virtual_lights.kind", help_of(light_kinds()), name_in(light_kinds()),
        [](Shot & s) -> auto& { return s.virtual_lights.kind; }));
}

void add_kind_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "virtual_lights.point_bound",
        "for kind point: upper bound on cosine over squared distance; the rest is lost [1/m^2]",
        real_in(Ranges::point_bound), [](Shot & s) -> auto& { return s.virtual_lights.point_bound; }));
    keys.push_back(make_key(
        "virtual_lights.point_bound_of",
        "light_cosine: the bound is on the light's cosine over squared distance; both_cosines: on the whole geometry "
        "term",
        choice<BoundedTerm>({{"light_cosine", BoundedTerm::LightCosine}, {"both_cosines", BoundedTerm::BothCosines}}),
        [](Shot & s) -> auto& { return s.virtual_lights.point_bound_of; }));
    keys.push_back(make_key(
        "virtual_lights.contribution_bound",
        "for kind point: upper bound on the luminance that one light adds where it shines, before it is weighted by "
        "how it was chosen; the rest is lost [W/(m^2 sr)]; none: no bound",
        or_word(real_in(Ranges::contribution_bound), "none", kUnbounded),
        [](Shot & s) -> auto& { return s.virtual_lights.contribution_bound; }));
    keys.push_back(make_key(
        "virtual_lights.compensation", help_of_compensation(), compensation(),
        [](Shot & s) -> auto& { return s.virtual_lights.compensation; }));
    keys.push_back(make_key(
        "virtual_lights.sphere_neighbours",
        "for kind sphere: its radius is the distance to the neighbour of this number",
        whole_in(Ranges::sphere_neighbours), [](Shot & s) -> auto& { return s.virtual_lights.sphere_neighbours; }));
    keys.push_back(make_key(
        "virtual_lights.sphere_shrinking",
        "for kind sphere: alpha of radius^2 (i + alpha) / (i + 1) from pass to pass; small values lose the blur "
        "sooner, "
        "1: it stays",
        real_in(Ranges::sphere_shrinking), [](Shot & s) -> auto& { return s.virtual_lights.sphere_shrinking; }));
    keys.push_back(make_key(
        "virtual_lights.sphere_samples", "for kind sphere: directions sampled for each light",
        whole_in(Ranges::sphere_samples), [](Shot & s) -> auto& { return s.virtual_lights.sphere_samples; }));
    keys.push_back(make_key(
        "virtual_lights.sphere_sampling",
        "for kind sphere: by its cone, by the BSDF at the vertex, by that at the light, or combined; sampling "
        "resampled "
        "takes the cone",
        choice<SphereSampling>({{"combined", SphereSampling::Combined},
                                {"cone", SphereSampling::Cone},
                                {"vertex", SphereSampling::Vertex},
                                {"light", SphereSampling::Light}}),
        [](Shot & s) -> auto& { return s.virtual_lights.sphere_sampling; }));
}

void add_placement_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "virtual_lights.candidates_per_pixel",
        "camera paths that place lights, per pixel; at least eight for each light",
        real_in(Ranges::candidates_per_pixel),
        [](Shot & s) -> auto& { return s.virtual_lights.candidates_per_pixel; }));
    keys.push_back(make_key(
        "virtual_lights.importance_floor",
        "for placements rejection and metropolis: what a light counts as of the mean contribution, even unseen",
        real_in(Ranges::importance_floor), [](Shot & s) -> auto& { return s.virtual_lights.importance_floor; }));
    keys.push_back(make_key(
        "virtual_lights.radius", "adaptive: small where the camera looks; uniform: for comparison",
        choice<LightRadius>({{"adaptive", LightRadius::Adaptive}, {"uniform", LightRadius::Uniform}}),
        [](Shot & s) -> auto& { return s.virtual_lights.radius; }));
    keys.push_back(make_key(
        "virtual_lights.neighbours", "candidates from whose distance their density is estimated",
        whole_in(Ranges::neighbours), [](Shot & s) -> auto& { return s.virtual_lights.neighbours; }));
    keys.push_back(make_key(
        "virtual_lights.radius_factor", "a light's radius over the distance that it keeps from others",
        real_in(Ranges::radius_factor), [](Shot & s) -> auto& { return s.virtual_lights.radius_factor; }));
    keys.push_back(make_key(
        "virtual_lights.photons",
        "particles from fire and lamps, for flux gathered; 0: no virtual lights; auto: as many as lighting.error asks "
        "of each light, from one to eight million at most, by the size of the picture",
        or_word(whole_in(Ranges::photons), "auto", kAutomaticPhotons),
        [](Shot & s) -> auto& { return s.virtual_lights.photons; }));
    keys.push_back(make_key(
        "virtual_lights.profile_resolution", "of directions, where surfaces are glossy: texels along a side",
        whole_in(Ranges::profile_resolution), [](Shot & s) -> auto& { return s.virtual_lights.profile_resolution; }));
}

void add_sharing_key(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "virtual_lights.sharing_radius",
        "pixels share light between matt surfaces, of even skies on them, and all that rough lobes reflect: how far, "
        "over the distance to surfaces around; 0: none does, and single bright samples are not divided among pixels "
        "either",
        real_in(Ranges::sharing_radius), [](Shot & s) -> auto& { return s.virtual_lights.sharing_radius; }));
}

void add_cut_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "virtual_lights.lightcuts_error", "for sampling lightcuts: what a node of the cut may err, over the sum of all",
        real_in(Ranges::lightcuts_error), [](Shot & s) -> auto& { return s.virtual_lights.lightcuts_error; }));
    keys.push_back(make_key(
        "virtual_lights.lightcuts_most", "for sampling lightcuts: the most nodes of a cut",
        whole_in(Ranges::lightcuts_most), [](Shot & s) -> auto& { return s.virtual_lights.lightcuts_most; }));
    keys.push_back(make_key(
        "virtual_lights.stochastic_cut_size", "for sampling stochastic_lightcuts: nodes of the cut, one light of each",
        whole_in(Ranges::stochastic_cut_size), [](Shot & s) -> auto& { return s.virtual_lights.stochastic_cut_size; }));
}

void add_resampling_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "virtual_lights.resampling_candidates",
        "for sampling resampled and resampled_combined: lights of which one is chosen",
        whole_in(Ranges::resampling_candidates),
        [](Shot & s) -> auto& { return s.virtual_lights.resampling_candidates; }));
    keys.push_back(make_key(
        "virtual_lights.resampling_rays", "for sampling resampled_combined: rays by BSDF beside those lights",
        whole_in(Ranges::resampling_rays), [](Shot & s) -> auto& { return s.virtual_lights.resampling_rays; }));
    keys.push_back(make_key(
        "virtual_lights.resampling_neighbours",
        "for sampling resampled and resampled_combined: camera samples around whose chosen lights are reused; 0: none",
        whole_in(Ranges::resampling_neighbours),
        [](Shot & s) -> auto& { return s.virtual_lights.resampling_neighbours; }));
    keys.push_back(make_key(
        "virtual_lights.resampling_radius", "for resampling_neighbours: how far they may lie [pixels]",
        real_in(Ranges::resampling_radius), [](Shot & s) -> auto& { return s.virtual_lights.resampling_radius; }));
    keys.push_back(make_key(
        "virtual_lights.resampling_rounds",
        "for resampling_neighbours: rounds of reuse, each of what the one before has kept, with other neighbours",
        whole_in(Ranges::resampling_rounds), [](Shot & s) -> auto& { return s.virtual_lights.resampling_rounds; }));
    keys.push_back(make_key(
        "virtual_lights.resampling_visibility",
        "for resampling_neighbours: lights are reused only where the sample that chose them sees them", flag(),
        [](Shot & s) -> auto& { return s.virtual_lights.resampling_visibility; }));
    keys.push_back(make_key(
        "virtual_lights.resampling_transmittance",
        "for sampling resampled and resampled_combined: lights are chosen by what a coarse medium lets through", flag(),
        [](Shot & s) -> auto& { return s.virtual_lights.resampling_transmittance; }));
}

void add_gathering_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "virtual_lights.sampling", help_of(light_gatherers()), name_in(light_gatherers()),
        [](Shot & s) -> auto& { return s.virtual_lights.sampling; }));
    keys.push_back(make_key(
        "virtual_lights.light_samples",
        "for sampling power, plain_power, uniform and light_tree: lights sampled at every vertex",
        whole_in(Ranges::light_samples), [](Shot & s) -> auto& { return s.virtual_lights.light_samples; }));
    add_sharing_key(keys);
    add_cut_keys(keys);
    add_resampling_keys(keys);
    keys.push_back(make_key(
        "virtual_lights.path_extension", "camera paths continue where a ray's footprint covers few lights", flag(),
        [](Shot & s) -> auto& { return s.virtual_lights.path_extension; }));
    keys.push_back(make_key(
        "virtual_lights.n_min", "lights in the footprint: with fewer the path continues", real_in(Ranges::n_min),
        [](Shot & s) -> auto& { return s.virtual_lights.n_min; }));
    keys.push_back(make_key(
        "virtual_lights.n_max", "with more it ends; between them it does both in part", real_in(Ranges::n_max),
        [](Shot & s) -> auto& { return s.virtual_lights.n_max; }));
    keys.push_back(make_key(
        "virtual_lights.seed", "other seeds draw other random numbers", whole(0, 2147483647),
        [](Shot & s) -> auto& { return s.virtual_lights.seed; }));
}

}  // namespace

void add_virtual_light_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "virtual_lights.count", "about how many; 0: none, all light from surfaces is found by paths",
        whole_in(Ranges::count), [](Shot & s) -> auto& { return s.virtual_lights.count; }));
    keys.push_back(make_key(
        "virtual_lights.passes",
        "whole pictures that are averaged, each by virtual lights of its own; spheres shrink from one to the next",
        whole_in(Ranges::passes), [](Shot & s) -> auto& { return s.virtual_lights.passes; }));
    keys.push_back(make_key(
        "virtual_lights.window",
        "in sequences: frames from one set of positions to the next, between which lights fade; 0: each frame has its "
        "own [frames]",
        whole_in(Ranges::window), [](Shot & s) -> auto& { return s.virtual_lights.window; }));
    add_choice_keys(keys);
    add_kind_keys(keys);
    add_placement_keys(keys);
    add_gathering_keys(keys);
}

}  // namespace brisance
