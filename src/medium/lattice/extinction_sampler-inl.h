// Trilinear samples of packed extinction, a vector of points at a time. Included once per instruction set by kernels
// that are compiled through Highway's foreach_target.

#if defined(BRISANCE_MEDIUM_EXTINCTION_SAMPLER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BRISANCE_MEDIUM_EXTINCTION_SAMPLER_INL_H_
#undef BRISANCE_MEDIUM_EXTINCTION_SAMPLER_INL_H_
#else
#define BRISANCE_MEDIUM_EXTINCTION_SAMPLER_INL_H_
#endif

#include <hwy/highway.h>

#include "medium/lattice/extinction_pyramid.h"

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Half floats widen to floats by moving their bits and adding 112 to the exponent; that maps 0 to 2^-15, which is taken
// off again after interpolation (weights sum to one). Stored values reach 60000, so 2^-15 is far below rounding.
constexpr float kHalfZero = 1.0f / 32768.0f;

template <class DI, class VI>
HWY_INLINE hn::Vec<hn::RebindToFloat<DI>> widened_half(DI di, VI bits) {
    return hn::BitCast(hn::RebindToFloat<DI>(), hn::Add(hn::ShiftLeft<13>(bits), hn::Set(di, 112 << 23)));
}

// Extinction [1/m] at points given in nodes of the level, relative to its reference node.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V sample_extinction(D d, const PackedExtinction& level, V x, V y, V z) {
    const hn::RebindToSigned<D> di;
    const V fx = hn::Floor(x), fy = hn::Floor(y), fz = hn::Floor(z);
    const auto ix = hn::ConvertTo(di, fx), iy = hn::ConvertTo(di, fy), iz = hn::ConvertTo(di, fz);
    const V tx = hn::Sub(x, fx), ty = hn::Sub(y, fy), tz = hn::Sub(z, fz);

    const auto brick = [&](auto i, int axis) {
        const auto b = hn::Sub(hn::ShiftRight<3>(i), hn::Set(di, level.min_brick[axis]));
        return hn::Min(hn::Max(b, hn::Zero(di)), hn::Set(di, level.extent[axis] - 1));
    };
    const auto row = hn::Add(hn::Mul(brick(ix, 0), hn::Set(di, level.extent[1])), brick(iy, 1));
    const auto entry = hn::Add(hn::Mul(row, hn::Set(di, level.extent[2])), brick(iz, 2));
    const auto seven = hn::Set(di, 7);
    const auto lx = hn::And(ix, seven), ly = hn::And(iy, seven), lz = hn::And(iz, seven);
    // word = first + (lx * 9 + ly) * 8 + lz
    auto word = hn::Add(hn::Add(hn::ShiftLeft<3>(lx), lx), ly);
    const auto first = hn::GatherIndex(di, level.directory, entry);
    if (hn::AllTrue(di, hn::Eq(first, hn::Zero(di))))  // empty bricks
        return hn::Zero(d);
    word = hn::Add(first, hn::Add(hn::ShiftLeft<3>(word), lz));

    const auto* words = reinterpret_cast<const std::int32_t*>(level.words);
    const auto along_z = [&](int offset) {
        const auto pair = hn::GatherIndex(di, words, hn::Add(word, hn::Set(di, offset)));
        const V low = widened_half(di, hn::And(pair, hn::Set(di, 0xffff)));
        const hn::RebindToUnsigned<D> du;
        const V high = widened_half(di, hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(du, pair))));
        return hn::MulAdd(tz, hn::Sub(high, low), low);
    };
    const V c00 = along_z(0), c01 = along_z(8), c10 = along_z(72), c11 = along_z(80);
    const V c0 = hn::MulAdd(ty, hn::Sub(c01, c00), c00);
    const V c1 = hn::MulAdd(ty, hn::Sub(c11, c10), c10);
    const V value = hn::Sub(hn::MulAdd(tx, hn::Sub(c1, c0), c0), hn::Set(d, kHalfZero));
    return hn::Mul(value, hn::Set(d, level.scale));
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#endif
