// The node values of a Medium in one dense box, with a trilinear lookup written for these tests alone.
#pragma once

#include <cstddef>
#include <vector>

#include "core/vec.h"
#include "medium/medium.h"

namespace brisance::independent {

// Fields are interpolated one by one and multiplied afterwards; nodes that the medium does not store are
// zero, but for an albedo that is the same everywhere. Every position is in world space [m].
class SmokeBox {
public:
    SmokeBox() = default;  // no smoke
    explicit SmokeBox(const Medium& medium);

    double extinction(const dvec3& p) const;  // [1/m]
    dvec3 emission(const dvec3& p) const;     // extinction * source + emission [W/(m^3 sr)]
    dvec3 albedo(const dvec3& p) const;       // [1]
    double majorant() const { return majorant_; }
    double mean_cosine() const { return mean_cosine_; }

    // Distances [m] between which the line origin + t * direction lies in the box; t >= 0. False: it misses the box.
    bool clip(const dvec3& origin, const dvec3& direction, double& begin, double& end) const;

private:
    // The eight nodes around a position and their weights.
    struct Corners {
        std::size_t node[8];
        double weight[8];
    };
    bool corners(const dvec3& p, Corners& c) const;

    dmat4 index_from_world_{1.0};
    ivec3 low_{0}, size_{0};
    std::vector<double> extinction_;
    std::vector<dvec3> source_, emission_, albedo_;  // empty: zero everywhere
    double majorant_ = 0.0, mean_cosine_ = 0.0;
};

}  // namespace brisance::independent
