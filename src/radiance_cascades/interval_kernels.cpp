#include "radiance_cascades/interval_kernels.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "radiance_cascades/interval_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The four values at each probe's sample, interleaved. All probes' samples lie alike between their nodes, so that the
// eight weights are the same for all.
HWY_INLINE void sample_probes(const IntervalMarch& m, int sample, float* HWY_RESTRICT values) {
    int base[3];
    float f[3];
    for (int a = 0; a < 3; ++a) {
        const float offset = m.first[a] + float(sample) * m.step[a], low = std::floor(offset);
        base[a] = static_cast<int>(low);
        f[a] = offset - low;
    }
    const std::int64_t shift = (std::int64_t(base[0]) * m.stride_x + std::int64_t(base[1]) * m.stride_y + base[2]) * 4;
    const int row[4] = {0, m.stride_y * 4, m.stride_x * 4, (m.stride_x + m.stride_y) * 4};
    const float rows[4] = {(1 - f[0]) * (1 - f[1]), (1 - f[0]) * f[1], f[0] * (1 - f[1]), f[0] * f[1]};
#if HWY_TARGET == HWY_SCALAR
    for (int p = 0; p < m.count; ++p)
        for (int c = 0; c < 4; ++c) {
            const float* at = m.nodes + (std::int64_t(m.probe[p]) * 4 + shift + c);
            float sum = 0.0f;
            for (int r = 0; r < 8; ++r)
                sum += rows[r / 2] * (r % 2 ? f[2] : 1 - f[2]) * at[row[r / 2] + (r % 2) * 4];
            values[p * 4 + c] = sum;
        }
#elif HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
    // Two nodes that are neighbours along z fill a vector.
    const hn::FixedTag<float, 4> d4;
    const hn::FixedTag<float, 8> d8;
    hn::Vec<decltype(d8)> weight[4];
    for (int r = 0; r < 4; ++r)
        weight[r] = hn::ConcatLowerLower(d8, hn::Set(d8, rows[r] * f[2]), hn::Set(d8, rows[r] * (1 - f[2])));
    for (int p = 0; p < m.count; ++p) {
        const float* at = m.nodes + (std::int64_t(m.probe[p]) * 4 + shift);
        auto sum = hn::Mul(weight[0], hn::LoadU(d8, at));
        for (int r = 1; r < 4; ++r)
            sum = hn::MulAdd(weight[r], hn::LoadU(d8, at + row[r]), sum);
        hn::StoreU(hn::Add(hn::LowerHalf(d4, sum), hn::UpperHalf(d4, sum)), d4, values + p * 4);
    }
#else
    const hn::FixedTag<float, 4> d4;
    hn::Vec<decltype(d4)> weight[8];
    for (int r = 0; r < 8; ++r)
        weight[r] = hn::Set(d4, rows[r / 2] * (r % 2 ? f[2] : 1 - f[2]));
    for (int p = 0; p < m.count; ++p) {
        const float* at = m.nodes + (std::int64_t(m.probe[p]) * 4 + shift);
        auto sum = hn::Mul(weight[0], hn::LoadU(d4, at));
        for (int r = 1; r < 8; ++r)
            sum = hn::MulAdd(weight[r], hn::LoadU(d4, at + row[r / 2] + (r % 2) * 4), sum);
        hn::StoreU(sum, d4, values + p * 4);
    }
#endif
}

// Continues all intervals by a segment with these values.
HWY_INLINE void add_segment(const IntervalMarch& m, int sample, const float* HWY_RESTRICT values, Intervals& out) {
    const hn::CappedTag<float, 16> d;
    for (int p = 0; p < m.count; p += int(hn::Lanes(d))) {
        hn::Vec<decltype(d)> red, green, blue, extinction;
        hn::LoadInterleaved4(d, values + p * 4, red, green, blue, extinction);
        if (m.unhidden) {
            alignas(64) float open[16];
            for (int k = 0; k < int(hn::Lanes(d)); ++k)
                open[k] = m.unhidden[p + k] == kUnhidden || m.unhidden[p + k] > sample ? 1.0f : 0.0f;
            extinction = hn::Mul(extinction, hn::Load(d, open));
        }
        const auto depth = hn::Min(hn::Mul(extinction, hn::Set(d, m.length)), hn::Set(d, 80.0f));
        const auto stopped = hn::Neg(hn::Expm1(d, hn::Neg(depth)));  // keeps its digits in the thinnest smoke
        const auto before = hn::Load(d, out.transmittance + p);
        const auto w = hn::Mul(before, stopped);
        hn::Store(hn::MulAdd(w, red, hn::Load(d, out.red + p)), d, out.red + p);
        hn::Store(hn::MulAdd(w, green, hn::Load(d, out.green + p)), d, out.green + p);
        hn::Store(hn::MulAdd(w, blue, hn::Load(d, out.blue + p)), d, out.blue + p);
        hn::Store(hn::Sub(before, w), d, out.transmittance + p);
    }
}

void march(const IntervalMarch& m, Intervals& out) {
    alignas(64) float values[kProbesAtOnce * 4];
    std::fill_n(out.red, m.count, 0.0f);
    std::fill_n(out.green, m.count, 0.0f);
    std::fill_n(out.blue, m.count, 0.0f);
    std::fill_n(out.transmittance, m.count, 1.0f);
    for (int s = 0; s < m.samples; ++s) {
        sample_probes(m, s, values);
        add_segment(m, s, values, out);
    }
    for (int p = 0; p < m.count && m.unhidden; ++p)
        if (m.unhidden[p] != kUnhidden)
            out.transmittance[p] = 0.0f;
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brisance {

HWY_EXPORT(march);

void march_intervals(const IntervalMarch& m, Intervals& out) {
    HWY_DYNAMIC_DISPATCH(march)(m, out);
}

}  // namespace brisance
#endif
