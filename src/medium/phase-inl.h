// The Henyey-Greenstein phase function of a vector of cosines (phase.h). Included once per instruction set by kernels
// that are compiled through Highway's foreach_target.

#if defined(BRISANCE_MEDIUM_PHASE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BRISANCE_MEDIUM_PHASE_INL_H_
#undef BRISANCE_MEDIUM_PHASE_INL_H_
#else
#define BRISANCE_MEDIUM_PHASE_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

#include "medium/phase.h"

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V henyey_greenstein_lanes(D d, float g, V cosine) {
    const float h = std::abs(g);
    const V c = g < 0.0f ? hn::Neg(cosine) : cosine;
    const V denominator =
        hn::MulAdd(hn::Set(d, 2.0f * h), hn::Sub(hn::Set(d, 1.0f), c), hn::Set(d, (1.0f - h) * (1.0f - h)));
    return hn::Div(hn::Set(d, (1.0f - g * g) / (4.0f * kPi)), hn::Mul(denominator, hn::Sqrt(denominator)));
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#endif
