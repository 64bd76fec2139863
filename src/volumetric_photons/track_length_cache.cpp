#include "volumetric_photons/track_length_cache.h"

#include <algorithm>
#include <array>
#include <cmath>
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
    least_priority_ = std::make_unique<std::atomic<float>[]>(lists);
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
    // Segments side by side often count for one node.
    std::int64_t last = -1;
    FixedSums::Steps of_last(0);
    track_lengths_.along(ray, end, [&](std::int64_t node, float length) {
        const Rgb power_length = power * length;
        if (node != last) {
            if (last >= 0)
                sums_.add_steps(last, of_last);
            last = node;
            of_last = FixedSums::Steps(0);
        }
        of_last += sums_.steps(dvec3(power_length) *
                               double(henyey_greenstein(glm::dot(direction, toward_eye_[node]), mean_cosine_)));
        if (list_of_.empty() || list_of_[node] < 0)
            return;
        const float priority = luminance(power_length) / (1.0f - rng.next());
        if (priority > 0.0f && priority >= least_priority_[list_of_[node]].load(std::memory_order_relaxed))
            keep(list_of_[node], {priority, direction, power_length});
    });
    if (last >= 0)
        sums_.add_steps(last, of_last);
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
    if (count_[list] > kTracks)
        least_priority_[list].store(first[kTracks].priority, std::memory_order_relaxed);
    busy_[list].clear(std::memory_order_release);
}

namespace {

// Filters node values along one axis (0 to 2) by `kernel`, from the node itself on outward.
void filter_axis(const BrickLattice& lattice, int channels, int axis, const std::vector<float>& kernel,
                 std::vector<float>& values) {
    const std::vector<float> before = values;
    const int reach = static_cast<int>(kernel.size()) - 1;
    ivec3 margin(0);
    margin[axis] = reach;
    const ivec3 size = ivec3(BrickLattice::kSize) + 2 * margin;
    const int plane = size.x * size.y * size.z, stride = axis == 0 ? size.y * size.z : (axis == 1 ? size.z : 1);
    parallel_for(lattice.brick_count(), [&](std::size_t b) {
        std::vector<float> box(std::size_t(plane) * channels);
        copy_box(lattice, before, channels, lattice.first_node(b) - margin, size, box);
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const ivec3 p = BrickLattice::node_in_brick(n) + margin;
            const int at = (p.x * size.y + p.y) * size.z + p.z;
            for (int c = 0; c < channels; ++c) {
                const float* const centre = &box[std::size_t(c) * plane + at];
                float sum = kernel[0] * *centre;
                for (int k = 1; k <= reach; ++k)
                    sum += kernel[k] * (centre[-k * stride] + centre[k * stride]);
                values[(b * BrickLattice::kNodes + n) * channels + c] = sum;
            }
        }
    });
}

// By a Gaussian, up to three standard deviations [nodes]. Nothing is beyond the lattice.
std::vector<float> filtered(const BrickLattice& lattice, int channels, float radius, std::vector<float> values) {
    std::vector<float> kernel;
    float sum = 0.0f;
    for (int k = 0; k <= static_cast<int>(std::ceil(3.0f * radius)); ++k) {
        kernel.push_back(std::exp(-0.5f * float(k * k) / (radius * radius)));
        sum += (k > 0 ? 2.0f : 1.0f) * kernel.back();
    }
    for (float& k : kernel)
        k /= sum;
    for (int axis = 0; axis < 3; ++axis)
        filter_axis(lattice, channels, axis, kernel, values);
    return values;
}

}  // namespace

void TrackLengthCache::finish(float filter_radius) {
    radiance_.resize(toward_eye_.size());
    const double voxel = medium_.voxel_volume;
    parallel_for(
        radiance_.size(), [&](std::size_t i) { radiance_[i] = Rgb(sums_.read(i) / voxel); }, kNodesAtOnce);
    sums_ = FixedSums(0, 1.0);
    toward_eye_ = {};
    busy_.reset();
    least_priority_.reset();
    if (!(filter_radius > 0.0f))
        return;
    const auto* const flat = reinterpret_cast<const float*>(radiance_.data());
    const std::vector<float> light = filtered(medium_.lattice, 3, filter_radius, {flat, flat + 3 * radiance_.size()});
    for (std::size_t i = 0; i < radiance_.size(); ++i)
        radiance_[i] = {light[3 * i], light[3 * i + 1], light[3 * i + 2]};
    filtered_volume_ = filtered(medium_.lattice, 1, filter_radius, volume_);
}

Rgb TrackLengthCache::toward_eye(const dvec3& position) const {
    const Corners corners = corners_of(medium_.lattice, position);
    const std::vector<float>& volumes = filtered_volume_.empty() ? volume_ : filtered_volume_;
    Rgb light(0.0f);
    float volume = 0.0f;
    for (int k = 0; k < 8; ++k)
        if (const std::int64_t node = corners.node[k]; node >= 0) {
            light += corners.weight[k] * radiance_[node];
            volume += corners.weight[k] * volumes[node];
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
    return (radiance_.size() * sizeof(Rgb) + (volume_.size() + filtered_volume_.size()) * sizeof(float)) +
           kept_.size() * sizeof(Track) + count_.size() + list_of_.size() * sizeof(std::int32_t);
}

}  // namespace brisance
