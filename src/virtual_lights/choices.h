// The choices that make up a technique of virtual lights, by name. All lists here are read from one table
// (technique.cpp): the keys of a shot, the methods of a report and the tests follow it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "virtual_lights/settings.h"

namespace brisance {

struct TechniqueChoice {
    std::string name;
    std::string help;  // a few words
};

// In the order of the table; the first of each is the default.
const std::vector<TechniqueChoice>& light_placements();
const std::vector<TechniqueChoice>& light_fluxes();
const std::vector<TechniqueChoice>& light_kinds();
const std::vector<TechniqueChoice>& light_gatherers();

// The values of `compensation`, in the order of the table.
struct CompensationChoice {
    std::string name;
    std::string help;  // a few words
    BoundCompensation value;
    bool needs_bound;   // a kind of light with a bound
    bool reads_pixels;  // all light of a camera sample, before light that others around it share
};
const std::vector<CompensationChoice>& light_compensations();

// "blue_noise: ...; random: ..."
std::string help_of(const std::vector<TechniqueChoice>& choices);

// A technique of the literature, as the settings that make it.
struct TechniquePreset {
    std::string name;
    std::string help;
    std::vector<std::pair<std::string, std::string>> settings;  // keys of virtual_lights, and their values
};
// Virtual blue noise lighting with every gatherer (vbnl, vbnl_GATHERER), and the baselines it is compared with.
const std::vector<TechniquePreset>& light_presets();

// Why the choices do not go together, with what would do; empty where they do. Throws Error Usage for an unknown name.
std::string why_not_together(const VirtualLightSettings& settings);

// Why something that needs lights with a bound does not go with these, with what would do; empty where it does. `what`:
// needs them; `otherwise`: goes with all. Throws Error Usage for an unknown name.
std::string why_no_bound(const VirtualLightSettings& settings, const std::string& what, const std::string& otherwise);

// Throws Error Usage for settings out of range and for choices that do not go together.
void check(const VirtualLightSettings& settings);

}  // namespace brisance
