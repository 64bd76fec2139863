// A glowing volume as a target of shadow rays: which of its voxels a surface point sees past other surfaces.
//
// The lighting grid sums all lights without noise, but without occlusion between them and a surface point. A few points
// of the volume are therefore sampled in proportion to the light they send to the surface point, and a shadow ray
// toward each tests visibility. The ratio of two estimates with the same samples, visible over all light, multiplies
// the sum (Lin and Yuksel, Real-Time Rendering with Lighting Grid Hierarchy, I3D 2019). It is exact where everything or
// nothing is visible, and noisy in penumbrae only.
#pragma once

#include <array>
#include <vector>

#include "core/rng.h"
#include "emitters/light_front.h"
#include "lighting_grid/footprint.h"
#include "medium/medium.h"
#include "optical_depths/point_depths.h"

namespace brisance {

class VisibilityRatio {
public:
    static constexpr int kDraws = PointDepths::kRays;

    // `intensity`: of the voxels, per node of the medium's lattice [W/sr]; `escape`: probability that their light
    // leaves the medium (gathering/escape_probability.h), so that in dense smoke the voxels of its skin are sampled.
    // Keeps references to medium and depths.
    VisibilityRatio(const Medium& medium, const PointDepths& depths, const std::vector<Rgb>& intensity,
                    const NodeWeights& escape);
    bool empty() const { return tree_.empty(); }

    // What places close to `middle` draw from, `points` points in all.
    LightFront around(const LitPoint& middle, std::size_t points) const;

    // A point of the volume, for places close to that for which it was chosen.
    struct Target {
        vec3 point{0.0f};  // local [m]
        float power =
            0.0f;  // luminance of its voxel's intensity over the probability [W/sr]; 0: no light reaches there
    };
    using Targets = std::array<Target, kDraws>;
    // One target in each of kDraws strata, `shift` of the way through it, in [0, 1). There must be voxels that glow.
    Targets choose(const LightFront& around, const LitPoint& point, double shift, Rng& rng) const;

    struct Draw {
        vec3 point;           // local [m]
        vec3 direction;       // unit, from the point
        float weight = 0.0f;  // luminance of the light from there over its pdf, without occlusion by surfaces
    };
    // How targets count at a place.
    void weigh(const LitPoint& point, const Targets& targets, std::array<Draw, kDraws>& draws) const;
    // Both. Returns false where nothing can be sampled.
    bool draw(const LightFront& around, const LitPoint& point, Rng& rng, std::array<Draw, kDraws>& draws) const;

    std::uint64_t bytes() const;

private:
    struct Cluster {
        std::uint32_t first = 0;  // of its voxels
        float sum = 0.0f;         // of their weights
    };
    std::size_t voxel_in(std::size_t cluster, Rng& rng) const;
    vec3 point_in(std::size_t voxel, Rng& rng) const;

    const Medium& medium_;
    const PointDepths& depths_;
    std::vector<std::uint32_t> nodes_;  // that glow, cluster by cluster
    std::vector<float> passed_;         // running sum of weights within the cluster
    std::vector<float> per_weight_;     // luminance of the intensity over the weight
    std::vector<Cluster> clusters_;     // one more than there are, as an end
    LightTree tree_;
};

}  // namespace brisance
