#include "gathering/point_depths.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gathering/point_depths.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "medium/lattice/extinction_sampler-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, PointDepths::kRays>;

// Integrates rays in planar arrays: origin + t * segment over t in [begin, 1], all in nodes. Sums the extinction at the
// middles of `steps` equal steps, times the fraction of the segment that a step covers.
void sum_extinction(const PackedExtinction& level, const vec3& origin, const float* segment_x, const float* segment_y,
                    const float* segment_z, const float* begin, int steps, float* sum) {
    const D d;
    for (int k = 0; k < PointDepths::kRays; k += static_cast<int>(hn::Lanes(d))) {
        const auto x = hn::LoadU(d, segment_x + k), y = hn::LoadU(d, segment_y + k), z = hn::LoadU(d, segment_z + k);
        const auto first = hn::LoadU(d, begin + k);
        const auto step = hn::Mul(hn::Sub(hn::Set(d, 1.0f), first), hn::Set(d, 1.0f / float(steps)));
        auto total = hn::Zero(d);
        for (int s = 0; s < steps; ++s) {
            const auto t = hn::MulAdd(step, hn::Set(d, float(s) + 0.5f), first);
            total = hn::Add(total, sample_extinction(d, level, hn::MulAdd(t, x, hn::Set(d, origin.x)),
                                                     hn::MulAdd(t, y, hn::Set(d, origin.y)),
                                                     hn::MulAdd(t, z, hn::Set(d, origin.z))));
        }
        hn::StoreU(hn::Mul(total, step), d, sum + k);
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
    alignas(64) float x[kRays], y[kRays], z[kRays], begin[kRays];
    float longest = 0.0f;
    for (int k = 0; k < kRays; ++k) {
        const vec3 segment = nodes_from_local_ * to[k] - origin;
        float enter = 0.0f;
        for (int a = 0; a < 3; ++a)
            if (segment[a] != 0.0f)
                enter = std::max(enter, ((segment[a] > 0.0f ? low_[a] : high_[a]) - origin[a]) / segment[a]);
        enter = std::min(enter, 1.0f);
        x[k] = segment.x, y[k] = segment.y, z[k] = segment.z, begin[k] = enter;
        longest = std::max(longest, (1.0f - enter) * glm::length(segment));
    }
    // No ray that matters crosses more nodes than this, but a point far away could demand more steps.
    const int steps = 1 + static_cast<int>(std::min(longest, 4096.0f));
    HWY_DYNAMIC_DISPATCH(sum_extinction)(extinction_, origin, x, y, z, begin, steps, depth);
    for (int k = 0; k < kRays; ++k)
        depth[k] *= glm::distance(from, to[k]);
}

}  // namespace brisance
#endif
