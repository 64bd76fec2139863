#include "surface_lighting/shared_targets.h"

#include <algorithm>

namespace brisance {

namespace {

// Largest distance of receivers from the first of their neighbourhood, relative to their distance from the medium's
// bounds, and relative to a voxel where that is more.
constexpr float kNearbyOfDistance = 0.1f, kNearbyOfVoxel = 4.0f;
// Least cosine between their normals.
constexpr float kNearbyFacing = 0.999f;

constexpr int kDrawsOfTargets = 2;  // of VisibilityRatio::kDraws points each

}  // namespace

void WeightedTargets::add(std::span<const VisibilityRatio::Draw> draws) {
    for (const VisibilityRatio::Draw& d : draws)
        if (d.weight > 0.0f) {
            points_.push_back(d.point);
            passed_.push_back(sum_ += d.weight);
        }
}

const vec3& WeightedTargets::at(float u) const {
    const auto found = std::upper_bound(passed_.begin(), passed_.end() - 1, u * sum_);
    return points_[std::size_t(found - passed_.begin())];
}

Neighbourhoods::Neighbourhoods(const Medium& medium, const SharedReceivers& receivers,
                               std::span<const std::uint32_t> pixel_of, std::uint32_t width)
    : of_(receivers.count()) {
    const LocalBounds bounds = local_bounds(medium);
    const auto place = [&](std::uint32_t r) {
        return std::pair(pixel_of[r] / width, pixel_of[r] % width / kPixels);
    };
    const auto joins = [&](std::uint32_t first, std::uint32_t r) {
        const SurfaceReceiver &a = receivers[first], &b = receivers[r];
        const float reach = std::max(kNearbyOfDistance * bounds.distance(a.local), kNearbyOfVoxel * medium.spacing);
        return place(first) == place(r) && glm::distance(a.local, b.local) <= reach &&
               glm::dot(a.normal, b.normal) > kNearbyFacing;
    };
    for (std::uint32_t r = 0; r < of_.size(); ++r) {
        if (first_.empty() || !joins(first_.back(), r))
            first_.push_back(r);
        of_[r] = static_cast<std::uint32_t>(first_.size() - 1);
    }
}

WeightedTargets draw_targets(const VisibilityRatio& ratio, const SurfaceReceiver& receiver, Rng& rng) {
    const LitPoint lit{dvec3(receiver.local), dvec3(receiver.normal), LitPoint::Kind::Surface};
    WeightedTargets targets;
    std::array<VisibilityRatio::Draw, VisibilityRatio::kDraws> draws;
    for (int k = 0; k < kDrawsOfTargets && ratio.draw(lit, rng, draws); ++k)
        targets.add(draws);
    return targets;
}

}  // namespace brisance
