// The comparison of all methods on a fixed list of scenes: `brisance report --suite`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "methods.h"

namespace brisance {

// How large a suite is. All that decides its cost stands here.
struct SuiteSize {
    std::string name;
    std::string help;
    int width = 0;                      // of every picture [pixels]; its height follows from the shot's
    int reference_samples = 0;          // paths per pixel
    std::string path_samples;           // of the path tracers: "16,64"
    std::string grid_steps;             // of the ladder of lighting_grid: "1,3"
    std::string cascade_sides;          // of radiance cascades: "4,8"
    std::string lattice_levels;         // of diffusion: "2,1"
    std::string lamps;                  // of methods that put lamps in the place of the fire: "4,16"
    int strip_frames = 0;               // of the film strip of each method and cell; 0: none
    std::string sides;                  // samples along a pixel's side, of all other methods: "1,2"
    std::vector<std::string> settings;  // over those of every shot, for every method
    // What is cheap where it is not judged: further ones of the methods that neither own MV nor scatter it on, and of
    // those without MM. Those with SS are judged by the fire's light in smoke that their paths see, and have a finer
    // one.
    std::vector<std::string> beside_fire;
    std::vector<std::string> beside_fire_of_surfaces;
    std::vector<std::string> beside_scattering;
};

const std::vector<SuiteSize>& suite_sizes();

// Throws Error Usage for a name of none.
const SuiteSize& suite_size(const std::string& name);

// The methods named, each at the budgets of the suite; without names all of the table. Throws Error Usage.
std::vector<Method> suite_methods(const SuiteSize& size, const std::vector<std::string>& names);

struct SuiteScene {
    std::string name;  // "explosion", "media/candle"
    std::filesystem::path file;
};

// The scenes of a suite: those of the list and of the folder `media` in `shots`, by name, then `further` files. A file
// that is not there is a scene all the same, which fails when it is opened. `names`: of those of `shots` only these;
// empty: all. Throws Error MissingInput when there is no folder `shots`, and Usage for a name of none.
std::vector<SuiteScene> suite_scenes(const std::filesystem::path& shots, const std::vector<std::string>& names,
                                     const std::vector<std::string>& further);

// "camera.width=64" and the height [pixels] by which a picture keeps its shape; empty where `given` settings name one.
std::vector<std::string> size_settings(const SuiteSize& size, int width, int height,
                                       const std::vector<std::string>& given);

}  // namespace brisance
