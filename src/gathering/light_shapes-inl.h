// What lights of some extent send to receivers close by, for vectors of them. Included once per instruction set by
// kernels that are compiled through Highway's foreach_target.

#if defined(BRISANCE_GATHERING_LIGHT_SHAPES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BRISANCE_GATHERING_LIGHT_SHAPES_INL_H_
#undef BRISANCE_GATHERING_LIGHT_SHAPES_INL_H_
#else
#define BRISANCE_GATHERING_LIGHT_SHAPES_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <cmath>

#include "gathering/far_kernels.h"
#include "receivers/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Mean of 1 / r^2 over a ball of radius a seen from distance x of its centre: 3/(4 a^3) (2a + (a^2 - x^2)/x
// ln|(a+x)/(a-x)|).
template <class D, class V = hn::Vec<D>>
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
template <class D, class V = hn::Vec<D>>
V ball_transmittance(D d, float a, V distance, V transmittance, V depth_of_radius) {
    const V edge = hn::Exp(d, hn::Neg(depth_of_radius));
    const V mean = hn::Div(hn::Sub(hn::Set(d, 1.0f), edge), hn::Max(depth_of_radius, hn::Set(d, 1e-6f)));
    const V centre = hn::IfThenElse(hn::Lt(depth_of_radius, hn::Set(d, 1e-3f)),
                                    hn::NegMulAdd(hn::Set(d, 0.5f), depth_of_radius, hn::Set(d, 1.0f)), mean);
    const V inside = hn::MulAdd(hn::Mul(distance, hn::Set(d, 1.0f / a)), hn::Sub(edge, centre), centre);
    return hn::IfThenElse(hn::Lt(distance, hn::Set(d, a)), inside, transmittance);
}

// The finest level where light meets a surface. There a voxel's side, as a disc of radius r, stands for what is that
// close: what it exchanges with a point at height h over its plane is about what a point does at h' = sqrt(h^2 + r^2 /
// 2), h' / (across^2 + h'^2)^(3/2). Over its middle at h = 0 that is all of the hemisphere, and 2 pi of an endless
// plane at any h. (A ball's mean of 1 / distance^2 is right for fluence; as flux it is 1.19 times as much at half a
// voxel.)
template <class V>
struct Disc {
    V inverse_square, cosine;
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE Disc<V> disc_at(D d, const FarLights& l, V height, V across_square) {
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
template <class D, class V = hn::Vec<D>>
HWY_INLINE Disc<V> disc_of_light(D d, const FarLights& l, V square, V distance, V cosine) {
    const V height = hn::Mul(distance, cosine);
    Disc<V> out =
        disc_at(d, l, hn::Max(height, hn::Zero(d)), hn::Max(hn::NegMulAdd(height, height, square), hn::Zero(d)));
    out.cosine = hn::IfThenElseZero(hn::Gt(height, hn::Set(d, -0.08f * l.ball)), out.cosine);  // 0.05 voxels
    return out;
}

// A voxel as surfaces see it: the part of it that is in front of them, from its middle. `width`: width_of_voxel(). What
// a light of several voxels stands for lies on the side on which its centre is.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Disc<V> voxel_from_surface(D d, const FarLights& l, V square, V distance, V cosine, V width) {
    const V height = hn::Mul(distance, cosine), half = hn::Set(d, 0.5f);
    V in_front = hn::Clamp(hn::Add(hn::Div(height, width), half), hn::Zero(d), hn::Set(d, 1.0f));
    const V middle = hn::Max(height, hn::Mul(half, hn::Mul(in_front, width)));
    if (!l.voxels)
        in_front = hn::IfThenElseZero(hn::Gt(height, hn::Zero(d)), hn::Set(d, 1.0f));
    Disc<V> out = disc_at(d, l, middle, hn::Max(hn::NegMulAdd(height, height, square), hn::Zero(d)));
    out.cosine = hn::Mul(in_front, out.cosine);
    return out;
}

// Thickness of a uniform layer whose heights over planes of unit normal n vary as much as those within a voxel: the
// root of the sum of squares of the edges' parts along n. Of a cube it is the edge, however n lies.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V width_of_voxel(D d, const mat3& edges, V nx, V ny, V nz) {
    V sum = hn::Set(d, 1e-30f);
    for (int a = 0; a < 3; ++a) {
        const V along = dot(d, nx, ny, nz, edges[a]);
        sum = hn::MulAdd(along, along, sum);
    }
    return hn::Sqrt(sum);
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#endif
