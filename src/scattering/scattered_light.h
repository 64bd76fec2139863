// Light after a scattering: as a source function at nodes, and as the lights it makes.
#pragma once

#include <cstdint>
#include <vector>

#include "gathering/receivers.h"
#include "medium/medium.h"

namespace brisance {

// A value per node and direction: the mean over directions, and the coefficients of degrees 1 and 2 (sh.h), 24 per node
// ([3 * m + colour]); no coefficients: isotropic.
struct NodeRadiance {
    std::vector<Rgb> mean;
    std::vector<float> directional;
    void add(const NodeRadiance& other, const Rgb& factor);
};

// What is scattered per unit of extinction [W/(m^2 sr)]: albedo times the radiance that arrives, its degrees times the
// phase function's. Zero where `mask` is.
NodeRadiance scattered_source(const Medium& medium, const Gathered& arriving, const std::vector<std::uint8_t>& mask);

// Light leaving the nodes of a lattice.
struct ScatteredLight {
    std::vector<Rgb> intensity;      // mean over directions [W/sr]
    std::vector<float> directional;  // as NodeRadiance
    void add(const ScatteredLight& other, float factor);
    // sharpen_lights; the directional part keeps its proportion to the mean at every node.
    void sharpen(const BrickLattice& lattice);
};

// The exact projection of extinction * source.
ScatteredLight scattered_light(const Medium& medium, const NodeRadiance& source);

}  // namespace brisance
