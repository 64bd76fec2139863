#include "shadows/shadow_kernels.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shadows/shadow_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "medium/lattice/extinction_sampler-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

// Extinction times length of one step at origin + distance * direction + offset.
HWY_INLINE V step_depth(D d, const PackedExtinction* mips, const ShadowStep& s, const V origin[3], const V direction[3],
                        const V offset[3], float spread) {
    const V shrink = hn::Set(d, 1.0f / float(1 << s.mip));
    V p[3];
    for (int a = 0; a < 3; ++a) {
        p[a] = hn::MulAdd(hn::Set(d, s.distance), direction[a], origin[a]);
        p[a] = hn::Mul(hn::MulAdd(hn::Set(d, spread), offset[a], p[a]), shrink);
    }
    return hn::Mul(sample_extinction(d, mips[s.mip], p[0], p[1], p[2]), hn::Set(d, s.length));
}

// The distance up to which any ray of one group of lanes may find extinction [m], computed for each level of the
// pyramid when it is first needed. Extinction beyond it is 0 and need not be sampled. `slack` is the offset of a ray's
// start from its line.
class Exits {
public:
    Exits(const PackedExtinction* mips, const V start[3], const V direction[3], const V slack[3])
        : mips_(mips), start_(start), direction_(direction), slack_(slack) {}

    bool passed(D d, const ShadowStep& s) {
        if (!(known_ >> s.mip & 1)) {
            known_ |= 1u << s.mip;
            exit_[s.mip] = farthest(d, s.mip);
        }
        return s.distance > exit_[s.mip];
    }

private:
    float farthest(D d, int mip) const {
        const PackedExtinction& level = mips_[mip];
        const auto node = [&](int brick) { return std::ldexp(float(brick) * 8.0f, mip); };
        V exit = hn::Set(d, 1e30f);
        for (int a = 0; a < 3; ++a) {
            // Inside of the rim of empty bricks.
            const V low = hn::Sub(hn::Set(d, node(level.min_brick[a] + 1)), slack_[a]);
            const V high = hn::Add(hn::Set(d, node(level.min_brick[a] + level.extent[a] - 1)), slack_[a]);
            const V slope = hn::CopySign(hn::Max(hn::Abs(direction_[a]), hn::Set(d, 1e-20f)), direction_[a]);
            const V bound = hn::IfThenElse(hn::Gt(slope, hn::Zero(d)), high, low);
            exit = hn::Min(exit, hn::Div(hn::Sub(bound, start_[a]), slope));
        }
        return hn::GetLane(hn::MaxOfLanes(d, exit));
    }

    const PackedExtinction* mips_;
    const V *start_, *direction_, *slack_;
    std::uint32_t known_ = 0;
    float exit_[ExtinctionPyramid::kMaxLevels] = {};
};

// Mean transmittance to the first stored distance over starting points spread in the light's extent.
HWY_INLINE V near_transmittance(D d, const PackedExtinction* mips, std::span<const ShadowStep> steps, const V origin[3],
                                const V direction[3], const ShadowRays& rays, std::size_t ray) {
    const float reach = steps.back().distance + 0.5f * steps.back().length;
    V sum = hn::Zero(d);
    for (int k = 0; k < kNearRays; ++k) {
        // An odd stride spreads a group's starts over the list; neighbouring groups continue elsewhere.
        const std::size_t at = (ray * 5 + k * (kStarts / kNearRays)) % kStarts;
        V offset[3];
        for (int a = 0; a < 3; ++a)
            offset[a] = hn::LoadU(d, rays.starts[a] + at);
        V depth = hn::Zero(d);
        for (const ShadowStep& s : steps)
            depth = hn::Add(depth, step_depth(d, mips, s, origin, direction, offset, 1.0f - s.distance / reach));
        sum = hn::Add(sum, hn::Exp(d, hn::Neg(depth)));
    }
    return hn::Mul(sum, hn::Set(d, 1.0f / kNearRays));
}

void march(const PackedExtinction* mips, std::span<const ShadowStep> near_steps, std::span<const ShadowStep> steps,
           const vec3& origin, const ShadowRays& rays, int distances, std::uint16_t* out) {
    const D d;
    const hn::RebindToSigned<D> di;
    const std::size_t lanes = hn::Lanes(d);
    const V start[3] = {hn::Set(d, origin.x), hn::Set(d, origin.y), hn::Set(d, origin.z)};
    const V centre[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    HWY_ALIGN std::int32_t quantised[16];
    for (std::size_t r = 0; r < rays.count; r += lanes) {
        V direction[3];
        for (int a = 0; a < 3; ++a)
            direction[a] = hn::LoadU(d, rays.direction[a] + r);
        const V near = near_transmittance(d, mips, near_steps, start, direction, rays, r);
        Exits exits(mips, start, direction, centre);
        V depth = hn::Zero(d);
        bool opaque = false;
        const auto store = [&](int k) {
            const V t = hn::Mul(near, hn::Exp(d, hn::Neg(depth)));
            hn::Store(hn::NearestInt(hn::Mul(t, hn::Set(d, 65535.0f))), di, quantised);
            for (std::size_t i = 0; i < lanes; ++i)
                out[(r + i) * distances + k] = static_cast<std::uint16_t>(quantised[i]);
            opaque = hn::AllTrue(d, hn::Lt(t, hn::Set(d, 1e-5f)));
        };
        store(0);
        for (const ShadowStep& s : steps) {
            if (!opaque && !exits.passed(d, s))
                depth = hn::Add(depth, step_depth(d, mips, s, start, direction, centre, 0.0f));
            if (s.store >= 0)
                store(s.store);
        }
    }
}

// Rays of one group of texels from different points of the light's extent.
struct Bundle {
    V offset[kMostParallelRays][3];
    V weight[kMostParallelRays];
    V depth[kMostParallelRays];
    bool opaque[kMostParallelRays];
    V widest[3];  // of the offsets, without their signs
    bool changed = true;
    int rays;
};

HWY_INLINE void open_bundle(D d, const ShadowRays& rays, std::size_t ray, Bundle& b) {
    b.rays = rays.parallel;
    for (V& widest : b.widest)
        widest = hn::Zero(d);
    for (int k = 0; k < b.rays; ++k) {
        const std::size_t at = (ray * 5 + k * (kStarts / b.rays)) % kStarts;
        for (int a = 0; a < 3; ++a)
            b.offset[k][a] = hn::LoadU(d, rays.starts[a] + at);
        for (int a = 0; a < 3; ++a)
            b.widest[a] = hn::Max(b.widest[a], hn::Abs(b.offset[k][a]));
        b.weight[k] = hn::LoadU(d, rays.weights + at);
        b.depth[k] = hn::Zero(d);
        b.opaque[k] = false;
    }
}

HWY_INLINE V mean_transmittance(D d, Bundle& b) {
    V sum = hn::Zero(d);
    for (int k = 0; k < b.rays; ++k) {
        sum = hn::MulAdd(b.weight[k], hn::Exp(d, hn::Neg(b.depth[k])), sum);
        b.opaque[k] = hn::AllTrue(d, hn::Gt(b.depth[k], hn::Set(d, 12.0f)));
    }
    return hn::Mul(sum, hn::Set(d, 1.0f / float(b.rays)));
}

constexpr std::size_t kMostStepsAtOnce = 4;  // one voxel long each

// Whether all lanes lie in homogeneous bricks.
HWY_INLINE bool all_even(D d, const HomogeneousBricks::View& parts, const ShadowStep& s, const V origin[3],
                         const V direction[3]) {
    const hn::RebindToSigned<D> di;
    auto entry = hn::Zero(di);
    for (int a = 0; a < 3; ++a) {
        const V node = hn::Floor(hn::MulAdd(hn::Set(d, s.distance), direction[a], origin[a]));
        const auto brick = hn::Sub(hn::ShiftRight<3>(hn::ConvertTo(di, node)), hn::Set(di, parts.min_brick[a]));
        const auto inside = hn::Min(hn::Max(brick, hn::Zero(di)), hn::Set(di, parts.extent[a] - 1));
        entry = hn::Add(hn::Mul(entry, hn::Set(di, parts.extent[a])), inside);
    }
    return hn::AllTrue(di, hn::Ne(hn::GatherIndex(di, parts.even, entry), hn::Zero(di)));
}

// Merges all of `steps` into one.
inline ShadowStep stride_over(std::span<const ShadowStep> steps, int mip) {
    const float begin = steps.front().distance - 0.5f * steps.front().length;
    const float end = steps.back().distance + 0.5f * steps.back().length;
    return {0.5f * (begin + end), end - begin, mip, steps.back().store};
}

// Takes all of `steps` in one if all lanes lie in homogeneous bricks.
HWY_INLINE bool stride(D d, const PackedExtinction* mips, std::span<const ShadowStep> steps, const V start[3],
                       const V direction[3], const HomogeneousStrides& strides, Bundle& bundle) {
    const ShadowStep s = stride_over(steps, strides.mip);
    if (!all_even(d, strides.parts, s, start, direction))
        return false;
    const V depth = step_depth(d, mips, s, start, direction, start, 0.0f);
    for (int k = 0; k < bundle.rays; ++k)
        bundle.depth[k] = hn::Add(bundle.depth[k], depth);
    bundle.changed = true;
    return true;
}

HWY_INLINE void march_bundle(D d, const PackedExtinction* mips, std::span<const ShadowStep> steps, const V start[3],
                             const V direction[3], Exits& exits, Bundle& bundle) {
    for (const ShadowStep& s : steps) {
        if (exits.passed(d, s))
            continue;
        bundle.changed = true;
        for (int k = 0; k < bundle.rays; ++k)
            if (!bundle.opaque[k])
                bundle.depth[k] =
                    hn::Add(bundle.depth[k], step_depth(d, mips, s, start, direction, bundle.offset[k], 1.0f));
    }
}

// The number of steps to the next stored distance, limited to what one stride may take: half a brick's length.
inline std::size_t steps_at_once(std::span<const ShadowStep> steps, const HomogeneousStrides* strides) {
    std::size_t n = 1;
    while (n < steps.size() && steps[n - 1].store < 0 && (!strides || n < kMostStepsAtOnce))
        ++n;
    return n;
}

void march_parallel(const PackedExtinction* mips, std::span<const ShadowStep> near_steps,
                    std::span<const ShadowStep> steps, const vec3& origin, const ShadowRays& rays, int distances,
                    float scale, std::uint16_t* out, const HomogeneousStrides* strides) {
    const D d;
    const hn::RebindToSigned<D> di;
    const std::size_t lanes = hn::Lanes(d);
    const V start[3] = {hn::Set(d, origin.x), hn::Set(d, origin.y), hn::Set(d, origin.z)};
    HWY_ALIGN std::int32_t quantised[16] = {};
    for (std::size_t r = 0; r < rays.count; r += lanes) {
        V direction[3];
        for (int a = 0; a < 3; ++a)
            direction[a] = hn::LoadU(d, rays.direction[a] + r);
        Bundle bundle;
        open_bundle(d, rays, r, bundle);
        Exits exits(mips, start, direction, bundle.widest);
        for (const std::span<const ShadowStep> part : {near_steps, steps})
            for (std::size_t first = 0; first < part.size();) {
                const auto these = part.subspan(first, steps_at_once(part.subspan(first), strides));
                const int store = these.back().store;
                first += these.size();
                const bool fine = these.size() > 1 && these.front().mip == 0;
                const bool strided = strides && fine && !exits.passed(d, these.front()) &&
                                     stride(d, mips, these, start, direction, *strides, bundle);
                if (!strided)
                    march_bundle(d, mips, these, start, direction, exits, bundle);
                if (store < 0)
                    continue;
                if (bundle.changed) {
                    const V t = hn::Mul(mean_transmittance(d, bundle), hn::Set(d, scale));
                    hn::Store(hn::NearestInt(hn::Min(t, hn::Set(d, 65535.0f))), di, quantised);
                    bundle.changed = false;
                }
                for (std::size_t i = 0; i < lanes; ++i)
                    out[(r + i) * distances + store] = static_cast<std::uint16_t>(quantised[i]);
            }
    }
}

// Segments of one group of lanes, cut into steps of the same number.
struct SegmentGroup {
    V from[3], segment[3];
    int steps;

    HWY_INLINE SegmentGroup(D d, const Segments& all, std::size_t r, float step_nodes) {
        V square = hn::Zero(d);
        for (int a = 0; a < 3; ++a) {
            from[a] = hn::LoadU(d, all.begin[a] + r);
            segment[a] = hn::Sub(hn::LoadU(d, all.end[a] + r), from[a]);
            square = hn::MulAdd(segment[a], segment[a], square);
        }
        const float longest = hn::GetLane(hn::MaxOfLanes(d, hn::Sqrt(square)));
        steps = 1 + static_cast<int>(longest / step_nodes);
    }
    // Of the field in the middle of a step.
    HWY_INLINE V sample(D d, const PackedExtinction& field, int step) const {
        const V t = hn::Set(d, (step + 0.5f) / steps);
        return sample_extinction(d, field, hn::MulAdd(t, segment[0], from[0]), hn::MulAdd(t, segment[1], from[1]),
                                 hn::MulAdd(t, segment[2], from[2]));
    }
};

void segments(const PackedExtinction& extinction, const Segments& all, float step_nodes, float* depths) {
    const D d;
    for (std::size_t r = 0; r < all.count; r += hn::Lanes(d)) {
        const SegmentGroup group(d, all, r, step_nodes);
        V sum = hn::Zero(d);
        for (int s = 0; s < group.steps; ++s)
            sum = hn::Add(sum, group.sample(d, extinction, s));
        hn::StoreU(hn::Mul(sum, hn::Mul(hn::LoadU(d, all.metres + r), hn::Set(d, 1.0f / group.steps))), d, depths + r);
    }
}

void collisions(const PackedExtinction& extinction, const PackedExtinction& weight, const Segments& all,
                float step_nodes, float* sums) {
    const D d;
    for (std::size_t r = 0; r < all.count; r += hn::Lanes(d)) {
        const SegmentGroup group(d, all, r, step_nodes);
        const V length = hn::Mul(hn::LoadU(d, all.metres + r), hn::Set(d, 1.0f / group.steps));
        V left = hn::Set(d, 1.0f), sum = hn::Zero(d);
        for (int s = 0; s < group.steps && !hn::AllTrue(d, hn::Lt(left, hn::Set(d, 1e-6f))); ++s) {
            const V passed = hn::Mul(left, hn::Exp(d, hn::Neg(hn::Mul(length, group.sample(d, extinction, s)))));
            sum = hn::MulAdd(hn::Sub(left, passed), group.sample(d, weight, s), sum);
            left = passed;
        }
        hn::StoreU(sum, d, sums + r);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brisance {

HWY_EXPORT(march);
HWY_EXPORT(march_parallel);
HWY_EXPORT(segments);
HWY_EXPORT(collisions);

void march_shadow_rays(const PackedExtinction* mips, std::span<const ShadowStep> near_steps,
                       std::span<const ShadowStep> steps, const vec3& origin, const ShadowRays& rays, int distances,
                       std::uint16_t* out) {
    HWY_DYNAMIC_DISPATCH(march)(mips, near_steps, steps, origin, rays, distances, out);
}

void march_parallel_rays(const PackedExtinction* mips, std::span<const ShadowStep> near_steps,
                         std::span<const ShadowStep> steps, const vec3& origin, const ShadowRays& rays, int distances,
                         float scale, std::uint16_t* out, const HomogeneousStrides* strides) {
    HWY_DYNAMIC_DISPATCH(march_parallel)(mips, near_steps, steps, origin, rays, distances, scale, out, strides);
}

void segment_optical_depths(const PackedExtinction& extinction, const Segments& all, float step_nodes, float* depths) {
    HWY_DYNAMIC_DISPATCH(segments)(extinction, all, step_nodes, depths);
}

void segment_collisions(const PackedExtinction& extinction, const PackedExtinction& weight, const Segments& all,
                        float step_nodes, float* sums) {
    HWY_DYNAMIC_DISPATCH(collisions)(extinction, weight, all, step_nodes, sums);
}

}  // namespace brisance
#endif
