#include "suite/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

// Of the shots' folder; all of its folder `media` follow.
constexpr std::array<const char*, 3> kScenes = {"explosion", "fire_room", "street"};

std::vector<SuiteScene> scenes_of_media(const fs::path& shots) {
    std::vector<SuiteScene> scenes;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(shots / "media", error))
        if (entry.path().extension() == ".json")
            scenes.push_back({"media/" + entry.path().stem().string(), entry.path()});
    std::sort(scenes.begin(), scenes.end(), [](const SuiteScene& a, const SuiteScene& b) { return a.name < b.name; });
    return scenes;
}

// In the order of the suite.
std::vector<SuiteScene> named(const std::vector<SuiteScene>& all, const std::vector<std::string>& names) {
    std::vector<std::string> known;
    std::vector<SuiteScene> chosen;
    for (const SuiteScene& scene : all) {
        known.push_back(scene.name);
        if (std::find(names.begin(), names.end(), scene.name) != names.end())
            chosen.push_back(scene);
    }
    for (const std::string& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw Error(ExitCode::Usage,
                        fmt::format("--scenes: no scene is called \"{}\"; there are {}", name, fmt::join(known, ", ")));
    return chosen;
}

std::string budget_of(const SuiteSize& size, const Method& method) {
    switch (method.steps_of) {
        case StepsOf::Paths:
            return size.path_samples;
        case StepsOf::Grid:
            return size.grid_steps;
        case StepsOf::Lamps:
            return size.lamps;
        case StepsOf::Directions:
            return size.cascade_sides;
        case StepsOf::Lattices:
            return size.lattice_levels;
        case StepsOf::Samples:
            break;
    }
    return size.sides;
}

// Paths between surfaces see the grid's smoke as the camera does, and walk through that of other methods, which would
// be most of the noise of SS.
constexpr const char* kSmokeOfTheGrid = "scattering.method=lighting_grid";

// What a method says of itself stays so.
void add_settings(const std::vector<std::string>& settings, Method& method) {
    for (const std::string& setting : settings)
        if (!sets(method.settings, setting.substr(0, setting.find('='))))
            method.settings.push_back(setting);
}

}  // namespace

const std::vector<SuiteSize>& suite_sizes() {
    static const std::vector<SuiteSize> all = {
        {.name = "quick",
         .help = "minutes: small pictures, few lights, coarse lattices",
         .width = 64,
         .reference_samples = 64,
         .path_samples = "4,16",
         .grid_steps = "1,2",
         .cascade_sides = "4",
         .lattice_levels = "3",
         .lamps = "4,64",
         .strip_frames = 0,
         .sides = "1",
         .settings = {"camera.edge_refinement=1", "lighting.lattice_level=3", "lighting.error=0.1", "lighting.alpha=1",
                      "scattering.lattice_level=3", "scattering.alpha=1", "virtual_lights.count=300",
                      "virtual_lights.photons=20000", "virtual_lights.neighbours=32", "ray_lights.paths=2048",
                      "ray_lights.count=8192", "volumetric_vpls.paths=4096", "volumetric_vpls.count=8192",
                      "volumetric_photons.paths=50000", "photon_density.paths=20000"},
         .beside_fire = {"lighting.lattice_level=5", "lighting.error=0.3"},
         .beside_fire_of_surfaces = {},
         .beside_scattering = {kSmokeOfTheGrid}},
        {.name = "draft",
         .help = "an hour or two: small pictures, settings of drafts",
         .width = 96,
         .reference_samples = 256,
         .path_samples = "4,16,64",
         .grid_steps = "1,2",
         .cascade_sides = "4",
         .lattice_levels = "2,1",
         .lamps = "4,64",
         .strip_frames = 3,
         .sides = "1,2",
         .settings = {"camera.edge_refinement=1", "lighting.error=0.05", "lighting.alpha=1", "scattering.alpha=1",
                      "virtual_lights.count=1500", "virtual_lights.photons=100000", "scattering.remainder=0.01"},
         .beside_fire = {"lighting.lattice_level=3", "lighting.error=0.2"},
         .beside_fire_of_surfaces = {"lighting.lattice_level=2", "lighting.error=0.1"},
         .beside_scattering = {kSmokeOfTheGrid}},
        {.name = "full",
         .help = "hours: the shots' own settings",
         .width = 160,
         .reference_samples = 4096,
         .path_samples = "4,16,64,256",
         .grid_steps = "1,2,3,4",
         .cascade_sides = "4,8,16",
         .lattice_levels = "2,1,0",
         .lamps = "4,16,64,256",
         .strip_frames = 3,
         .sides = "1,2,4",
         .settings = {},
         .beside_fire = {},
         .beside_fire_of_surfaces = {},
         .beside_scattering = {kSmokeOfTheGrid}}};
    return all;
}

const SuiteSize& suite_size(const std::string& name) {
    std::vector<std::string> names;
    for (const SuiteSize& size : suite_sizes()) {
        if (size.name == name)
            return size;
        names.push_back(size.name);
    }
    throw Error(ExitCode::Usage,
                fmt::format("--suite: no suite is called \"{}\"; there are {}", name, fmt::join(names, ", ")));
}

std::vector<Method> suite_methods(const SuiteSize& size, const std::vector<std::string>& names) {
    MethodOptions options{names.empty() ? built_in_methods() : names, {}, {}};
    for (const Method& method : parse_methods(options))
        options.budgets.push_back(method.label + ":" + budget_of(size, method));
    std::vector<Method> methods = parse_methods(options);
    for (Method& method : methods) {
        const bool scatters = owns(method, name_of(Cell::MM));
        // Paths between surfaces see the smoke of the grid, also where the camera's rays gather the fire themselves.
        if (!scatters && owns(method, name_of(Cell::SS)))
            add_settings(size.beside_fire_of_surfaces, method);
        else if (!owns(method, name_of(Cell::MV)) && !method.scatters_grid)
            add_settings(size.beside_fire, method);
        if (!scatters)
            add_settings(size.beside_scattering, method);
    }
    return methods;
}

std::vector<SuiteScene> suite_scenes(const fs::path& shots, const std::vector<std::string>& names,
                                     const std::vector<std::string>& further) {
    if (!fs::is_directory(shots))
        throw Error(ExitCode::MissingInput,
                    fmt::format("{}: no such folder; --shots names the one with the suite's shots", shots.string()));
    std::vector<SuiteScene> scenes;
    for (const char* const name : kScenes)
        scenes.push_back({name, shots / (std::string(name) + ".json")});
    for (SuiteScene& scene : scenes_of_media(shots))
        scenes.push_back(std::move(scene));
    if (!names.empty())
        scenes = named(scenes, names);
    for (const std::string& file : further)
        scenes.push_back({fs::path(file).stem().string(), file});
    return scenes;
}

std::vector<std::string> size_settings(const SuiteSize& size, int width, int height,
                                       const std::vector<std::string>& given) {
    if (sets(given, "camera.width") || sets(given, "camera.height"))
        return {};
    const long rows = std::max(1L, std::lround(double(size.width) * height / width));
    return {fmt::format("camera.width={}", size.width), fmt::format("camera.height={}", rows)};
}

}  // namespace brisance
