// What shadow maps let through, for vectors of receivers. Included once per instruction set by kernels that are
// compiled through Highway's foreach_target.

#if defined(BRISANCE_SHADOWS_MAP_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BRISANCE_SHADOWS_MAP_LOOKUP_INL_H_
#undef BRISANCE_SHADOWS_MAP_LOOKUP_INL_H_
#else
#define BRISANCE_SHADOWS_MAP_LOOKUP_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "receivers/lanes-inl.h"
#include "shadows/shadow_maps.h"

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Where a unit direction w lies in an octahedral map with a border.
template <class V>
struct TexelPosition {
    V s, t;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE TexelPosition<V> texel_position(D d, const ShadowMapLayout& layout, V wx, V wy, V wz) {
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
template <class D, class V = hn::Vec<D>>
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
template <class D, class V = hn::Vec<D>>
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

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#endif
