#include "base_lighting/shared_targets.h"

#include <algorithm>

namespace brisance {

namespace {

// Largest distance of receivers from the first of their neighbourhood, relative to their distance from the medium's
// bounds, and relative to a voxel where that is more.
constexpr float kNearbyOfDistance = 0.1f, kNearbyOfVoxel = 4.0f;
// Least cosine between their normals.
constexpr float kNearbyFacing = 0.999f;

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
                               std::span<const std::uint32_t> pixel_of, std::uint32_t width) {
    const LocalBounds bounds = local_bounds(medium);
    const auto joins = [&](const SurfaceReceiver& a, const SurfaceReceiver& b) {
        const float reach = std::max(kNearbyOfDistance * bounds.distance(a.local), kNearbyOfVoxel * medium.spacing);
        return glm::distance(a.local, b.local) <= reach && glm::dot(a.normal, b.normal) > kNearbyFacing;
    };
    std::vector<std::vector<std::uint32_t>> members;
    std::size_t here = 0;  // first neighbourhood of the present pixels
    std::pair<std::uint32_t, std::uint32_t> place;
    for (std::uint32_t r = 0; r < receivers.count(); ++r) {
        const std::pair now(pixel_of[r] / width, pixel_of[r] % width / kPixels);
        if (r == 0 || now != place)
            here = members.size();
        place = now;
        const auto found = std::find_if(members.begin() + std::ptrdiff_t(here), members.end(),
                                        [&](const auto& m) { return joins(receivers[m.front()], receivers[r]); });
        if (found == members.end())
            members.push_back({r});
        else
            found->push_back(r);
    }
    for (const std::vector<std::uint32_t>& m : members) {
        first_.push_back(static_cast<std::uint32_t>(receivers_.size()));
        receivers_.insert(receivers_.end(), m.begin(), m.end());
    }
    first_.push_back(static_cast<std::uint32_t>(receivers_.size()));
}

WeightedTargets draw_targets(const VisibilityRatio& ratio, const LightFront& around, const SurfaceReceiver& receiver,
                             Rng& rng) {
    const LitPoint lit{dvec3(receiver.local), dvec3(receiver.normal), LitPoint::Kind::Surface};
    WeightedTargets targets;
    std::array<VisibilityRatio::Draw, VisibilityRatio::kDraws> draws;
    for (std::size_t k = 0; k < kTargetsDrawn && ratio.draw(around, lit, rng, draws); k += draws.size())
        targets.add(draws);
    return targets;
}

}  // namespace brisance
