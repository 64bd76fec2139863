// One bounce of scattered light on a coarse lattice, balanced (multiple_scattering.h).
#pragma once

#include <memory>
#include <vector>

#include "gathering/gather.h"
#include "scattering/scattered_light.h"

namespace brisance {

struct BounceBalance;

// Light about to fly.
struct Departure {
    ScatteredLight light;
    std::vector<Rgb> power;  // the same light by the hats it comes from, before sharpening [W/sr]
};

class CoarseOperator {
public:
    CoarseOperator(const ExtinctionPyramid& fine, int level, const LightingSettings& lighting, float alpha);

    std::size_t active_nodes() const { return active_; }
    std::uint64_t bytes() const;

    // Lights of the fine lattice splatted to the coarse nodes.
    Departure restricted(const ScatteredLight& fine, const BrickLattice& fine_lattice) const;

    // One flight and one scattering. Fills the balance; appends level costs when `costs` is empty.
    NodeRadiance bounce(const Departure& departure, BounceBalance& balance, std::vector<LevelCost>& costs,
                        Progress& progress);
    // What sets out on the next flight.
    Departure departure_of(const NodeRadiance& source) const;

    // The source function of the coarse nodes as fine lights: it is interpolated, and the fine extinction decides where
    // light leaves from.
    ScatteredLight spread_to_fine(const NodeRadiance& coarse, const Medium& fine) const;

    // Light of a source function of 1 per coarse node [m^2]: how much a node matters.
    const std::vector<float>& weight() const { return weight_; }
    // What a gather of a unit source function has to be multiplied by at each node; empty: not balanced.
    const std::vector<float>& node_scale() const { return node_scale_; }

private:
    Gathered gather(const ScatteredLight& lights, std::vector<LevelCost>& costs, Progress& progress);
    void balance_nodes(const ExtinctionPyramid& fine);
    void close_balance(const dvec3& collides, const dvec3& hit, Gathered& arriving) const;

    int level_;
    Medium medium_;  // coarse
    std::unique_ptr<ExtinctionPyramid> pyramid_;
    LightingSettings lighting_;
    float alpha_;
    std::size_t active_ = 0;
    std::vector<std::uint8_t> mask_;
    std::vector<float> mass_;       // integral of hat * extinction [m^2]
    std::vector<Rgb> unit_;         // light of a source function of 1: the same sharpened
    std::vector<float> weight_;     // the same as a scalar: centres do not depend on a bounce's light
    std::vector<float> collision_;  // of light that leaves the node: probability of colliding before it escapes
    std::vector<float> hat_collision_;  // of light of the node's hat
    std::vector<float> factor_;         // D
    std::vector<float> node_scale_;     // about D^2
    LightingGrid grid_;
    ShadowMapCache maps_;
};

}  // namespace brisance
