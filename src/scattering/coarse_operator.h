// One bounce of scattered light on a coarse lattice, balanced (multiple_scattering.h).
#pragma once

#include <memory>
#include <vector>

#include "gathering/gather.h"
#include "radiance_cascades/radiance_cascades.h"
#include "scattering/settings.h"

namespace brisance {

// Light leaving the nodes of a lattice after a scattering.
struct ScatteredLight {
    std::vector<Rgb> intensity;      // mean over directions [W/sr]
    std::vector<float> directional;  // degrees 1 and 2, 24 per node (sh.h); empty: isotropic
    // What the intensity is the projection of, per extinction: 3 values per node, or 27, interleaved [W/(m^2 sr)].
    // Empty where nobody asks for it.
    std::vector<float> source = {};
    void add(const ScatteredLight& other, const Rgb& factor);  // a factor per colour
    // sharpen_lights(); the directional part keeps its proportion to the mean at every node.
    void sharpen(const BrickLattice& lattice, int sharpened_below = 0);
};

// Returns the light that arriving light scatters into: the exact projection of extinction * albedo * fluence / 4 pi,
// and of its higher moments times those of the phase function. Only nodes with `mask` count.
ScatteredLight scattered_light(const Medium& medium, const Gathered& arriving, const std::vector<std::uint8_t>& mask);

// Lights splatted to the nodes of the lattice 2^levels coarser, not sharpened.
ScatteredLight restricted(const ScatteredLight& fine, const BrickLattice& fine_lattice, int levels);

// The source function of light that arriving light scatters into: 3 values per node, or 27 where there are moments.
std::vector<float> scattered_source(const Medium& medium, const Gathered& arriving,
                                    const std::vector<std::uint8_t>& mask);

// Nodes of a coarse lattice. `unit_light`: the light of each for a source function of 1, by which an intensity is
// divided; unused for light with a source function.
struct CoarseNodes {
    const BrickLattice& lattice;
    int level;
    const std::vector<std::uint8_t>& mask;  // with extinction
    std::vector<float> unit_light = {};
};

// Scattered light of coarse nodes as fine lights: the source function is interpolated, the fine extinction decides
// where it leaves from.
ScatteredLight spread_to_fine(const ScatteredLight& light, const CoarseNodes& nodes, const Medium& fine);

// Where the power of one flight went, over 4 pi [W/sr].
struct FlightPower {
    dvec3 gathered{0.0};  // collisions as gathered, before they were scaled
    dvec3 absorbed{0.0};  // afterwards
};

class CoarseOperator {
public:
    CoarseOperator(const ExtinctionPyramid& fine, int level, const LightingSettings& lighting,
                   const ScatteringSettings& scattering);

    std::size_t active_nodes() const { return active_; }
    std::uint64_t bytes() const;
    const RadianceCascades* cascades() const { return cascades_.get(); }  // null: the solver is another

    // Lights of the fine lattice splatted to the coarse nodes.
    ScatteredLight restricted(const ScatteredLight& fine, const BrickLattice& fine_lattice) const;

    // One flight and one scattering. Appends level costs when `costs` is empty.
    ScatteredLight bounce(const ScatteredLight& lights, FlightPower& flight, std::vector<LevelCost>& costs,
                          Progress& progress);

    ScatteredLight spread_to_fine(const ScatteredLight& coarse, const Medium& fine) const;

private:
    // Light at the nodes, with the balance factors.
    Gathered gather(const ScatteredLight& lights, std::vector<LevelCost>& costs, Progress& progress);
    Gathered gather_from_hierarchy(const ScatteredLight& lights, std::vector<LevelCost>& costs, Progress& progress);
    Gathered gather_by_cascades(const ScatteredLight& lights);
    void balance_nodes(const ExtinctionPyramid& fine);
    dvec3 expected_collisions(const ScatteredLight& lights) const;  // power over 4 pi

    int level_;
    Medium medium_;  // coarse
    std::unique_ptr<ExtinctionPyramid> pyramid_;
    LightingSettings lighting_;
    float alpha_;
    std::size_t active_ = 0;
    std::vector<std::uint8_t> mask_;   // nodes with extinction in their hat
    std::vector<Rgb> unit_;            // light of a source function of 1: integral of hat * extinction [m^2]
    std::vector<float> weight_;        // the same as a scalar: centres do not depend on a bounce's light
    std::vector<float> least_weight_;  // lower bound of a source function's divisor
    int collision_numbers_ = 1;        // per node of the next: directional light needs moments
    std::vector<float> collision_;     // per node: probability of a collision before leaving the medium
    std::vector<float> factor_;        // D
    LightingGrid grid_;
    ShadowMapCache maps_;
    std::unique_ptr<RadianceCascades> cascades_;
};

}  // namespace brisance
