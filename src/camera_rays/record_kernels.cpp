#include "camera_rays/record_kernels.h"

#include <algorithm>
#include <cstdint>

#include "medium/attenuation.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "camera_rays/record_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A record of `kSize` values in as few vectors as there can be; lanes beyond it are 0.
template <int kSize>
struct RecordLanes {
    using D = hn::CappedTag<float, (kSize > 8 ? 16 : 8)>;
    using V = hn::Vec<D>;
    static constexpr int kLanes = static_cast<int>(hn::MaxLanes(D())), kVectors = (kSize + kLanes - 1) / kLanes;
    V v[kVectors];

    static HWY_INLINE V load(const float* record, int i) {
        const D d;
        return (i + 1) * kLanes <= kSize
                   ? hn::LoadU(d, record + i * kLanes)
                   : hn::MaskedLoad(hn::FirstN(d, std::size_t(kSize - i * kLanes)), d, record + i * kLanes);
    }
    HWY_INLINE void load(const float* record) {
        for (int i = 0; i < kVectors; ++i)
            v[i] = load(record, i);
    }
    HWY_INLINE void store(float* record) const {
        const D d;
        for (int i = 0; i < kVectors; ++i)
            if ((i + 1) * kLanes <= kSize)
                hn::StoreU(v[i], d, record + i * kLanes);
            else
                hn::BlendedStore(v[i], hn::FirstN(d, std::size_t(kSize - i * kLanes)), d, record + i * kLanes);
    }
    HWY_INLINE void add(const RecordLanes& other, float times) {
        for (int i = 0; i < kVectors; ++i)
            v[i] = hn::MulAdd(other.v[i], hn::Set(D(), times), v[i]);
    }
};

// Where the middles of parts lie: in a voxel, by the first of its nodes, and in which part of it along each axis.
struct Places {
    static constexpr std::size_t kMost = 16;
    alignas(64) std::int32_t first[kMost];
    alignas(64) float x[kMost], y[kMost], z[kMost];

    // Of parts up to kMost of them.
    HWY_INLINE void find(const RayInBrick& ray, const RayPart* parts, std::size_t count) {
        const hn::CappedTag<float, kMost> d;
        const hn::RebindToSigned<decltype(d)> integers;
        alignas(64) float along[kMost] = {};
        for (std::size_t k = 0; k < count; ++k)
            along[k] = parts[k].along;
        for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
            const auto t = hn::Load(d, along + k);
            const auto of_axis = [&](int axis, float* rest) HWY_ATTR {
                const auto p = hn::MulAdd(t, hn::Set(d, ray.per_metre[axis]), hn::Set(d, ray.start[axis]));
                const auto inside = hn::Clamp(p, hn::Zero(d), hn::Set(d, float(BrickLattice::kSize)));
                const auto node = hn::Min(hn::ConvertTo(integers, inside), hn::Set(integers, BrickLattice::kSize - 1));
                hn::Store(hn::Sub(inside, hn::ConvertTo(d, node)), d, rest + k);
                return node;
            };
            const auto aside = hn::Set(integers, kRecordsAside);
            const auto row = hn::Add(hn::Mul(of_axis(0, x), aside), of_axis(1, y));
            hn::Store(hn::Add(hn::Mul(row, aside), of_axis(2, z)), integers, first + k);
        }
    }
};

// Half the distance between the two Gauss points of a part, over its length.
constexpr float kGaussOffset = 0.28867513f;

// The records at the corners of a voxel, and trilinearly between them.
template <int kSize>
class Corners {
public:
    using Lanes = RecordLanes<kSize>;
    using V = typename Lanes::V;

    // Of the voxel whose first node that is.
    HWY_INLINE void load(const float* records, int first) {
        constexpr int kRows[4] = {0, kRecordsAside, kRecordsAside * kRecordsAside, kRecordsAside * (kRecordsAside + 1)};
        for (int r = 0; r < 4; ++r) {
            low_[r].load(records + (first + kRows[r]) * kSize);
            high_[r].load(records + (first + kRows[r] + 1) * kSize);
        }
    }
    HWY_INLINE Lanes at(const vec3& p) const {
        const typename Lanes::D d;
        const V of_x = hn::Set(d, p.x), of_y = hn::Set(d, p.y), of_z = hn::Set(d, p.z);
        Lanes out;
        for (int i = 0; i < Lanes::kVectors; ++i) {
            V rows[4];
            for (int r = 0; r < 4; ++r)
                rows[r] = between(low_[r].v[i], high_[r].v[i], of_z);
            out.v[i] = between(between(rows[0], rows[1], of_y), between(rows[2], rows[3], of_y), of_x);
        }
        return out;
    }

private:
    static HWY_INLINE V between(V a, V b, V part) { return hn::MulAdd(part, hn::Sub(b, a), a); }
    Lanes low_[4], high_[4];
};

static_assert(SourceRecord::Extinction == 0);  // the first lane

// A ray's sums while parts are added.
template <bool kOutside, bool kEmits>
class Sums {
public:
    HWY_INLINE Sums(RecordSums& memory) : memory_(memory), sums_(memory) {
        own_.load(memory.own);
        if constexpr (kOutside)
            outside_.load(memory.outside);
        if constexpr (kEmits)
            emitted_.load(memory.emitted);
    }

    // Light that is that of one point over a length, at a distance from the ray's origin [m].
    HWY_INLINE void add(const RecordLanes<SourceRecord::Size>& own,
                        const RecordLanes<SurroundingsRecord::Size>& outside, float length, float distance) {
        const float extinction = hn::GetLane(own.v[0]), tau = extinction * length, mean = phi1(tau);
        const float path = sums_.transmittance * length * mean, opacity = path * extinction;
        sums_.transmittance *= 1.0f - tau * mean;
        sums_.depth += tau;
        sums_.opacity += opacity;
        sums_.distance += opacity * distance;
        own_.add(own, opacity);
        if constexpr (kOutside)
            outside_.add(outside, opacity);
        if constexpr (kEmits)
            emitted_.add(own, path);
    }
    HWY_INLINE bool opaque() const { return !(sums_.depth < kOpaqueDepth); }

    HWY_INLINE void put() const {
        memory_.transmittance = sums_.transmittance;
        memory_.depth = sums_.depth;
        memory_.opacity = sums_.opacity;
        memory_.distance = sums_.distance;
        own_.store(memory_.own);
        if constexpr (kOutside)
            outside_.store(memory_.outside);
        if constexpr (kEmits)
            emitted_.store(memory_.emitted);
    }

private:
    struct Scalars {
        float transmittance, depth, opacity, distance;
        explicit Scalars(const RecordSums& s)
            : transmittance(s.transmittance), depth(s.depth), opacity(s.opacity), distance(s.distance) {}
    };
    RecordSums& memory_;
    Scalars sums_;
    RecordLanes<SourceRecord::Size> own_, emitted_;
    RecordLanes<SurroundingsRecord::Size> outside_;
};

template <bool kOutside, bool kEmits>
HWY_INLINE void add_part(const RayInBrick& ray, const RayPart& part, const Places& places, std::size_t at,
                         Sums<kOutside, kEmits>& sums) {
    Corners<SourceRecord::Size> own;
    own.load(ray.own->value, places.first[at]);
    Corners<SurroundingsRecord::Size> outside;
    if constexpr (kOutside)
        outside.load(ray.outside->value, places.first[at]);
    const vec3 middle(places.x[at], places.y[at], places.z[at]);
    const auto add = [&](float offset, float length) HWY_ATTR {
        const vec3 p = middle + offset * ray.per_metre;
        RecordLanes<SurroundingsRecord::Size> around;
        if constexpr (kOutside)
            around = outside.at(p);
        sums.add(own.at(p), around, length, ray.distance + part.along + offset);
    };
    if (part.splits)
        for (const float side : {-kGaussOffset, kGaussOffset})
            add(side * part.length, 0.5f * part.length);
    else
        add(0.0f, part.length);
}

template <bool kOutside, bool kEmits>
bool add_parts_to(const RayInBrick& ray, const RayPart* parts, std::size_t count, RecordSums& memory) {
    Sums<kOutside, kEmits> sums(memory);
    Places places;
    for (std::size_t i = 0; !sums.opaque() && i < count; ++i) {
        const std::size_t at = i % Places::kMost;
        if (at == 0)
            places.find(ray, parts + i, std::min(count - i, Places::kMost));
        add_part(ray, parts[i], places, at, sums);
    }
    sums.put();
    return !sums.opaque();
}

bool add_parts(const RayInBrick& ray, bool emits, const RayPart* parts, std::size_t count, RecordSums& sums) {
    if (ray.outside)
        return emits ? add_parts_to<true, true>(ray, parts, count, sums)
                     : add_parts_to<true, false>(ray, parts, count, sums);
    return emits ? add_parts_to<false, true>(ray, parts, count, sums)
                 : add_parts_to<false, false>(ray, parts, count, sums);
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brisance {

HWY_EXPORT(add_parts);

bool add_parts(const RayInBrick& ray, bool emits, const RayPart* parts, std::size_t count, RecordSums& sums) {
    return HWY_DYNAMIC_DISPATCH(add_parts)(ray, emits, parts, count, sums);
}

}  // namespace brisance
#endif
