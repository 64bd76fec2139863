// How finely radiance cascades divide space and directions.
#pragma once

namespace brisance {

struct CascadeSettings {
    // Texels along a side of the octahedral map of the finest cascade's directions: side^2 directions.
    int side = 8;
    // Intervals of cascade i reach from near * (2^i - 1) to near * (2^(i + 1) - 1) spacings of the lattice.
    float near = 4.0f;
    // Cascade i marches the medium averaged to voxels 2^(i - finer) wide.
    int finer = 1;
    // Directions grow by 4 per cascade up to about so many. Beyond, they would resolve more than the averaged medium
    // holds: its voxels are seen under the same angle from all cascades.
    int most_directions = 1024;
};

}  // namespace brisance
