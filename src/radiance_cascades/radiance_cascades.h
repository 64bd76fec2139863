// Radiance cascades: light that the medium's source function sends to its nodes.
// A. Sannikov, Radiance Cascades: A Novel Approach to Calculating Global Illumination, 2023.
//
// Cascade i has probes 2^i nodes apart and four times the directions of cascade i - 1. It knows what lies between the
// distances t_i = near (2^i - 1) h and t_{i+1} from its probes: the interval's radiance and transmittance. From the
// coarsest cascade down, each interval is continued by those of the next one,
//   L_i(p, d) = sum_q w_q [ L(p, q, d) + T(p, q, d) 1/4 sum_{children d'} L_{i+1}(q, d') ],
// where q are the at most eight probes of cascade i + 1 around p and w_q the weights of trilinear interpolation. The
// light arriving at a node is the sum of L_0 over its directions.
//
// What differs from the source: the world is a medium, so that intervals hold a source function and an extinction that
// are marched, and probes lie on its lattice, only around its extinction. Coarser cascades march coarser averages of
// the medium, whose voxels all cascades see under the same angle: directions stop dividing where they resolve them.
// Surfaces cut intervals, and a probe q behind a surface leaves its weight to the others.
//
// Known error: the interval of q begins beside the end of that of p, by up to a spacing of the probes per axis. Longer
// first intervals make the angle of this parallax smaller (settings.h).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "medium/lattice/extinction_pyramid.h"
#include "radiance_cascades/cascade.h"
#include "radiance_cascades/cascade_directions.h"
#include "radiance_cascades/settings.h"
#include "receivers/receivers.h"

namespace brisance {

struct CascadeCounts {
    int cascades = 0;
    std::uint64_t probes = 0;      // of all cascades
    std::uint64_t intervals = 0;   // probes times directions
    std::uint64_t directions = 0;  // of the coarsest cascade
};

class RadianceCascades {
public:
    // Light is wanted at the pyramid's nodes with `needed`. Keeps a reference to the pyramid, whose surfaces stop
    // light.
    RadianceCascades(const ExtinctionPyramid& pyramid, const std::vector<std::uint8_t>& needed,
                     const CascadeSettings& settings);

    // Light from a source function at the pyramid's nodes [W/(m^2 sr)]: interleaved colours, or 27 values of which the
    // last 24 are the degrees 1 and 2 of the light that leaves (sh.h, channel 3 m + c). Fluence at the needed nodes,
    // and with 27 values moments.
    Gathered gather(std::span<const float> source, int channels);

    const CascadeCounts& counts() const { return counts_; }
    std::uint64_t bytes() const;

private:
    // Directions [first, last) at the probes of one brick.
    struct Task {
        std::size_t brick;
        int first, last;
        std::vector<std::uint8_t> unhidden;  // of all its intervals in order, where there are surfaces; made once
    };
    struct Cascade {
        CascadeProbes probes;
        float begin, end;                      // [m]
        int level;                             // of the pyramid, for the march
        int stride;                            // nodes of that level from probe to probe
        std::vector<std::vector<Task>> tasks;  // per group of directions with one field
    };
    struct Level {  // of the pyramid
        std::vector<OccupiedNodes> occupied;
        std::vector<float> source;  // as given to gather(), averaged by extinction
    };
    struct Output;
    class Merge;

    void add_cascade(std::vector<std::uint8_t> needed, BrickLattice lattice);
    void add_tasks(Cascade& cascade, int index) const;
    void average_source(std::span<const float> source, int channels);
    void combine(int level, int channels, int direction);
    void merge(int index, int channels, const std::vector<float>& far, Output& out);

    const ExtinctionPyramid& pyramid_;
    CascadeSettings settings_;
    bool directional_;
    std::unique_ptr<CascadeDirections> directions_;
    std::vector<Cascade> cascades_;
    std::vector<Level> levels_;
    std::vector<float> field_;  // source function and extinction of one level, for one group of directions
    CascadeCounts counts_;
};

}  // namespace brisance
