// A glowing volume as something to aim at: which of its voxels a surface point sees past other surfaces.
//
// The lighting grid sums all lights without noise, but knows nothing of what stands between them and a surface point.
// A few places are therefore drawn in proportion to what they send to the point, and a ray toward each says whether it
// arrives. Their mean, a ratio of two estimates with the same draws, multiplies the sum (Lin and Yuksel, Real-Time
// Rendering with Lighting Grid Hierarchy, I3D 2019): exact where all is seen or nothing, with noise in penumbrae only.
#pragma once

#include <array>
#include <vector>

#include "core/rng.h"
#include "emitters/light_tree.h"
#include "gathering/point_depths.h"
#include "lighting_grid/footprint.h"
#include "medium/medium.h"

namespace brisance {

class VisibilityRatio {
public:
    static constexpr int kDraws = PointDepths::kRays;

    // `intensity`: of the voxels, per node of the medium's lattice [W/sr]; `escape`: how likely their light is to leave
    // the medium (gathering/escape_probability.h), so that in dense smoke the voxels of its skin are drawn. Keeps
    // references to medium and depths.
    VisibilityRatio(const Medium& medium, const PointDepths& depths, const std::vector<Rgb>& intensity,
                    const NodeWeights& escape);
    bool empty() const { return tree_.empty(); }

    struct Draw {
        vec3 place;           // local [m]
        vec3 direction;       // unit, from the point
        float weight = 0.0f;  // what arrives from there over the density of drawing it, without surfaces; luminance
    };
    // None where nothing can be drawn.
    bool draw(const LitPoint& point, Rng& rng, std::array<Draw, kDraws>& draws) const;

    std::uint64_t bytes() const;

private:
    struct Cell {
        std::uint32_t first = 0;  // of its voxels
        float sum = 0.0f;         // of their weights
    };
    std::size_t voxel_in(std::size_t cell, Rng& rng) const;
    vec3 place_in(std::size_t voxel, Rng& rng) const;

    const Medium& medium_;
    const PointDepths& depths_;
    std::vector<std::uint32_t> nodes_;  // that glow, cell by cell
    std::vector<float> passed_;         // running sum of weights within the cell
    std::vector<float> per_weight_;     // luminance of the intensity over the weight
    std::vector<Cell> cells_;           // one more than there are, as an end
    LightTree tree_;
};

}  // namespace brisance
