// Optical coefficients at the nodes of a lattice, made from one volume's grids or from several.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "medium/lattice/source_grid.h"
#include "medium/settings.h"

namespace brisance {

struct Sources {
    std::optional<SourceGrid> density, temperature, flame, colour, velocity;
    MediumSettings settings;
};

struct NodeFields {
    std::vector<float> extinction;  // [1/m]
    std::vector<Rgb> source;        // (1 - albedo) L_e [W/(m^2 sr)]; empty: none
    std::vector<Rgb> emission;      // j [W/(m^3 sr)]; empty: none
    std::vector<Rgb> albedo;        // empty: `uniform_albedo` everywhere
    std::vector<vec3> velocity;     // [m per frame]; empty: nothing moves
    Rgb uniform_albedo{0.0f};
};

// Sums the scattering, absorption and emission of the volumes at each node. Source functions, albedos and velocities
// are means weighted by extinction, which makes the sums exact at nodes. Between nodes they are interpolated like those
// of one volume.
NodeFields fill_fields(const BrickLattice& lattice, std::span<const Sources> volumes);

}  // namespace brisance
