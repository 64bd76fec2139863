// The methods that a report compares, each with a ladder of steps from cheap to accurate.
//
// A method:  NAME, or LABEL=NAME, followed by settings:    exact=path,tracing.free_flight=exact
//   NAME is lighting_grid; fire_clusters (its fire as a few lamps); fire_SAMPLING (its fire by another choice of
//   lights, fire_lights/samplings.h); radiance_cascades (its bounces by probes); diffusion (its bounces by a diffusion
//   equation); path, path_plain (the path tracer without its acceleration techniques), or path_filtered (its picture
//   after a noise filter); a preset of one of the scattering methods (scattering_methods/list.h), such as ray_lights or
//   volumetric_vpls_bounded; or a preset of virtual lights (virtual_lights/choices.h): vbnl (virtual blue noise
//   lighting), vbnl_GATHERER (the same lights, sampled otherwise), vpl, vsl and others like them.
// A budget:  LIST for all path methods, or LABEL:LIST:     4,16,64,256    path:16,64    lighting_grid:2,4
//   For path methods samples per pixel, for lighting_grid numbers of steps of the built-in ladder, 1 to 4, for those
//   of fire_clusters numbers of lamps, for those of radiance_cascades scattering.cascade_side, for those of
//   diffusion scattering.lattice_level, for those of virtual lights samples along a pixel's side.
// A ladder:  LABEL:KEY=LIST, several of one label side by side, instead of the built-in steps:
//   lighting_grid:lighting.alpha=1,1.5,2,3   lighting_grid:lighting.shadow_resolution=8,12,20,24
#pragma once

#include <string>
#include <vector>

#include "core/cell.h"

namespace brisance {

struct MethodStep {
    std::string label;                  // "16 spp", "alpha=2"
    std::vector<std::string> settings;  // "tracing.samples=16", over those of the method
};

// What makes a method better, and dearer: the fineness of its grids, lamps, directions, lattices, paths, or samples
// along a pixel's side.
enum class StepsOf { Grid, Lamps, Directions, Lattices, Paths, Samples };

struct Method {
    std::string label;
    std::string base;                   // the built-in method it is made of
    std::vector<std::string> settings;  // "method=path", ..., over those of the shot
    std::vector<MethodStep> steps;      // at least one
    StepsOf steps_of = StepsOf::Grid;   // of the built-in ladder
    bool unbiased = false;
    bool by_default = false;     // a shot that names no method has its cells from this one
    bool scatters_grid = false;  // its MM begins with the lighting grid's MV
    bool averages = false;       // its steps average more and more samples: the error falls as time^-1/2
    CellSet cells;  // that it computes by its own technique; the others of its pictures are another method's
};

struct MethodOptions {
    std::vector<std::string> methods;  // empty: lighting_grid and path
    std::vector<std::string> budgets;
    std::vector<std::string> ladders;
};

// Throws Error Usage; the values of settings are checked later, when a shot is made of them.
std::vector<Method> parse_methods(const MethodOptions& options);

// Whether one of the settings "KEY=VALUE" is of this key.
bool sets(const std::vector<std::string>& settings, const std::string& key);

// Names of the built-in methods.
const std::vector<std::string>& built_in_methods();

// Whether the method owns the cell of this name.
bool owns(const Method& method, const std::string& cell);

// Those of `methods` that own one of the cells.
std::vector<Method> owners_of(const std::vector<Method>& methods, const CellSet& cells);

}  // namespace brisance
