#include "built_in_methods.h"

#include <algorithm>
#include <utility>

#include "fire_lights/samplings.h"
#include "scattering_methods/methods.h"
#include "unified_lights/samplings.h"
#include "virtual_lights/choices.h"

namespace brisance {
namespace {

const CellSet kAllCells = {Cell::V,  Cell::A,  Cell::MV, Cell::MM, Cell::MS,
                           Cell::MA, Cell::SV, Cell::SM, Cell::SS, Cell::SA};
// All but the light that surfaces scatter, which virtual lights carry also where the grid has everything else.
const CellSet kCellsOfGrid = {Cell::V, Cell::A, Cell::MV, Cell::MM, Cell::MA, Cell::SV, Cell::SM, Cell::SA};
// Light that lamps in the place of the fire send out, or that began as theirs.
const CellSet kCellsOfLamps = {Cell::MV, Cell::MM, Cell::SV, Cell::SM};
const CellSet kCellsOfScatteringMethods = {Cell::MM, Cell::SM};
const CellSet kCellsOfVirtualLights = {Cell::MS, Cell::SS};

// Virtual lights by the settings of a preset.
BuiltIn by_virtual_lights(const TechniquePreset& preset) {
    BuiltIn method{preset.name, {"method=lighting_grid"}, StepsOf::Samples, kCellsOfVirtualLights};
    method.by_default = preset.settings.empty();
    for (const auto& [key, value] : preset.settings)
        method.settings.push_back("virtual_lights." + key + "=" + value);
    return method;
}

// Every way to choose among the lights of the fire that a suite can wait for.
void add_fire_lights(std::vector<BuiltIn>& methods) {
    for (const FireLightSampling& row : fire_light_samplings())
        if (!row.asks_every_light)
            methods.push_back({std::string("fire_") + row.name,
                               {"method=lighting_grid", "scattering.method=lighting_grid",
                                std::string("fire_lights.sampling=") + row.name},
                               StepsOf::Samples,
                               {Cell::MV, Cell::SV}});
}

// Every way to choose among lights of all kinds together that a suite can wait for, with the lights of instant
// radiosity.
void add_unified_lights(std::vector<BuiltIn>& methods) {
    const auto& presets = light_presets();
    const auto lights = std::find_if(presets.begin(), presets.end(), [](const auto& p) { return p.name == "vpl"; });
    for (const UnifiedLightSampling& row : unified_light_samplings()) {
        if (row.asks_every_light)
            continue;
        BuiltIn method = by_virtual_lights(*lights);
        method.name = std::string("unified_") + row.name;
        method.settings.insert(method.settings.end(),
                               {"scattering.method=lighting_grid", std::string("unified_lights.sampling=") + row.name});
        method.cells = {Cell::MV, Cell::MS, Cell::MA, Cell::SV, Cell::SS, Cell::SA};
        methods.push_back(std::move(method));
    }
}

// The presets of all scattering methods.
void add_scattering_methods(std::vector<BuiltIn>& methods) {
    for (const ScatteringMethod& method : scattering_methods())
        for (const MethodPreset& preset : method.presets) {
            BuiltIn built_in{preset.label,
                             {"method=lighting_grid", "scattering.method=" + method.name},
                             StepsOf::Samples,
                             kCellsOfScatteringMethods};
            for (const std::string& setting : preset.settings)
                built_in.settings.push_back(method.name + "." + setting);
            methods.push_back(std::move(built_in));
        }
}

std::vector<BuiltIn> make_built_ins() {
    std::vector<BuiltIn> methods = {
        {"lighting_grid",
         {"method=lighting_grid", "scattering.method=lighting_grid"},
         StepsOf::Grid,
         kCellsOfGrid,
         false,
         true},
        {"path", {"method=path"}, StepsOf::Paths, kAllCells, true},
        {"path_plain",
         {"method=path", "tracing.emission=collision", "tracing.light_sampling=false",
          "tracing.free_flight=null_collision"},
         StepsOf::Paths,
         kAllCells,
         true},
        {"path_filtered", {"method=path", "tracing.denoising_radius=5"}, StepsOf::Paths, kAllCells},
        {"fire_clusters", {"method=lighting_grid", "scattering.method=lighting_grid"}, StepsOf::Lamps, kCellsOfLamps},
        {"radiance_cascades",
         {"method=lighting_grid", "scattering.method=lighting_grid", "scattering.solver=radiance_cascades"},
         StepsOf::Directions,
         kCellsOfScatteringMethods,
         false,
         false,
         true},
        {"diffusion",
         {"method=lighting_grid", "scattering.method=lighting_grid", "scattering.solver=diffusion"},
         StepsOf::Lattices,
         kCellsOfScatteringMethods,
         false,
         false,
         true}};
    add_fire_lights(methods);
    add_unified_lights(methods);
    add_scattering_methods(methods);
    return methods;
}

}  // namespace

const std::vector<BuiltIn>& built_ins() {
    static const std::vector<BuiltIn> all = [] {
        std::vector<BuiltIn> out = make_built_ins();
        for (const TechniquePreset& preset : light_presets())
            out.push_back(by_virtual_lights(preset));
        return out;
    }();
    return all;
}

}  // namespace brisance
