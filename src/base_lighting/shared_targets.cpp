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
// Candidates of a batch, in batches: so many at most, and half as many as receivers that take it.
constexpr std::size_t kMostCandidates = 4, kTakersOfCandidate = 2;
// Of the mean weight of candidates, what each has at least: others may see what the place itself cannot.
constexpr float kLeastWeight = 0.02f;

LitPoint lit_point(const SurfaceReceiver& receiver) {
    return {dvec3(receiver.local), dvec3(receiver.normal), LitPoint::Kind::Surface};
}

// Candidates for a batch on one side of what surfaces hide.
class Candidates {
public:
    void add(const VisibilityRatio::Target& target, float weight) {
        targets_.push_back(target);
        weights_.push_back(weight);
        numbers_.add(weight);
    }
    bool empty() const { return targets_.empty(); }

    // The i-th of n, each in proportion to its weight: systematic resampling with the offset u. Its power is such that
    // n of them stand for all candidates.
    VisibilityRatio::Target choose(std::size_t i, std::size_t n, float u) const {
        const std::size_t k = numbers_.at((float(i) + u) / float(n));
        return {targets_[k].point, targets_[k].power * numbers_.sum() / (float(n) * weights_[k])};
    }

private:
    std::vector<VisibilityRatio::Target> targets_;
    std::vector<float> weights_;
    WeightedNumbers numbers_;
};

// Half a batch of each side, in turn, which stand for a batch of their `batches`.
VisibilityRatio::Targets resampled(const Candidates& seen, const Candidates& hidden, std::size_t batches, Rng& rng) {
    constexpr std::size_t kDraws = VisibilityRatio::kDraws;
    const float u = rng.next();
    VisibilityRatio::Targets out;
    for (std::size_t k = 0; k < kDraws; ++k) {
        if (seen.empty() || hidden.empty())
            out[k] = (seen.empty() ? hidden : seen).choose(k, kDraws, u);
        else
            out[k] = (k % 2 == 0 ? seen : hidden).choose(k / 2, kDraws / 2, u);
        out[k].power /= float(batches);
    }
    return out;
}

}  // namespace

std::size_t WeightedNumbers::at(float u) const {
    return std::size_t(std::upper_bound(passed_.begin(), passed_.end() - 1, u * sum_) - passed_.begin());
}

void WeightedTargets::add(std::span<const VisibilityRatio::Draw> draws) {
    for (const VisibilityRatio::Draw& d : draws)
        if (d.weight > 0.0f) {
            points_.push_back(d.point);
            numbers_.add(d.weight);
        }
}

TargetPool::TargetPool(const VisibilityRatio& ratio, const SurfaceReceiver& first, Reaches reaches, std::size_t batches,
                       std::size_t most, std::pair<std::uint64_t, std::uint64_t> seed)
    : ratio_(ratio),
      first_(lit_point(first)),
      reaches_(std::move(reaches)),
      seed_(seed),
      batches_(std::min<std::size_t>(std::bit_ceil(std::max(most, batches / kShare)), kMostBatches)),
      candidates_(std::clamp<std::size_t>(batches / batches_.size() / kTakersOfCandidate, 1, kMostCandidates)),
      around_(ratio.around(first_, batches_.size() * candidates_ * VisibilityRatio::kDraws)) {}

// Steps of about the golden ratio of all: batches that follow each other lie far apart in their strata. Odd, so that
// all are passed.
const VisibilityRatio::Targets& TargetPool::batch(float start, std::size_t number) {
    const std::size_t count = batches_.size(), step = std::size_t(0.618 * double(count)) | 1,
                      at = (std::size_t(start * float(count)) + number * step) & (count - 1);
    if (!batches_[at])
        batches_[at] = draw(at);
    return *batches_[at];
}

VisibilityRatio::Targets TargetPool::draw(std::size_t at) const {
    constexpr std::size_t kDraws = VisibilityRatio::kDraws;
    Rng rng(kPool, seed_.first, seed_.second * kMostBatches + at);
    std::array<VisibilityRatio::Targets, kMostCandidates> targets;
    std::array<std::array<VisibilityRatio::Draw, kDraws>, kMostCandidates> draws;
    float sum = 0.0f;
    for (std::size_t j = 0; j < candidates_; ++j) {
        const double shift = (double(at * candidates_ + j) + rng.next_double()) / double(batches_.size() * candidates_);
        targets[j] = ratio_.choose(around_, first_, shift, rng);
        if (candidates_ == 1)
            return targets[j];
        ratio_.weigh(first_, targets[j], draws[j]);
        for (const VisibilityRatio::Draw& d : draws[j])
            sum += d.weight;
    }
    const float least = kLeastWeight * sum / float(candidates_ * kDraws);
    if (!(least > 0.0f))
        return targets[0];  // the place sees nothing, and others little
    Candidates seen, hidden;
    for (std::size_t j = 0; j < candidates_; ++j)
        for (std::size_t k = 0; k < kDraws; ++k)
            if (targets[j][k].power > 0.0f)
                (reaches_(targets[j][k].point) ? seen : hidden).add(targets[j][k], std::max(draws[j][k].weight, least));
    return resampled(seen, hidden, candidates_, rng);
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
