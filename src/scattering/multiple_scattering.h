// Orders of scattering above the first: the scattered light becomes the lights of the next hierarchy.
//
// The series is solved on a coarser medium, voxels 2^m wide (the mean extinction of the pyramid's level m), where one
// bounce is the same gather as the fire's: near field on the lattice, levels above with shadow maps. Positions and
// centres are weighted by extinction, not by the light of a bounce, so the bounce is one linear operator K and its
// shadow maps are made once. Then
//   phi_{k+1} = K (V sigma albedo phi_k / 4 pi),  k = 1, 2, ...
// until what is left is known well enough: successive bounces settle on the operator's first eigenvector, so the tail
// is the geometric series of their ratio, colour by colour. The last scattering toward the camera is gathered once more
// on the fine lattice from the sum of all orders.
//
// Balance. A gather errs by some percent, and bounces multiply it. What is emitted collides or escapes, and escape
// probabilities are cheap to march exactly; by reciprocity the same number says how bright an isothermal medium is. So
// K becomes D K D with a positive factor per node, such that a unit source function gives 4 pi (1 - escape) at every
// node: energy is then conserved for any distribution of light, and Kirchhoff's law holds. What remains of each
// bounce's error against that table is scaled out. Rays that share nothing with the table measure the series as a whole
// (bounce_balance.h).
//
// Diffusion (diffusion.h) solves for the sum of all orders above the first instead: no bounce, no tail, no balance.
//
// Anisotropic phase functions: radiance arriving is kept as moments up to degree 2 (sh.h), lights are directional, and
// the last scattering uses the phase function itself.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gathering/gather.h"
#include "scattering/balance.h"
#include "scattering/bounce_balance.h"
#include "scattering/coarse_operator.h"
#include "scattering/diffused_light.h"
#include "scattering/lattice_level.h"
#include "scattering/settings.h"

namespace brisance {

struct ScatteringCosts {
    int lattice_level = 0;
    float share_of_coarser = 0.0f;  // of the light, solved on the next coarser level (lattice_level.h)
    std::size_t coarse_nodes = 0;   // of lattice_level
    double operator_seconds = 0.0;  // escape probabilities and balance factors
    double series_seconds = 0.0;
    std::vector<LevelCost> levels;             // of the first bounce
    std::optional<CascadeCounts> cascades;     // none: the solver is another
    std::optional<DiffusionCounts> diffusion;  // the same
    std::optional<BounceBalance> balance;      // of all flights together; none: not measured
    int bounces = 0;                           // computed one by one
    double tail_ratio = 0.0;                   // of successive bounces' power at the end, the largest of the colours'
    double tail_share = 0.0;                   // of the scattered power that the extrapolated tail makes up
    double remainder = 0.0;                    // estimated share still missing
    std::uint64_t bytes = 0;
};

struct ScatteringInput {
    const ExtinctionPyramid* pyramid;
    const ScatteredLight* once;  // leaving the nodes after its first scattering, not sharpened; directional if g != 0
    LightingSettings lighting;
    ScatteringSettings settings;  // but for their lattice_level
    LatticeChoice lattice = {};   // of the pyramid
    bool separate_orders = false;
};

// Light leaving the medium's nodes after one or more scatterings, ready to be gathered a last time: one entry, or one
// per order (scattered once, twice, ..., and the tail; with diffusion once, and all others) where orders are to be kept
// apart.
std::vector<ScatteredLight> solve_scattering(const ScatteringInput& input, ScatteringCosts& costs, Progress& progress);

// Lights of all levels made from light leaving nodes.
struct HierarchyLights {
    ScatteredLight light;
    std::vector<float> weight;
    LightingGrid grid;
    bool of_lamps = false;  // the grid is one level of lamps (light_clusters.h): no node has a share in them
    LightField field(const ExtinctionPyramid& pyramid, float alpha, const LightingSettings& settings,
                     ShadowMapCache* cache) const;
};
HierarchyLights build_hierarchy(const Medium& medium, ScatteredLight light, int levels);
// The same light, gathered from at most `lamps` lamps in its place.
HierarchyLights build_lamps(const Medium& medium, ScatteredLight light, int lamps);

// Node fluence as colour triples, 0 where `mask` is 0.
std::vector<Rgb> fluence_at_nodes(const Gathered& gathered, const std::vector<std::uint8_t>& mask);

// Sharpens the gathered fields for interpolation (sharpen_interpolant), in place.
void prepare_interpolation(const BrickLattice& lattice, const std::vector<std::uint8_t>& mask, Gathered& gathered);

}  // namespace brisance
