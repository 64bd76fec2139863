#include "optical_depths/cone_depths.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optical_depths/cone_depths.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "medium/lattice/extinction_sampler-inl.h"

#ifndef BRISANCE_GATHERING_PACKED_CONES
#define BRISANCE_GATHERING_PACKED_CONES
namespace brisance {

// Planar; in nodes of the finest level.
struct PackedCones {
    static constexpr int kMost = ConeDepths::kCones;
    alignas(64) float x[kMost] = {}, y[kMost] = {}, z[kMost] = {};     // apex
    alignas(64) float dx[kMost] = {}, dy[kMost] = {}, dz[kMost] = {};  // unit direction
    alignas(64) float begin[kMost] = {}, end[kMost] = {};              // distances of entry and exit
    alignas(64) float sum[kMost] = {};                                 // extinction times nodes
    float first = 0.0f, last = 0.0f;                                   // of all: least entry, largest exit
};

}  // namespace brisance
#endif

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, PackedCones::kMost>;

// Adds the extinction at the middle of what each cone has in [at, at + step], times its length. `level`: 2^l = step.
void add_step(const PackedExtinction& level, float at, float step, int count, PackedCones& cones) {
    const D d;
    const auto scale = hn::Set(d, 1.0f / step), half = hn::Set(d, 0.5f);
    for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(d))) {
        const auto from = hn::Max(hn::Set(d, at), hn::Load(d, cones.begin + k));
        const auto to = hn::Min(hn::Set(d, at + step), hn::Load(d, cones.end + k));
        const auto length = hn::Max(hn::Sub(to, from), hn::Zero(d));
        const auto middle = hn::Mul(half, hn::Add(from, to));
        const auto along = [&](const float* apex, const float* direction) {
            return hn::Mul(scale, hn::MulAdd(middle, hn::Load(d, direction + k), hn::Load(d, apex + k)));
        };
        const auto extinction =
            sample_extinction(d, level, along(cones.x, cones.dx), along(cones.y, cones.dy), along(cones.z, cones.dz));
        hn::Store(hn::MulAdd(length, extinction, hn::Load(d, cones.sum + k)), d, cones.sum + k);
    }
}

void sum_extinction_in_cones(const std::vector<PackedExtinction>& levels, float widening, int count,
                             PackedCones& cones) {
    int level = 0;
    float step = 1.0f;
    for (float at = cones.first; at < cones.last; at += step) {
        while (level + 1 < static_cast<int>(levels.size()) && 2.0f * step <= widening * at) {
            ++level;
            step *= 2.0f;
        }
        add_step(levels[level], at, step, count, cones);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brisance {

HWY_EXPORT(sum_extinction_in_cones);

ConeDepths::ConeDepths(const ExtinctionPyramid& pyramid) : nodes_from_local_(pyramid.medium().index_from_local) {
    for (int l = 0; l < pyramid.level_count(); ++l)
        levels_.push_back(pyramid.view(l));
    for (int a = 0; a < 3; ++a) {
        low_[a] = float(BrickLattice::kSize * levels_[0].min_brick[a]);
        high_[a] = low_[a] + float(BrickLattice::kSize * levels_[0].extent[a]);
    }
}

void ConeDepths::along(const std::array<Segment, kCones>& segments, int count, float widening,
                       std::array<float, kCones>& depth) const {
    PackedCones cones;
    std::array<float, kCones> metres{};
    cones.first = 1e30f;
    for (int k = 0; k < count; ++k) {
        const vec3 apex = nodes_from_local_ * segments[k].from, segment = nodes_from_local_ * segments[k].to - apex;
        const float length = glm::length(segment);
        if (!(length > 0.0f))
            continue;
        float enter = 0.0f, leave = 1.0f;
        for (int a = 0; a < 3; ++a) {
            const float to_low = low_[a] - apex[a], to_high = high_[a] - apex[a];
            if (segment[a] == 0.0f) {
                leave = to_low > 0.0f || to_high < 0.0f ? 0.0f : leave;
                continue;
            }
            enter = std::max(enter, (segment[a] > 0.0f ? to_low : to_high) / segment[a]);
            leave = std::min(leave, (segment[a] > 0.0f ? to_high : to_low) / segment[a]);
        }
        if (!(enter < leave))
            continue;
        cones.x[k] = apex.x, cones.y[k] = apex.y, cones.z[k] = apex.z;
        cones.dx[k] = segment.x / length, cones.dy[k] = segment.y / length, cones.dz[k] = segment.z / length;
        cones.begin[k] = enter * length, cones.end[k] = leave * length;
        cones.first = std::min(cones.first, cones.begin[k]);
        cones.last = std::max(cones.last, cones.end[k]);
        metres[k] = glm::distance(segments[k].from, segments[k].to) / length;
    }
    HWY_DYNAMIC_DISPATCH(sum_extinction_in_cones)(levels_, widening, count, cones);
    for (int k = 0; k < count; ++k)
        depth[k] = metres[k] * cones.sum[k];
}

}  // namespace brisance
#endif
