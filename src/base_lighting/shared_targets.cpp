#include "base_lighting/shared_targets.h"

#include <algorithm>
#include <bit>

namespace brisance {

namespace {

// Largest distance of receivers from the first of their neighbourhood, relative to their distance from the medium's
// bounds, and relative to a voxel where that is more.
constexpr float kNearbyOfDistance = 0.1f, kNearbyOfVoxel = 4.0f;
// Least cosine between their normals.
constexpr float kNearbyFacing = 0.999f;

constexpr Stream kPool = stream_of("base lighting, pool");
// Receivers that may take a batch, on average.
constexpr std::size_t kShare = 8;
constexpr std::uint64_t kMostBatches = 1 << 12;

LitPoint lit_point(const SurfaceReceiver& receiver) {
    return {dvec3(receiver.local), dvec3(receiver.normal), LitPoint::Kind::Surface};
}

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

TargetPool::TargetPool(const VisibilityRatio& ratio, const SurfaceReceiver& first, std::size_t batches,
                       std::size_t most, std::pair<std::uint64_t, std::uint64_t> seed)
    : ratio_(ratio),
      first_(lit_point(first)),
      seed_(seed),
      batches_(std::min<std::size_t>(std::bit_ceil(std::max(most, batches / kShare)), kMostBatches)),
      around_(ratio.around(first_, batches_.size() * VisibilityRatio::kDraws)) {}

// Steps of about the golden ratio of all: batches that follow each other lie far apart in their strata. Odd, so that
// all are passed.
const VisibilityRatio::Targets& TargetPool::batch(float start, std::size_t number) {
    const std::size_t count = batches_.size(), step = std::size_t(0.618 * double(count)) | 1,
                      at = (std::size_t(start * float(count)) + number * step) & (count - 1);
    if (!batches_[at]) {
        Rng rng(kPool, seed_.first, seed_.second * kMostBatches + at);
        const double shift = (double(at) + rng.next_double()) / double(count);
        batches_[at] = ratio_.choose(around_, first_, shift, rng);
    }
    return *batches_[at];
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
    const LitPoint lit = lit_point(receiver);
    WeightedTargets targets;
    std::array<VisibilityRatio::Draw, VisibilityRatio::kDraws> draws;
    for (std::size_t k = 0; k < kTargetsDrawn && ratio.draw(around, lit, rng, draws); k += draws.size())
        targets.add(draws);
    return targets;
}

}  // namespace brisance
