#include "volumetric_photons/track_length_cache.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "core/parallel.h"
#include "medium/phase.h"

namespace brisance {

namespace {

constexpr std::size_t kNodesAtOnce = 4096;

// The nodes around a position, and their trilinear weights.
struct Corners {
    std::array<std::int64_t, 8> node;
    std::array<float, 8> weight;
};

Corners corners_of(const BrickLattice& lattice, const dvec3& position) {
    const dvec3 low = glm::floor(position);
    const vec3 f(position - low);
    Corners corners;
    for (int k = 0; k < 8; ++k) {
        const ivec3 up(k >> 2, k >> 1 & 1, k & 1);
        corners.node[k] = lattice.find_node(ivec3(low) + up);
        corners.weight[k] = (up.x ? f.x : 1.0f - f.x) * (up.y ? f.y : 1.0f - f.y) * (up.z ? f.z : 1.0f - f.z);
    }
    return corners;
}

}  // namespace

TrackLengthCache::TrackLengthCache(const Medium& medium, const dvec3& eye, double power, bool other_directions)
    : medium_(medium),
      track_lengths_(medium),
      mean_cosine_(medium.mean_cosine),
      toward_eye_(medium.lattice.node_count()),
      sums_(medium.lattice.node_count(), power * medium.spacing),
      volume_(medium.lattice.node_count()) {
    parallel_for(
        toward_eye_.size(),
        [&](std::size_t i) {
            const ivec3 node = medium.lattice.node(i);
            const vec3 offset = vec3(eye) - medium.local_of_node(node);
            const float distance = glm::length(offset);
            toward_eye_[i] = distance > 0.0f ? offset / distance : vec3(0.0f, 0.0f, 1.0f);
            volume_[i] = track_lengths_.part_in_voxels(node);
        },
        kNodesAtOnce);
    if (!other_directions)
        return;
    std::size_t lists = 0;
    for (const float extinction : medium.extinction)
        list_of_.push_back(extinction > 0.0f ? static_cast<std::int32_t>(lists++) : -1);
    kept_.resize(lists * (kTracks + 1));
    count_.resize(lists, 0);
    busy_ = std::make_unique<std::atomic_flag[]>(lists);
}

bool TrackLengthCache::Track::precedes(const Track& o) const {
    const auto all = [](const Track& w) {
        return std::tie(w.priority, w.direction.x, w.direction.y, w.direction.z, w.power_length.x, w.power_length.y,
                        w.power_length.z);
    };
    return all(*this) > all(o);
}

void TrackLengthCache::add(const Ray& ray, double end, const Rgb& power, Rng& rng) {
    const vec3 direction(ray.direction);
    track_lengths_.along(ray, end, [&](std::int64_t node, float length) {
        const Rgb power_length = power * length;
        sums_.add(node, dvec3(power_length) *
                            double(henyey_greenstein(glm::dot(direction, toward_eye_[node]), mean_cosine_)));
        if (list_of_.empty() || list_of_[node] < 0)
            return;
        const float priority = luminance(power_length) / (1.0f - rng.next());
        if (priority > 0.0f)
            keep(list_of_[node], {priority, direction, power_length});
    });
}

void TrackLengthCache::keep(std::size_t list, const Track& track) {
    while (busy_[list].test_and_set(std::memory_order_acquire)) {
    }
    Track* const first = &kept_[list * (kTracks + 1)];
    int at = count_[list];
    if (at <= kTracks)
        count_[list] = static_cast<std::uint8_t>(++at);
    // The last track of a full list is dropped.
    if (--at < kTracks || track.precedes(first[at])) {
        for (; at > 0 && track.precedes(first[at - 1]); --at)
            first[at] = first[at - 1];
        first[at] = track;
    }
    busy_[list].clear(std::memory_order_release);
}

void TrackLengthCache::finish() {
    radiance_.resize(toward_eye_.size());
    const double voxel = medium_.voxel_volume;
    parallel_for(
        radiance_.size(), [&](std::size_t i) { radiance_[i] = Rgb(sums_.read(i) / voxel); }, kNodesAtOnce);
    sums_ = FixedSums(0, 1.0);
    toward_eye_ = {};
    busy_.reset();
}

Rgb TrackLengthCache::toward_eye(const dvec3& position) const {
    const Corners corners = corners_of(medium_.lattice, position);
    Rgb light(0.0f);
    float volume = 0.0f;
    for (int k = 0; k < 8; ++k)
        if (const std::int64_t node = corners.node[k]; node >= 0) {
            light += corners.weight[k] * radiance_[node];
            volume += corners.weight[k] * volume_[node];
        }
    return volume > 0.0f ? light / volume : Rgb(0.0f);
}

Rgb TrackLengthCache::toward(const vec3& direction, const dvec3& position, float xi) const {
    Corners corners = corners_of(medium_.lattice, position);
    float all = 0.0f;
    for (int k = 0; k < 8; ++k) {
        const std::int64_t node = corners.node[k];
        corners.weight[k] *= node >= 0 && list_of_[node] >= 0 ? volume_[node] : 0.0f;
        all += corners.weight[k];
    }
    if (!(all > 0.0f))
        return Rgb(0.0f);
    int chosen = -1;
    for (float left = xi * all; chosen < 7 && (chosen < 0 || left >= 0.0f);)
        left -= corners.weight[++chosen];
    while (corners.weight[chosen] == 0.0f)
        --chosen;
    const std::int64_t node = corners.node[chosen];
    const std::size_t list = list_of_[node];
    const Track* const first = &kept_[list * (kTracks + 1)];
    const float threshold = count_[list] > kTracks ? first[kTracks].priority : 0.0f;
    Rgb light(0.0f);
    for (int i = 0; i < std::min<int>(count_[list], kTracks); ++i) {
        const float stands_for = std::max(1.0f, threshold / luminance(first[i].power_length));
        light += first[i].power_length *
                 (stands_for * henyey_greenstein(glm::dot(first[i].direction, direction), mean_cosine_));
    }
    return light / volume_around(node);
}

std::uint64_t TrackLengthCache::bytes() const {
    return (radiance_.size() * sizeof(Rgb) + volume_.size() * sizeof(float)) + kept_.size() * sizeof(Track) +
           count_.size() + list_of_.size() * sizeof(std::int32_t);
}

}  // namespace brisance
