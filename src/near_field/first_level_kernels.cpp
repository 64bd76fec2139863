#include "near_field/first_level_kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "near_field/first_level_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "medium/phase-inl.h"
#include "medium/sh.h"
#include "receivers/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 8>;  // a row is eight cells
using V = hn::Vec<D>;

// Taps are loaded once for so many rows.
constexpr std::size_t kRowsAtOnce = 2;

// What one light after another sends to the receivers of a row.
struct RowLight {
    V shift[3];
    V to_light[3];  // from receivers [m]
    V inverse;      // of distances [1/m]
    V weight;       // blend / distance^2 [1/m^2]
    bool dark;
};

HWY_INLINE RowLight row_light(D d, const FirstLevelBlock& b, const FlatSeparations::Separation& s, int at) {
    RowLight row;
    const float* const light = b.light + at + s.offset;
    const V any = hn::Or(hn::LoadU(d, light), hn::Or(hn::LoadU(d, light + b.plane), hn::LoadU(d, light + 2 * b.plane)));
    row.dark = hn::AllTrue(d, hn::Eq(any, hn::Zero(d)));
    if (row.dark)
        return row;
    for (int a = 0; a < 3; ++a) {
        row.shift[a] = hn::LoadU(d, light + (3 + a) * b.plane);
        row.to_light[a] = hn::Add(hn::Set(d, s.to_vertex[a]), row.shift[a]);
    }
    const V square = hn::Max(
        dot(row.to_light[0], row.to_light[1], row.to_light[2], row.to_light[0], row.to_light[1], row.to_light[2]),
        hn::Set(d, 1e-30f));
    row.inverse = reciprocal_sqrt(d, square);
    const V share = level_blend(d, b.radius, true, true, hn::Mul(square, row.inverse));
    row.dark = hn::AllTrue(d, hn::Eq(share, hn::Zero(d)));
    row.weight = hn::Mul(share, hn::Mul(row.inverse, row.inverse));
    return row;
}

// Multiplies the weights by transmittances.
template <int kRows>
HWY_INLINE void extinguish(D d, const FlatSeparations& all, const FlatSeparations::Separation& s,
                           const FirstLevelBlock& b, const int* at, RowLight* rows) {
    V depth[kRows], change[kRows][3];
    for (int r = 0; r < kRows; ++r)
        depth[r] = change[r][0] = change[r][1] = change[r][2] = hn::Zero(d);
    const FlatSeparations::Tap* const last = all.taps.data() + s.last_tap;
    for (const FlatSeparations::Tap* tap = all.taps.data() + s.first_tap; tap != last; ++tap) {
        const V length = hn::Set(d, tap->length);
        const V x = hn::Set(d, tap->change[0]), y = hn::Set(d, tap->change[1]), z = hn::Set(d, tap->change[2]);
        for (int r = 0; r < kRows; ++r) {
            const V extinction = hn::LoadU(d, b.extinction + at[r] + tap->offset);
            depth[r] = hn::MulAdd(length, extinction, depth[r]);
            change[r][0] = hn::MulAdd(x, extinction, change[r][0]);
            change[r][1] = hn::MulAdd(y, extinction, change[r][1]);
            change[r][2] = hn::MulAdd(z, extinction, change[r][2]);
        }
    }
    for (int r = 0; r < kRows; ++r) {
        V shifted = hn::Add(depth[r], dot(change[r][0], change[r][1], change[r][2], rows[r].shift[0], rows[r].shift[1],
                                          rows[r].shift[2]));
        if (s.own)
            shifted = hn::Div(depth[r], rows[r].inverse);
        const V positive = hn::Min(hn::Max(shifted, hn::Zero(d)), hn::Set(d, 80.0f));
        rows[r].weight = hn::Mul(rows[r].weight, hn::Exp(d, hn::Neg(positive)));
    }
}

// What arrives at a row, side by side: planes of a block lie so far apart that they would share few lines of a cache.
struct alignas(64) RowSums {
    static constexpr int kLanes = BrickLattice::kSize;
    float fluence[3][kLanes] = {}, scattered[3][kLanes] = {}, moments[3 * kShMoments][kLanes] = {};

    void add_to(const FirstLevelBlock& b, int in_block, int lanes) const {
        const auto add = [&](const auto& planes, float* to) {
            for (std::size_t c = 0; to && c < std::size(planes); ++c)
                for (int i = 0; i < lanes; ++i)
                    to[c * b.kCells + std::size_t(in_block + i)] += planes[c][i];
        };
        add(fluence, b.fluence);
        add(scattered, b.scattered);
        add(moments, b.moments);
    }
};

// Adds what arrives at a row, whose first cell is `in_block`.
HWY_INLINE void add_row(D d, const FirstLevelBlock& b, const RowLight& row, int light, int in_block, RowSums& sums) {
    const V minus = hn::Neg(row.inverse);
    const V x = hn::Mul(row.to_light[0], minus), y = hn::Mul(row.to_light[1], minus),
            z = hn::Mul(row.to_light[2], minus);
    V phase = hn::Zero(d);
    if (b.scattered) {
        const float* const camera = b.toward_camera + in_block;
        phase = henyey_greenstein_lanes(
            d, b.mean_cosine,
            dot(x, y, z, hn::LoadU(d, camera), hn::LoadU(d, camera + b.kCells), hn::LoadU(d, camera + 2 * b.kCells)));
    }
    const auto basis = b.moments || b.directional ? basis_lanes(d, x, y, z) : BasisLanes<D>{};
    for (int c = 0; c < 3; ++c) {
        V intensity = hn::LoadU(d, b.light + c * b.plane + light);
        if (b.directional)
            for (int m = 0; m < kShMoments; ++m)
                intensity =
                    hn::MulAdd(basis.y[m], hn::LoadU(d, b.directional + (3 * m + c) * b.plane + light), intensity);
        const V arriving = hn::Mul(intensity, row.weight);
        accumulate(d, sums.fluence[c], arriving);
        if (b.scattered)
            accumulate(d, sums.scattered[c], hn::Mul(arriving, phase));
        if (b.moments)
            for (int m = 0; m < kShMoments; ++m)
                accumulate(d, sums.moments[3 * m + c], hn::Mul(arriving, basis.y[m]));
    }
}

// Lights up to kRowsAtOnce rows, a vector from their cell z on.
std::uint64_t light_rows(D d, const FlatSeparations& all, const FirstLevelBlock& b,
                         std::span<const FirstLevelBlock::Row> rows, int z) {
    RowSums sums[kRowsAtOnce];
    std::uint64_t reached = 0;
    for (const FlatSeparations::Separation& s : all.separations) {
        RowLight lit[kRowsAtOnce];
        int at[kRowsAtOnce] = {}, count = 0;
        std::size_t row[kRowsAtOnce] = {};
        for (std::size_t r = 0; r < rows.size(); ++r) {
            at[count] = rows[r].in_box + z;
            row[count] = r;
            lit[count] = row_light(d, b, s, at[count]);
            count += !lit[count].dark;
        }
        if (count == int(kRowsAtOnce))
            extinguish<int(kRowsAtOnce)>(d, all, s, b, at, lit);
        else if (count == 1)
            extinguish<1>(d, all, s, b, at, lit);
        for (int k = 0; k < count; ++k)
            add_row(d, b, lit[k], at[k] + s.offset, rows[row[k]].in_block + z, sums[row[k]]);
        reached += std::uint64_t(count);
    }
    for (std::size_t r = 0; r < rows.size(); ++r)
        sums[r].add_to(b, rows[r].in_block + z, static_cast<int>(hn::Lanes(d)));
    return reached;
}

std::uint64_t first_level(const FlatSeparations& all, const FirstLevelBlock& b) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    std::uint64_t reached = 0;
    for (std::size_t i = 0; i < b.rows.size(); i += kRowsAtOnce)
        for (int z = 0; z < BrickLattice::kSize; z += lanes)
            reached +=
                light_rows(d, all, b, b.rows.subspan(i, std::min<std::size_t>(kRowsAtOnce, b.rows.size() - i)), z);
    return reached * std::uint64_t(lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brisance {

HWY_EXPORT(first_level);

FlatSeparations flatten(const FirstLevel& level, int parity, int wide) {
    const auto flat = [&](const ivec3& cell) { return (cell.x * wide + cell.y) * wide + cell.z; };
    const int plane = wide * wide * wide;
    const ivec3 own = FirstLevel::parity(parity);
    FlatSeparations out;
    for (const FirstLevel::Separation& s : level.separations(parity)) {
        const auto first = static_cast<int>(out.taps.size());
        for (const ShiftedTap& t : s.taps) {
            const ivec3 node = own + t.node, odd = node & 1;
            out.taps.push_back({(odd.x << 2 | odd.y << 1 | odd.z) * plane + flat((node - odd) >> 1),
                                t.length,
                                {t.change.x, t.change.y, t.change.z}});
        }
        out.separations.push_back({flat(s.vertex), s.to_vertex, s.own, first, static_cast<int>(out.taps.size())});
    }
    return out;
}

std::uint64_t gather_first_level(const FlatSeparations& separations, const FirstLevelBlock& block) {
    return HWY_DYNAMIC_DISPATCH(first_level)(separations, block);
}

}  // namespace brisance
#endif
