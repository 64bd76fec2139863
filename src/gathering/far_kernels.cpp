#include "gathering/far_kernels.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gathering/far_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/cache_control.h>
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "gathering/light_shapes-inl.h"
#include "medium/lattice/extinction_sampler-inl.h"
#include "medium/phase-inl.h"
#include "medium/sh.h"
#include "receivers/lanes-inl.h"
#include "shadows/map_lookup-inl.h"

#ifndef BRISANCE_GATHERING_LEVEL_RANGE_
#define BRISANCE_GATHERING_LEVEL_RANGE_
namespace brisance {

// Squares of the distances between which a level's lights are evaluated.
struct LevelRange {
    explicit LevelRange(const FarLights& l)
        : inner(l.bottom ? -1.0f : 0.25f * l.radius * l.radius), outer(l.top ? 1e38f : 4.0f * l.radius * l.radius) {}
    // Whether the range includes the distance between two points, give or take rounding.
    bool includes(const vec3& a, const vec3& b) const {
        const float square = glm::dot(a - b, a - b);
        return square * (1.0f - kRounding) < outer && square * (1.0f + kRounding) > inner;
    }
    // Whether the range includes the distance from `p` to some point of the box.
    bool meets(const Box& box, const vec3& p) const {
        const vec3 nearest = glm::max(glm::max(box.low - p, p - box.high), vec3(0.0f));
        const vec3 farthest = glm::max(glm::abs(box.low - p), glm::abs(box.high - p));
        return glm::dot(nearest, nearest) < outer && glm::dot(farthest, farthest) > inner;
    }
    static constexpr float kRounding = 1e-4f;
    float inner, outer;
};

}  // namespace brisance
#endif

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

// Numerical transmittance between the light and the receivers, from the distance `begin` to it on. `to_light` points
// from receiver to light [m].
V exact_transmittance(D d, const FarLights& l, const vec3& light, const V to_light[3], V distance, V begin) {
    const vec3 origin = l.index_from_local * light;
    V nodes[3];
    V square = hn::Zero(d);
    for (int a = 0; a < 3; ++a) {
        nodes[a] = hn::Zero(d);
        for (int b = 0; b < 3; ++b)
            nodes[a] = hn::NegMulAdd(hn::Set(d, l.index_from_local[b][a]), to_light[b], nodes[a]);
        square = hn::MulAdd(nodes[a], nodes[a], square);
    }
    const float longest = hn::GetLane(hn::MaxOfLanes(d, hn::Sqrt(square)));
    const int steps = 1 + static_cast<int>(longest / l.step_nodes);
    V sum = hn::Zero(d);
    const V first = hn::Div(begin, hn::Max(distance, hn::Set(d, 1e-15f)));
    for (int s = 0; s < steps; ++s) {
        const V t = hn::MulAdd(hn::Set(d, (s + 0.5f) / steps), hn::Sub(hn::Set(d, 1.0f), first), first);
        sum = hn::Add(sum, sample_extinction(d, *l.extinction, hn::MulAdd(t, nodes[0], hn::Set(d, origin.x)),
                                             hn::MulAdd(t, nodes[1], hn::Set(d, origin.y)),
                                             hn::MulAdd(t, nodes[2], hn::Set(d, origin.z))));
    }
    return hn::Exp(d, hn::Neg(hn::Mul(sum, hn::Mul(hn::Sub(distance, begin), hn::Set(d, 1.0f / steps)))));
}

// Optical depth of a voxel ball's radius in the extinction at the receivers.
V radius_depth(D d, const FarLights& l, const Receivers& r, std::size_t at) {
    const V p[3] = {hn::LoadU(d, &r.x[at]), hn::LoadU(d, &r.y[at]), hn::LoadU(d, &r.z[at])};
    V n[3];
    for (int a = 0; a < 3; ++a)
        n[a] = dot(d, p[0], p[1], p[2], glm::row(l.index_from_local, a));
    return hn::Mul(sample_extinction(d, *l.extinction, n[0], n[1], n[2]), hn::Set(d, l.ball));
}

// The way between one light and a group of receivers.
struct Way {
    V to_light[3];    // from the receivers [m]
    V from_light[3];  // unit
    V square, inverse, distance;
};

HWY_INLINE Way way_between(D d, const vec3& light, const Receivers& r, std::size_t at) {
    Way way;
    way.to_light[0] = hn::Sub(hn::Set(d, light.x), hn::LoadU(d, &r.x[at]));
    way.to_light[1] = hn::Sub(hn::Set(d, light.y), hn::LoadU(d, &r.y[at]));
    way.to_light[2] = hn::Sub(hn::Set(d, light.z), hn::LoadU(d, &r.z[at]));
    const V* const t = way.to_light;
    way.square = dot(t[0], t[1], t[2], t[0], t[1], t[2]);
    const V safe = hn::Max(way.square, hn::Set(d, 1e-30f));
    way.inverse = reciprocal_sqrt(d, safe);
    way.distance = hn::Mul(safe, way.inverse);
    const V minus = hn::Neg(way.inverse);
    for (int a = 0; a < 3; ++a)
        way.from_light[a] = hn::Mul(t[a], minus);
    return way;
}

// Cosines at both ends of the way: `leaves`, of the light's normal, and `turns`, of the direction in which receivers
// send light on, which for surfaces is their normal.
struct Cosines {
    V leaves, turns;
};

HWY_INLINE Cosines cosines_at_ends(D d, const FarLights& l, std::uint32_t i, const Way& way, const Receivers& r,
                                   std::size_t at, const FarOutput& out) {
    const V* const w = way.from_light;
    return {l.lobes ? dot(d, w[0], w[1], w[2], l.lobes[i].normal) : hn::Zero(d),
            out.scattered ? dot(w[0], w[1], w[2], hn::LoadU(d, &r.out_x[at]), hn::LoadU(d, &r.out_y[at]),
                                hn::LoadU(d, &r.out_z[at]))
                          : hn::Zero(d)};
}

// What arrives without smoke in between, of a light of intensity 1 [1/m^2], and the cosines of surfaces at both ends.
struct Arriving {
    V inverse_square, cosine_there, cosine_here;
};

HWY_INLINE Arriving arriving(D d, const FarLights& l, std::uint32_t i, const Way& way, const Cosines& ends,
                             const Receivers& r, std::size_t at, bool surface_receives) {
    Arriving out{hn::Mul(way.inverse, way.inverse), hn::Max(ends.leaves, hn::Zero(d)),
                 hn::Max(hn::Neg(ends.turns), hn::Zero(d))};
    if (!l.bottom)
        return out;
    if (l.lobes) {
        const auto disc = disc_of_light(d, l, way.square, way.distance, ends.leaves);
        out.inverse_square = disc.inverse_square, out.cosine_there = disc.cosine;
    } else if (surface_receives && !l.balls) {
        const V width = width_of_voxel(d, l.edges, hn::LoadU(d, &r.out_x[at]), hn::LoadU(d, &r.out_y[at]),
                                       hn::LoadU(d, &r.out_z[at]));
        const auto disc = voxel_from_surface(d, l, way.square, way.distance, hn::Neg(ends.turns), width);
        out.inverse_square = disc.inverse_square, out.cosine_here = disc.cosine;
    } else {
        out.inverse_square = ball_kernel(d, l.balls ? l.balls[i].radius : l.ball, way.distance);
    }
    return out;
}

// `w` times what the smoke lets through. `beyond`: all receivers are reached by the end of the light's map.
HWY_INLINE V shaded(D d, const FarLights& l, std::uint32_t i, bool beyond, const Way& way, const Receivers& r,
                    std::size_t at, V w) {
    const V surface = hn::Min(hn::Set(d, l.balls ? l.balls[i].radius : 0.0f), way.distance);  // where shadows begin
    const V* const from = way.from_light;
    if (beyond) {
        w = hn::Mul(w, end_transmittance(d, l.layout, l.end(i), from[0], from[1], from[2]));
    } else if (l.shadow == FarLights::Shadow::Maps) {
        w = hn::Mul(
            w, map_transmittance(d, l.layout, l.map(i), from[0], from[1], from[2], hn::Sub(way.distance, surface)));
    } else if (l.shadow == FarLights::Shadow::Exact) {
        V t = exact_transmittance(d, l, l.position[i], way.to_light, way.distance, surface);
        if (l.bottom && !l.balls)
            t = ball_transmittance(d, l.ball, way.distance, t, radius_depth(d, l, r, at));
        w = hn::Mul(w, t);
    }
    if (l.balls && l.shadow != FarLights::Shadow::None)
        w = hn::Mul(w, hn::IfThenElse(hn::Lt(way.distance, hn::Set(d, l.balls[i].radius)),
                                      hn::Set(d, l.balls[i].inside), hn::Set(d, l.balls[i].escape)));
    return w;
}

// Intensity of a light in one channel toward the receivers. `by_cosine`: of its normal, times what that counts for.
HWY_INLINE V intensity_of(D d, const FarLights& l, std::uint32_t i, int channel, const BasisLanes<D>& basis,
                          V by_cosine) {
    const float share = l.lobes ? l.lobes[i].share : 0.0f;
    V intensity = hn::Set(d, l.intensity[i][channel]);
    if (l.directional && share < 1.0f)
        for (int m = 0; m < kShMoments; ++m)
            intensity = hn::MulAdd(hn::Set(d, l.directional[i * 24 + 3 * m + channel]), basis.y[m], intensity);
    if (l.lobes)
        intensity =
            hn::MulAdd(by_cosine, hn::Set(d, l.intensity[i][channel]), hn::Mul(hn::Set(d, 1.0f - share), intensity));
    return intensity;
}

// One light, one group of receivers.
HWY_INLINE void light_group(D d, const FarLights& l, std::uint32_t i, bool beyond, const Receivers& r, std::size_t at,
                            const FarOutput& out) {
    const Way way = way_between(d, l.position[i], r, at);
    const V b = level_blend(d, l.radius, !l.bottom, !l.top, way.distance);
    if (hn::AllTrue(d, hn::Eq(b, hn::Zero(d))))
        return;
    const Cosines ends = cosines_at_ends(d, l, i, way, r, at, out);
    const bool surface_receives = out.scattered && out.kind == ReceiverKind::Surface;
    const Arriving arrives = arriving(d, l, i, way, ends, r, at, surface_receives);
    const V w = shaded(d, l, i, beyond, way, r, at, hn::Mul(arrives.inverse_square, b));

    const bool moments = out.moments || (l.directional && !(l.lobes && l.lobes[i].share == 1.0f));
    const auto basis =
        moments ? basis_lanes(d, way.from_light[0], way.from_light[1], way.from_light[2]) : BasisLanes<D>{};
    V phase = hn::Zero(d);
    if (out.scattered)
        phase = surface_receives ? hn::Mul(arrives.cosine_here, hn::Set(d, 1.0f / kPi))
                                 : henyey_greenstein_lanes(d, out.mean_cosine, ends.turns);
    // Lambert's intensity is four times its mean along the normal.
    const V by_cosine = hn::Mul(hn::Set(d, l.lobes ? 4.0f * l.lobes[i].share : 0.0f), arrives.cosine_there);
    for (int c = 0; c < 3; ++c) {
        const V light = hn::Mul(intensity_of(d, l, i, c, basis, by_cosine), w);
        accumulate(d, out.fluence + c * out.plane + at, light);
        if (out.scattered)
            accumulate(d, out.scattered + c * out.plane + at, hn::Mul(light, phase));
        if (out.moments)
            for (int m = 0; m < kShMoments; ++m)
                accumulate(d, out.moments + (3 * m + c) * out.plane + at, hn::Mul(light, basis.y[m]));
    }
}

// The map of a light, or its end, which begins to arrive in the nearest cache. Of large maps a block reads a small
// part.
HWY_INLINE void fetch_map(const FarLights& l, std::uint32_t i, bool ends) {
    constexpr std::size_t kLargest = 8192, kLine = 64;
    const std::size_t bytes = (ends ? ends_of(l.layout) : l.layout).bytes_per_light();
    if (l.shadow != FarLights::Shadow::Maps || bytes > kLargest || !l.has_map(i))
        return;
    const std::uint16_t* const map = ends ? l.end(i) : l.map(i);
    for (std::size_t at = 0; at < bytes; at += kLine)
        hwy::Prefetch(map + at / sizeof(*map));
}

// Maps are many times larger than the caches: that of the next light is fetched while one is evaluated.
std::uint64_t gather(const FarLights& l, const Receivers& r, const ReceiverBlock& block, const FarOutput& out) {
    const D d;
    const std::size_t lanes = hn::Lanes(d);
    const LevelRange range(l);
    const bool all_beyond = l.ends && l.are_outside(block.bounds);
    std::uint64_t evaluations = 0;
    for (std::size_t n = 0; n < l.list.size(); ++n) {
        const std::uint32_t i = l.list[n];
        if (n + 1 < l.list.size())
            fetch_map(l, l.list[n + 1], all_beyond);
        if (!l.has_map(i))  // no receiver needs it
            continue;
        for (std::size_t g = block.first_group; g < block.first_group + block.group_count; ++g) {
            if (!range.meets(r.group_bounds[g], l.position[i]))
                continue;
            const bool beyond = l.ends && l.are_outside(r.group_bounds[g]);
            for (std::size_t k = 0; k < Receivers::kGroup; k += lanes)
                light_group(d, l, i, beyond, r, g * Receivers::kGroup + k, out);
            evaluations += Receivers::kGroup;
        }
    }
    return evaluations;
}

const char* instruction_set() {
    return hwy::TargetName(HWY_TARGET);
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brisance {

HWY_EXPORT(gather);
HWY_EXPORT(instruction_set);

std::uint64_t gather_far(const FarLights& lights, const Receivers& receivers, const ReceiverBlock& block,
                         const FarOutput& output) {
    return HWY_DYNAMIC_DISPATCH(gather)(lights, receivers, block, output);
}

bool may_reach(const FarLights& lights, std::uint32_t light, const Receivers& receivers, const ReceiverBlock& block) {
    const LevelRange range(lights);
    const vec3& p = lights.position[light];
    for (std::size_t g = block.first_group; g < block.first_group + block.group_count; ++g) {
        if (!range.meets(receivers.group_bounds[g], p))
            continue;
        for (std::size_t i = g * Receivers::kGroup; i < (g + 1) * Receivers::kGroup; ++i)
            if (range.includes({receivers.x[i], receivers.y[i], receivers.z[i]}, p))
                return true;
    }
    return false;
}

const char* gather_instruction_set() {
    return HWY_DYNAMIC_DISPATCH(instruction_set)();
}

}  // namespace brisance
#endif
