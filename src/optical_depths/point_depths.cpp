#include "optical_depths/point_depths.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optical_depths/point_depths.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "medium/lattice/extinction_sampler-inl.h"

#ifndef BRISANCE_GATHERING_POINT_RAYS_
#define BRISANCE_GATHERING_POINT_RAYS_
namespace brisance {

// Rays in planar arrays: origin + t * (x, y, z) over t in [begin, end], in nodes; `metres` long from t = 0 to 1.
struct PointRays {
    alignas(64) float x[PointDepths::kRays], y[PointDepths::kRays], z[PointDepths::kRays];
    alignas(64) float begin[PointDepths::kRays], end[PointDepths::kRays], metres[PointDepths::kRays];
};

}  // namespace brisance
#endif

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, PointDepths::kRays>;

// Integrates the extinction along rays at the middles of `steps` equal steps, to optical depths. Ends early where all
// rays of a vector are opaque.
void sum_extinction(const PackedExtinction& level, const vec3& origin, const PointRays& rays, int steps, float* depth) {
    const D d;
    for (int k = 0; k < PointDepths::kRays; k += static_cast<int>(hn::Lanes(d))) {
        const auto x = hn::LoadU(d, rays.x + k), y = hn::LoadU(d, rays.y + k), z = hn::LoadU(d, rays.z + k);
        const auto first = hn::LoadU(d, rays.begin + k);
        const auto step = hn::Mul(hn::Sub(hn::LoadU(d, rays.end + k), first), hn::Set(d, 1.0f / float(steps)));
        const auto metres = hn::Mul(step, hn::LoadU(d, rays.metres + k));
        auto total = hn::Zero(d);
        for (int s = 0; s < steps; ++s) {
            const auto t = hn::MulAdd(step, hn::Set(d, float(s) + 0.5f), first);
            total = hn::Add(total, sample_extinction(d, level, hn::MulAdd(t, x, hn::Set(d, origin.x)),
                                                     hn::MulAdd(t, y, hn::Set(d, origin.y)),
                                                     hn::MulAdd(t, z, hn::Set(d, origin.z))));
            if (s % 4 == 3 && hn::AllTrue(d, hn::Gt(hn::Mul(total, metres), hn::Set(d, PointDepths::kOpaque))))
                break;
        }
        hn::StoreU(hn::Mul(total, metres), d, depth + k);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brisance {

HWY_EXPORT(sum_extinction);

PointDepths::PointDepths(const ExtinctionPyramid& pyramid, int level) {
    level = std::clamp(level, 0, pyramid.level_count() - 1);
    const Medium& medium = pyramid.medium();
    const float scale = 1.0f / float(1 << level);
    extinction_ = pyramid.view(level);
    nodes_from_local_ = scale * medium.index_from_local;
    metres_per_node_ = medium.spacing / scale;
    for (int a = 0; a < 3; ++a) {
        low_[a] = float(BrickLattice::kSize * extinction_.min_brick[a]);
        high_[a] = low_[a] + float(BrickLattice::kSize * extinction_.extent[a]);
    }
}

void PointDepths::between(const vec3& from, const vec3* to, float* depth) const {
    const vec3 origin = nodes_from_local_ * from;
    PointRays rays;
    float longest = 0.0f;
    for (int k = 0; k < kRays; ++k) {
        const vec3 segment = nodes_from_local_ * to[k] - origin;
        float enter = 0.0f, leave = 1.0f;
        for (int a = 0; a < 3; ++a)
            if (segment[a] != 0.0f) {
                const float low = (low_[a] - origin[a]) / segment[a], high = (high_[a] - origin[a]) / segment[a];
                enter = std::max(enter, std::min(low, high));
                leave = std::min(leave, std::max(low, high));
            }
        leave = std::max(leave, 0.0f);
        enter = std::min(enter, leave);
        rays.x[k] = segment.x, rays.y[k] = segment.y, rays.z[k] = segment.z;
        rays.begin[k] = enter, rays.end[k] = leave;
        rays.metres[k] = glm::distance(from, to[k]);
        longest = std::max(longest, (leave - enter) * glm::length(segment));
    }
    // No ray that matters crosses more nodes than this, but a point far away could demand more steps.
    const int steps = 1 + static_cast<int>(std::min(longest, 4096.0f));
    HWY_DYNAMIC_DISPATCH(sum_extinction)(extinction_, origin, rays, steps, depth);
}

}  // namespace brisance
#endif
