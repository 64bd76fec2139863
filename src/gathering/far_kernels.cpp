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

#include "medium/lattice/extinction_sampler-inl.h"
#include "medium/phase-inl.h"
#include "medium/sh.h"
#include "receivers/lanes-inl.h"

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

// Where a unit direction w lies in an octahedral map with a border.
struct TexelPosition {
    V s, t;
};

HWY_INLINE TexelPosition texel_position(D d, const ShadowMapLayout& layout, V wx, V wy, V wz) {
    const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    // A receiver on the light itself has no direction. Its blend weight is zero, so any texel will do.
    const V sum = hn::Max(hn::Add(hn::Add(hn::Abs(wx), hn::Abs(wy)), hn::Abs(wz)), hn::Set(d, 1e-3f));
    const V inv = reciprocal(d, sum);
    const V px = hn::Mul(wx, inv), py = hn::Mul(wy, inv);
    const auto lower = hn::Lt(wz, zero);
    const V u = hn::IfThenElse(lower, hn::CopySign(hn::Sub(one, hn::Abs(py)), wx), px);
    const V v = hn::IfThenElse(lower, hn::CopySign(hn::Sub(one, hn::Abs(px)), wy), py);
    // Texel centres are at half-integers of the interior; the border shifts them by one.
    const V half = hn::Set(d, 0.5f * layout.resolution), middle = hn::Set(d, 0.5f * layout.resolution + 0.5f);
    return {hn::MulAdd(u, half, middle), hn::MulAdd(v, half, middle)};
}

// Transmittance from a light's map toward unit direction w (light to receiver) at `distance`.
HWY_INLINE V map_transmittance(D d, const ShadowMapLayout& layout, const std::uint16_t* map, V wx, V wy, V wz,
                               V distance) {
    const hn::RebindToSigned<D> di;
    const hn::RebindToUnsigned<D> du;
    const V zero = hn::Zero(d);
    const auto [s, t] = texel_position(d, layout, wx, wy, wz);
    // Truncation equals the floor because all three coordinates are positive.
    const auto is = hn::ConvertTo(di, s), it = hn::ConvertTo(di, t);
    const V last = hn::Set(d, static_cast<float>(layout.distances - 1));
    const float samples_per_metre =
        layout.distances > 1 ? (layout.distances - 1) / (layout.far_distance - layout.near_distance) : 0.0f;
    const V k = hn::Min(
        hn::Max(hn::Mul(hn::Sub(distance, hn::Set(d, layout.near_distance)), hn::Set(d, samples_per_metre)), zero),
        last);
    const auto ik = hn::ConvertTo(di, k);
    const V as = hn::Sub(s, hn::ConvertTo(d, is)), at = hn::Sub(t, hn::ConvertTo(d, it));
    const V ak = hn::Sub(k, hn::ConvertTo(d, ik));

    const auto texel = hn::Add(hn::Mul(is, hn::Set(di, layout.side())), it);
    const auto word = hn::Add(hn::Mul(texel, hn::Set(di, layout.distances)), ik);
    V near[4], far[4];  // of the four texels around
    for (int corner = 0; corner < 4; ++corner) {
        const int texels = (corner >> 1) * layout.side() + (corner & 1);
        const auto offset = hn::Add(word, hn::Set(di, texels * layout.distances));
        const auto pair = hn::GatherOffset(du, reinterpret_cast<const std::uint32_t*>(map), hn::ShiftLeft<1>(offset));
        near[corner] = hn::ConvertTo(d, hn::BitCast(di, hn::And(pair, hn::Set(du, 0xffffu))));
        far[corner] = hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<16>(pair)));
    }
    const auto between = [&] {
        V t[4];
        for (int corner = 0; corner < 4; ++corner)
            t[corner] = hn::MulAdd(ak, hn::Sub(far[corner], near[corner]), near[corner]);
        const V t0 = hn::MulAdd(at, hn::Sub(t[1], t[0]), t[0]), t1 = hn::MulAdd(at, hn::Sub(t[3], t[2]), t[2]);
        return hn::MulAdd(as, hn::Sub(t1, t0), t0);
    };
    V transmittance = between();
    if (layout.geometric) {
        V least = near[0];
        for (int corner = 0; corner < 4; ++corner) {
            least = hn::Min(least, hn::Min(near[corner], far[corner]));
            near[corner] = hn::Log(d, hn::Max(near[corner], hn::Set(d, 0.5f)));
            far[corner] = hn::Log(d, hn::Max(far[corner], hn::Set(d, 0.5f)));
        }
        transmittance = hn::IfThenElse(hn::Lt(least, hn::Set(d, 0.5f)), transmittance, hn::Exp(d, between()));
    }
    return hn::Mul(transmittance, hn::Set(d, layout.range / 65535.0f));
}

// The same beyond the medium, of the map's end. Texels that lie beside each other are read in pairs.
HWY_INLINE V end_transmittance(D d, const ShadowMapLayout& layout, const std::uint16_t* end, V wx, V wy, V wz) {
    const hn::RebindToSigned<D> di;
    const hn::RebindToUnsigned<D> du;
    const auto [s, t] = texel_position(d, layout, wx, wy, wz);
    const auto is = hn::ConvertTo(di, s), it = hn::ConvertTo(di, t);
    const V as = hn::Sub(s, hn::ConvertTo(d, is)), at = hn::Sub(t, hn::ConvertTo(d, it));
    const auto texel = hn::Add(hn::Mul(is, hn::Set(di, layout.side())), it);
    V row[2];
    for (int k = 0; k < 2; ++k) {
        const auto offset = hn::Add(texel, hn::Set(di, k * layout.side()));
        const auto pair = hn::GatherOffset(du, reinterpret_cast<const std::uint32_t*>(end), hn::ShiftLeft<1>(offset));
        const V near = hn::ConvertTo(d, hn::BitCast(di, hn::And(pair, hn::Set(du, 0xffffu))));
        const V far = hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<16>(pair)));
        row[k] = hn::MulAdd(at, hn::Sub(far, near), near);
    }
    return hn::Mul(hn::MulAdd(as, hn::Sub(row[1], row[0]), row[0]), hn::Set(d, layout.range / 65535.0f));
}

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

// Mean of 1 / r^2 over a ball of radius a seen from distance x of its centre: 3/(4 a^3) (2a + (a^2 - x^2)/x
// ln|(a+x)/(a-x)|).
V ball_kernel(D d, float a, V distance) {
    const V one = hn::Set(d, 1.0f);
    // Away from 0 and a, where the formula is 0/0 and the function smooth.
    V t = hn::Max(hn::Mul(distance, hn::Set(d, 1.0f / a)), hn::Set(d, 1e-2f));
    t = hn::IfThenElse(hn::Lt(hn::Abs(hn::Sub(t, one)), hn::Set(d, 1e-4f)), hn::Set(d, 1.0f + 1e-4f), t);
    const V log = hn::Log(d, hn::Abs(hn::Div(hn::Add(one, t), hn::Sub(one, t))));
    const V near =
        hn::Mul(hn::MulAdd(hn::Div(hn::NegMulAdd(t, t, one), t), log, hn::Set(d, 2.0f)), hn::Set(d, 0.75f / (a * a)));
    const V inverse = hn::Div(one, hn::Max(distance, hn::Set(d, a)));
    const V far =
        hn::Mul(hn::Mul(inverse, inverse), hn::MulAdd(hn::Mul(inverse, inverse), hn::Set(d, 0.2f * a * a), one));
    return hn::IfThenElse(hn::Lt(distance, hn::Set(d, 4.0f * a)), near, far);
}

// Transmittance from a ball. Inside it, the value is interpolated between the mean over the ball seen from its centre
// and the transmittance of its radius.
V ball_transmittance(D d, float a, V distance, V transmittance, V depth_of_radius) {
    const V edge = hn::Exp(d, hn::Neg(depth_of_radius));
    const V mean = hn::Div(hn::Sub(hn::Set(d, 1.0f), edge), hn::Max(depth_of_radius, hn::Set(d, 1e-6f)));
    const V centre = hn::IfThenElse(hn::Lt(depth_of_radius, hn::Set(d, 1e-3f)),
                                    hn::NegMulAdd(hn::Set(d, 0.5f), depth_of_radius, hn::Set(d, 1.0f)), mean);
    const V inside = hn::MulAdd(hn::Mul(distance, hn::Set(d, 1.0f / a)), hn::Sub(edge, centre), centre);
    return hn::IfThenElse(hn::Lt(distance, hn::Set(d, a)), inside, transmittance);
}

HWY_INLINE V dot(D d, V x, V y, V z, const vec3& v) {
    return dot(x, y, z, hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z));
}

// The finest level where light meets a surface. There a voxel's side, as a disc of radius r, stands for what is that
// close: what it exchanges with a point at height h over its plane is about what a point does at h' = sqrt(h^2 + r^2 /
// 2), h' / (across^2 + h'^2)^(3/2). Over its middle at h = 0 that is all of the hemisphere, and 2 pi of an endless
// plane at any h. (A ball's mean of 1 / distance^2 is right for fluence; as flux it is 1.19 times as much at half a
// voxel.)
struct Disc {
    V inverse_square, cosine;
};
HWY_INLINE Disc disc_at(D d, const FarLights& l, V height, V across_square) {
    const float soft = 0.41357f * l.ball * l.ball;  // r^2 / 2: (4 pi / 3)^(2/3) / (2 pi)
    const V one = hn::Set(d, 1.0f), disc_square = hn::MulAdd(height, height, hn::Set(d, soft));
    const V disc_height = hn::Sqrt(disc_square), inverse = reciprocal_sqrt(d, hn::Add(across_square, disc_square));
    // It sends more along its plane than a point, which is lost where the level fades out, about the distance R: of an
    // endless plane 1 - h' / sqrt(R^2 + r^2 / 2) arrives instead of 1 - h / R.
    const float end = 1.442695f * l.radius;  // the harmonic mean of [1, 2] radii
    const V of_point = hn::NegMulAdd(height, hn::Set(d, 1.0f / end), one);
    const V of_disc = hn::NegMulAdd(disc_height, hn::Set(d, 1.0f / std::sqrt(end * end + soft)), one);
    const V least = hn::Set(d, 1e-2f);
    const V more = l.top ? one : hn::Div(hn::Max(of_point, least), hn::Max(of_disc, least));
    return {hn::Mul(inverse, inverse), hn::Mul(hn::Mul(disc_height, inverse), more)};
}

// A light on a surface: only what is in front of it is lit. `cosine`: between its normal and the way to the receiver.
// Lights lie a little above their surface, and receivers in its plane count as before it: rays tell those behind.
HWY_INLINE Disc disc_of_light(D d, const FarLights& l, V square, V distance, V cosine) {
    const V height = hn::Mul(distance, cosine);
    Disc out = disc_at(d, l, hn::Max(height, hn::Zero(d)), hn::Max(hn::NegMulAdd(height, height, square), hn::Zero(d)));
    out.cosine = hn::IfThenElseZero(hn::Gt(height, hn::Set(d, -0.08f * l.ball)), out.cosine);  // 0.05 voxels
    return out;
}

// A voxel as surfaces see it: the part of it that is in front of them, from its middle. What a light of several voxels
// stands for lies on the side on which its centre is.
HWY_INLINE Disc voxel_from_surface(D d, const FarLights& l, V square, V distance, V cosine) {
    const float width = 1.611992f * l.ball;  // (4 pi / 3)^(1/3)
    const V height = hn::Mul(distance, cosine), half = hn::Set(d, 0.5f);
    V in_front = hn::Clamp(hn::MulAdd(height, hn::Set(d, 1.0f / width), half), hn::Zero(d), hn::Set(d, 1.0f));
    const V middle = hn::Max(height, hn::Mul(half, hn::Mul(in_front, hn::Set(d, width))));
    if (!l.voxels)
        in_front = hn::IfThenElseZero(hn::Gt(height, hn::Zero(d)), hn::Set(d, 1.0f));
    Disc out = disc_at(d, l, middle, hn::Max(hn::NegMulAdd(height, height, square), hn::Zero(d)));
    out.cosine = hn::Mul(in_front, out.cosine);
    return out;
}

// Optical depth of a voxel ball's radius in the extinction at the receivers.
V radius_depth(D d, const FarLights& l, const Receivers& r, std::size_t at) {
    const V p[3] = {hn::LoadU(d, &r.x[at]), hn::LoadU(d, &r.y[at]), hn::LoadU(d, &r.z[at])};
    V n[3];
    for (int a = 0; a < 3; ++a)
        n[a] = dot(d, p[0], p[1], p[2], glm::row(l.index_from_local, a));
    return hn::Mul(sample_extinction(d, *l.extinction, n[0], n[1], n[2]), hn::Set(d, l.ball));
}

// One light, one group of receivers. `beyond`: all of them are reached by its map's end.
HWY_INLINE void light_group(D d, const FarLights& l, std::uint32_t i, bool beyond, const Receivers& r, std::size_t at,
                            const FarOutput& out) {
    const vec3 p = l.position[i];
    const V to_light[3] = {hn::Sub(hn::Set(d, p.x), hn::LoadU(d, &r.x[at])),
                           hn::Sub(hn::Set(d, p.y), hn::LoadU(d, &r.y[at])),
                           hn::Sub(hn::Set(d, p.z), hn::LoadU(d, &r.z[at]))};
    const V square = dot(to_light[0], to_light[1], to_light[2], to_light[0], to_light[1], to_light[2]);
    const V safe = hn::Max(square, hn::Set(d, 1e-30f));
    const V inverse = reciprocal_sqrt(d, safe);
    const V distance = hn::Mul(safe, inverse);
    const V b = level_blend(d, l.radius, !l.bottom, !l.top, distance);
    if (hn::AllTrue(d, hn::Eq(b, hn::Zero(d))))
        return;
    const V minus = hn::Neg(inverse);
    const V wx = hn::Mul(to_light[0], minus), wy = hn::Mul(to_light[1], minus), wz = hn::Mul(to_light[2], minus);
    const CosineLobe lobe = l.lobes ? l.lobes[i] : CosineLobe{vec3(0.0f), 0.0f};
    const V leaves = l.lobes ? dot(d, wx, wy, wz, lobe.normal) : hn::Zero(d);  // cosines
    const V turns = out.scattered ? dot(wx, wy, wz, hn::LoadU(d, &r.out_x[at]), hn::LoadU(d, &r.out_y[at]),
                                        hn::LoadU(d, &r.out_z[at]))
                                  : hn::Zero(d);
    const bool surface_receives = out.kind == ReceiverKind::Surface;
    V w = hn::Mul(inverse, inverse);
    V cosine_there = hn::Max(leaves, hn::Zero(d)), cosine_here = hn::Max(hn::Neg(turns), hn::Zero(d));
    if (l.bottom && l.lobes) {
        const Disc disc = disc_of_light(d, l, square, distance, leaves);
        w = disc.inverse_square, cosine_there = disc.cosine;
    } else if (l.bottom && surface_receives && !l.balls) {
        const Disc disc = voxel_from_surface(d, l, square, distance, hn::Neg(turns));
        w = disc.inverse_square, cosine_here = disc.cosine;
    } else if (l.bottom) {
        w = ball_kernel(d, l.balls ? l.balls[i].radius : l.ball, distance);
    }
    w = hn::Mul(w, b);
    const V surface = hn::Min(hn::Set(d, l.balls ? l.balls[i].radius : 0.0f), distance);  // where shadows begin
    if (beyond) {
        w = hn::Mul(w, end_transmittance(d, l.layout, l.end(i), wx, wy, wz));
    } else if (l.shadow == FarLights::Shadow::Maps) {
        w = hn::Mul(w, map_transmittance(d, l.layout, l.map(i), wx, wy, wz, hn::Sub(distance, surface)));
    } else if (l.shadow == FarLights::Shadow::Exact) {
        V t = exact_transmittance(d, l, p, to_light, distance, surface);
        if (l.bottom && !l.balls)
            t = ball_transmittance(d, l.ball, distance, t, radius_depth(d, l, r, at));
        w = hn::Mul(w, t);
    }
    if (l.balls && l.shadow != FarLights::Shadow::None)
        w = hn::Mul(w, hn::IfThenElse(hn::Lt(distance, hn::Set(d, l.balls[i].radius)), hn::Set(d, l.balls[i].inside),
                                      hn::Set(d, l.balls[i].escape)));

    const bool moments = out.moments || (l.directional && !(l.lobes && l.lobes[i].share == 1.0f));
    const auto basis = moments ? basis_lanes(d, wx, wy, wz) : BasisLanes<D>{};
    V phase = hn::Zero(d);
    if (out.scattered)
        phase = surface_receives ? hn::Mul(cosine_here, hn::Set(d, 1.0f / kPi))
                                 : henyey_greenstein_lanes(d, out.mean_cosine, turns);
    // Lambert's intensity is four times its mean along the normal.
    const V by_cosine = hn::Mul(hn::Set(d, 4.0f * lobe.share), cosine_there);
    for (int c = 0; c < 3; ++c) {
        V intensity = hn::Set(d, l.intensity[i][c]);
        if (l.directional && lobe.share < 1.0f)
            for (int m = 0; m < kShMoments; ++m)
                intensity = hn::MulAdd(hn::Set(d, l.directional[i * 24 + 3 * m + c]), basis.y[m], intensity);
        if (l.lobes)
            intensity =
                hn::MulAdd(by_cosine, hn::Set(d, l.intensity[i][c]), hn::Mul(hn::Set(d, 1.0f - lobe.share), intensity));
        const V arriving = hn::Mul(intensity, w);
        accumulate(d, out.fluence + c * out.plane + at, arriving);
        if (out.scattered)
            accumulate(d, out.scattered + c * out.plane + at, hn::Mul(arriving, phase));
        if (out.moments)
            for (int m = 0; m < kShMoments; ++m)
                accumulate(d, out.moments + (3 * m + c) * out.plane + at, hn::Mul(arriving, basis.y[m]));
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
