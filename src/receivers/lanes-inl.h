// Arithmetic on vectors of receivers. Included once per instruction set by kernels that are compiled through Highway's
// foreach_target.

#if defined(BRISANCE_RECEIVERS_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BRISANCE_RECEIVERS_LANES_INL_H_
#undef BRISANCE_RECEIVERS_LANES_INL_H_
#else
#define BRISANCE_RECEIVERS_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "medium/sh.h"

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The processor's estimate refined by one Newton step reaches single precision to a bit or two and costs far less than
// a division.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V reciprocal(D d, V x) {
    const V r = hn::ApproximateReciprocal(x);
    return hn::Mul(r, hn::NegMulAdd(x, r, hn::Set(d, 2.0f)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V reciprocal_sqrt(D d, V x) {
    const V r = hn::ApproximateReciprocalSqrt(x);
    return hn::Mul(r, hn::NegMulAdd(hn::Mul(hn::Set(d, 0.5f), x), hn::Mul(r, r), hn::Set(d, 1.5f)));
}

template <class V>
HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
    return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V dot(D d, V x, V y, V z, const vec3& v) {
    return dot(x, y, z, hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z));
}

// What a level of the hierarchy has of a light at this distance (gathering/gather.h): where it rises, over [radius / 2,
// radius], and where it falls, over [radius, 2 radius].
template <class D, class V = hn::Vec<D>>
HWY_INLINE V level_blend(D d, float radius, bool rises, bool falls, V distance) {
    const V t = hn::Mul(distance, hn::Set(d, 1.0f / radius));
    V b = rises ? hn::Sub(hn::Add(t, t), hn::Set(d, 1.0f)) : hn::Set(d, 1.0f);
    if (falls)
        b = hn::Min(b, hn::Sub(hn::Set(d, 2.0f), t));
    return hn::Min(hn::Max(b, hn::Zero(d)), hn::Set(d, 1.0f));
}

// Real spherical harmonics of degrees 1 and 2 (sh.h).
template <class D>
struct BasisLanes {
    hn::Vec<D> y[kShMoments];
};

// Of unit directions.
template <class D, class V = hn::Vec<D>>
HWY_INLINE BasisLanes<D> basis_lanes(D d, V x, V y, V z) {
    const auto c = [&](float v) { return hn::Set(d, v); };
    return {{hn::Mul(c(kSh1), y), hn::Mul(c(kSh1), z), hn::Mul(c(kSh1), x), hn::Mul(c(kSh2a), hn::Mul(x, y)),
             hn::Mul(c(kSh2a), hn::Mul(y, z)), hn::MulAdd(c(3.0f * kSh2b), hn::Mul(z, z), c(-kSh2b)),
             hn::Mul(c(kSh2a), hn::Mul(x, z)), hn::Mul(c(kSh2c), hn::Sub(hn::Mul(x, x), hn::Mul(y, y)))}};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void accumulate(D d, float* to, V value) {
    hn::StoreU(hn::Add(hn::LoadU(d, to), value), d, to);
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#endif
