// Fires of any size to measure on: a cube full of light, random enough that nothing is skipped.
#pragma once

#include <vector>

#include "gathering/gather.h"
#include "lighting_grid/lighting_grid.h"
#include "medium/lattice/extinction_pyramid.h"
#include "medium/medium.h"

namespace brisance::benchmarks {

// A medium of `side`^3 lit nodes, its hierarchy and its lights. Not movable: the parts point at each other.
struct Fire {
    Fire(int side, float depth_of_voxel);
    Fire(const Fire&) = delete;
    Fire& operator=(const Fire&) = delete;

    LightField field(const LightingSettings& settings) const;

    Medium medium;
    ExtinctionPyramid pyramid;
    std::vector<Rgb> intensity;
    std::vector<float> weight;
    LightingGrid grid;
};

// The fire of this side made last: sizes are measured one after the other, and a large one takes a while to make.
const Fire& fire_of(int side);

// Side of the cube that holds about `lights` lights.
int side_for(std::int64_t lights);

}  // namespace brisance::benchmarks
