#include "elimination/leaf_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elimination/leaf_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kLeafSize>;
using V = hn::Vec<D>;
constexpr std::size_t kLanes = hn::MaxLanes(D());
using D64 = hn::CappedTag<std::int64_t, kLeafSize>;
using D32 = hn::Rebind<std::int32_t, D64>;

HWY_INLINE V square_distance(D d, const Leaf& leaf, std::size_t k, const vec3& p) {
    const V x = hn::Sub(hn::Load(d, leaf.x + k), hn::Set(d, p.x));
    const V y = hn::Sub(hn::Load(d, leaf.y + k), hn::Set(d, p.y));
    const V z = hn::Sub(hn::Load(d, leaf.z + k), hn::Set(d, p.z));
    return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
}

// The squared distances from p to a leaf's points; false where none is within reach.
HWY_INLINE bool squares_in_reach(D d, const Leaf& leaf, const vec3& p, V square_reach, V* squares) {
    bool any = false;
    for (std::size_t k = 0; k < kLeafSize; k += kLanes) {
        squares[k / kLanes] = square_distance(d, leaf, k, p);
        any = any || !hn::AllFalse(d, hn::Lt(squares[k / kLanes], square_reach));
    }
    return any;
}

// As pair_weight().
HWY_INLINE auto weight(D d, V distance, V inverse_reach, float least) {
    const V t = hn::Max(hn::Mul(distance, inverse_reach), hn::Set(d, least));
    const V u = hn::Max(hn::Sub(hn::Set(d, 1.0f), t), hn::Zero(d));
    const V square = hn::Mul(u, u), fourth = hn::Mul(square, square);
    return hn::NearestInt(hn::Mul(hn::Mul(fourth, fourth), hn::Set(d, kWeightUnit)));
}

// A point adds to its own weight as any other at distance 0 does.
HWY_INLINE Weight own_weight(float least) {
    return pair_weight(0.0f, 1.0f, least);
}

void sum_weights(Leaf* leaves, std::uint32_t l, std::span<const std::uint32_t> list, float least) {
    const D d;
    const D64 d64;
    Leaf& leaf = leaves[l];
    HWY_ALIGN std::int32_t w[kLeafSize];
    for (std::size_t s = 0; s < kLeafSize && leaf.weight[s] >= 0; ++s) {
        const vec3 p(leaf.x[s], leaf.y[s], leaf.z[s]);
        const V inverse = hn::Set(d, leaf.inverse_reach[s]);
        auto sum = hn::Zero(d64);
        const V reach = hn::Set(d, square_reach(leaf.inverse_reach[s]));
        for (const std::uint32_t other : list) {
            V squares[kLeafSize / kLanes];
            if (!squares_in_reach(d, leaves[other], p, reach, squares))
                continue;
            for (std::size_t k = 0; k < kLeafSize; k += kLanes)
                hn::Store(weight(d, hn::Sqrt(squares[k / kLanes]), inverse, least), hn::RebindToSigned<D>(), w + k);
            for (std::size_t k = 0; k < kLeafSize; k += hn::Lanes(d64))
                sum = hn::Add(sum, hn::PromoteTo(d64, hn::Load(D32(), w + k)));
        }
        leaf.weight[s] = hn::GetLane(hn::SumOfLanes(d64, sum)) - own_weight(least);
    }
}

std::size_t count_in_reach(const Leaf* leaves, std::span<const std::uint32_t> list, const Leaf& leaf) {
    const D d;
    const vec3 p(leaf.x[0], leaf.y[0], leaf.z[0]);
    const V reach = hn::Set(d, square_reach(leaf.inverse_reach[0]));
    std::size_t count = 0;
    for (const std::uint32_t other : list)
        for (std::size_t k = 0; k < kLeafSize; k += kLanes)
            count += hn::CountTrue(d, hn::Lt(square_distance(d, leaves[other], k, p), reach));
    return count;
}

// Raises `heaviest` to the heaviest point of the leaf that is in reach of the probe, or reaches it.
bool raise(const Leaf& leaf, const Probe& probe, Probe& heaviest, std::uint32_t& slot) {
    bool raised = false;
    for (std::uint32_t s = 0; s < kLeafSize; ++s) {
        const vec3 gap = vec3(leaf.x[s], leaf.y[s], leaf.z[s]) - probe.position;
        const float inverse = std::min(leaf.inverse_reach[s], probe.inverse_reach);
        if (glm::dot(gap, gap) >= square_reach(inverse) || leaf.weight[s] < heaviest.weight ||
            (leaf.weight[s] == heaviest.weight && leaf.rank[s] <= heaviest.rank))
            continue;
        heaviest.weight = leaf.weight[s];
        heaviest.rank = leaf.rank[s];
        slot = s;
        raised = true;
    }
    return raised;
}

HWY_INLINE bool any_heavier(const Leaf& leaf, Weight weight) {
    const D64 d;
    auto heaviest = hn::Load(d, leaf.weight);
    for (std::size_t k = hn::Lanes(d); k < kLeafSize; k += hn::Lanes(d))
        heaviest = hn::Max(heaviest, hn::Load(d, leaf.weight + k));
    return !hn::AllFalse(d, hn::Gt(heaviest, hn::Set(d, weight - 1)));
}

std::optional<Slot> take_weights(const LeafView& view, std::span<const std::uint32_t> list, const Probe& probe,
                                 float least, Taken& taken) {
    const D d;
    const hn::RebindToSigned<D> di;
    const float own_reach = square_reach(probe.inverse_reach);
    Probe heaviest = probe;
    std::optional<Slot> found;
    for (std::size_t n = 0; n < list.size(); ++n) {
        const Leaf& leaf = view.leaves[list[n]];
        V squares[kLeafSize / kLanes];
        const V reach = hn::Set(d, std::max(own_reach, view.square_reach[list[n]]));
        taken.touched[n] = squares_in_reach(d, leaf, probe.position, reach, squares);
        if (!taken.touched[n])
            continue;
        std::uint32_t slot = 0;
        if (any_heavier(leaf, heaviest.weight) && raise(leaf, probe, heaviest, slot))
            found = Slot{list[n], slot};
        if (found)
            continue;
        for (std::size_t k = 0; k < kLeafSize; k += kLanes) {
            const V distance = hn::Sqrt(squares[k / kLanes]);
            hn::StoreU(weight(d, distance, hn::Load(d, leaf.inverse_reach + k), least), di,
                       taken.weight.data() + n * kLeafSize + k);
        }
    }
    return found;
}

void subtract_sixteen(Leaf& leaf, const std::int32_t* taken) {
    const D64 d;
    for (std::size_t k = 0; k < kLeafSize; k += hn::Lanes(d)) {
        const auto difference = hn::Sub(hn::Load(d, leaf.weight + k), hn::PromoteTo(d, hn::LoadU(D32(), taken + k)));
        hn::Store(difference, d, leaf.weight + k);
    }
}

void subtract_point(Leaf& leaf, const vec3& position, float least) {
    const D d;
    HWY_ALIGN std::int32_t w[kLeafSize];
    for (std::size_t k = 0; k < kLeafSize; k += hn::Lanes(d))
        hn::Store(
            weight(d, hn::Sqrt(square_distance(d, leaf, k, position)), hn::Load(d, leaf.inverse_reach + k), least),
            hn::RebindToSigned<D>(), w + k);
    subtract_sixteen(leaf, w);
}

void square_distances(const Leaf* leaves, std::span<const std::uint32_t> list, const vec3& p, float* squares) {
    const D d;
    for (const std::uint32_t l : list)
        for (std::size_t k = 0; k < kLeafSize; k += hn::Lanes(d), squares += hn::Lanes(d))
            hn::StoreU(square_distance(d, leaves[l], k, p), d, squares);
}

std::size_t count_up_to(const float* values, std::size_t n, float limit) {
    const D d;
    std::size_t count = 0;
    for (std::size_t k = 0; k < n; k += hn::Lanes(d))
        count += hn::CountTrue(d, hn::Le(hn::LoadU(d, values + k), hn::Set(d, limit)));
    return count;
}

float greatest_up_to(const float* values, std::size_t n, float limit) {
    const D d;
    V greatest = hn::Zero(d);
    for (std::size_t k = 0; k < n; k += hn::Lanes(d)) {
        const V v = hn::LoadU(d, values + k);
        greatest = hn::Max(greatest, hn::IfThenElseZero(hn::Le(v, hn::Set(d, limit)), v));
    }
    return hn::GetLane(hn::MaxOfLanes(d, greatest));
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brisance {

HWY_EXPORT(sum_weights);
HWY_EXPORT(count_in_reach);
HWY_EXPORT(take_weights);
HWY_EXPORT(subtract_sixteen);
HWY_EXPORT(subtract_point);
HWY_EXPORT(square_distances);
HWY_EXPORT(count_up_to);
HWY_EXPORT(greatest_up_to);

void sum_weights(Leaf* leaves, std::uint32_t leaf, std::span<const std::uint32_t> list, float least) {
    HWY_DYNAMIC_DISPATCH(sum_weights)(leaves, leaf, list, least);
}

std::size_t count_in_reach(const Leaf* leaves, std::span<const std::uint32_t> list, const Leaf& leaf) {
    return HWY_DYNAMIC_DISPATCH(count_in_reach)(leaves, list, leaf);
}

std::optional<Slot> take_weights(const LeafView& leaves, std::span<const std::uint32_t> list, const Probe& probe,
                                 float least, Taken& taken) {
    taken.resize(list.size());
    return HWY_DYNAMIC_DISPATCH(take_weights)(leaves, list, probe, least, taken);
}

void subtract(Leaf& leaf, const std::int32_t* taken) {
    HWY_DYNAMIC_DISPATCH(subtract_sixteen)(leaf, taken);
}

void subtract(Leaf& leaf, const vec3& position, float least) {
    HWY_DYNAMIC_DISPATCH(subtract_point)(leaf, position, least);
}

void square_distances(const Leaf* leaves, std::span<const std::uint32_t> list, const vec3& p, float* squares) {
    HWY_DYNAMIC_DISPATCH(square_distances)(leaves, list, p, squares);
}

std::size_t count_up_to(const float* values, std::size_t n, float limit) {
    return HWY_DYNAMIC_DISPATCH(count_up_to)(values, n, limit);
}

float greatest_up_to(const float* values, std::size_t n, float limit) {
    return HWY_DYNAMIC_DISPATCH(greatest_up_to)(values, n, limit);
}

}  // namespace brisance
#endif
