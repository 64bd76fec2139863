#include "virtual_lights/baselines.h"

#include <algorithm>

namespace brisance {

namespace {

// The settings of one preset with those of another, which has its name and its help.
TechniquePreset changed(const TechniquePreset& from, const TechniquePreset& by) {
    TechniquePreset out{by.name, by.help, from.settings};
    for (const auto& [key, value] : by.settings) {
        const auto same = std::find_if(out.settings.begin(), out.settings.end(),
                                       [&, &k = key](const auto& setting) { return setting.first == k; });
        if (same != out.settings.end())
            same->second = value;
        else
            out.settings.emplace_back(key, value);
    }
    return out;
}

}  // namespace

const std::vector<TechniquePreset>& baselines() {
    static const std::vector<TechniquePreset> differences = {
        {"rich_vsl",
         "rich virtual spherical lights",
         {{"placement", "relaxed_light_paths"}, {"flux", "gathered"}, {"kind", "sphere"}}},
        {"rich_vsl_repelled",
         "rich virtual spherical lights, begun at random and moved apart as in the source",
         {{"placement", "repelled_light_paths"}, {"flux", "gathered"}, {"kind", "sphere"}}},
        {"vsl", "virtual spherical lights", {{"kind", "sphere"}}},
        {"vsl_cone",
         "virtual spherical lights sampled by their cone",
         {{"kind", "sphere"}, {"sphere_sampling", "cone"}}},
        {"vsl_vertex",
         "virtual spherical lights sampled by the BSDF at the vertex",
         {{"kind", "sphere"}, {"sphere_sampling", "vertex"}}},
        {"vsl_light",
         "virtual spherical lights sampled by the BSDF at the light",
         {{"kind", "sphere"}, {"sphere_sampling", "light"}}},
        {"vsl_passes",
         "virtual spherical lights that shrink over four passes of new lights",
         {{"kind", "sphere"}, {"passes", "4"}}},
        {"vpl", "virtual point lights", {}},
        {"vpl_diffuse", "virtual point lights of Lambert bases alone", {{"kind", "diffuse_point"}}},
        {"vpl_compensated",
         "virtual point lights with a bounded geometry term, compensated by paths",
         {{"point_bound_of", "both_cosines"}, {"compensation", "exact"}}},
        {"vpl_screen_space",
         "the same lights, compensated by what other pixels show",
         {{"point_bound_of", "both_cosines"}, {"compensation", "screen_space"}}},
        {"vpl_lightcuts", "virtual point lights by lightcuts", {{"sampling", "lightcuts"}}},
        {"vpl_stochastic_lightcuts",
         "virtual point lights by stochastic lightcuts",
         {{"sampling", "stochastic_lightcuts"}}},
        {"vpl_rejection",
         "virtual point lights, rejected where the camera does not see them",
         {{"placement", "rejection"}}},
        {"vpl_metropolis", "Metropolis instant radiosity", {{"placement", "metropolis"}}},
        {"vpl_bidirectional",
         "bidirectional instant radiosity, with rich lights",
         {{"placement", "bidirectional"}, {"flux", "gathered"}}}};
    static const std::vector<TechniquePreset> all = [] {
        const TechniquePreset instant_radiosity{"",
                                                "",
                                                {{"placement", "light_paths"},
                                                 {"flux", "own"},
                                                 {"kind", "point"},
                                                 {"sampling", "power"},
                                                 {"path_extension", "false"},
                                                 {"sharing_radius", "0"}}};
        std::vector<TechniquePreset> out;
        for (const TechniquePreset& other : differences)
            out.push_back(changed(instant_radiosity, other));
        return out;
    }();
    return all;
}

}  // namespace brisance
