#include "base_lighting/shared_receivers.h"

#include <algorithm>

namespace brisance {

namespace {

// Largest distance between samples, relative to the distance from the smoke, and relative to a voxel where that is
// more.
constexpr float kOfDistance = 0.05f, kOfVoxel = 0.25f;
// Least cosine between normals of samples that share a receiver.
constexpr float kSameFacing = 0.999f;

}  // namespace

float SharedReceivers::reach_at(const vec3& local) const {
    return std::max(kOfDistance * bounds_.distance(local), kOfVoxel * voxel_);
}

void SharedReceivers::add(std::uint32_t pixel, const vec3& local, const vec3& normal) {
    if (pixel != pixel_)
        first_of_pixel_ = groups_.size();
    pixel_ = pixel;
    const auto joins = [&](const Group& g) {
        const vec3 offset = local - g.first;
        return glm::dot(offset, offset) <= g.reach * g.reach && glm::dot(normal, g.facing) > kSameFacing;
    };
    const auto group = std::find_if(groups_.begin() + std::ptrdiff_t(first_of_pixel_), groups_.end(), joins);
    const auto number = static_cast<std::size_t>(group - groups_.begin());
    if (group == groups_.end()) {
        groups_.push_back({local, normal, reach_at(local), 0});
        receivers_.push_back({vec3(0.0f), vec3(0.0f)});
    }
    ++groups_[number].samples;
    receivers_[number].local += local - groups_[number].first;
    receivers_[number].normal += normal;
    receiver_of_.push_back(static_cast<std::uint32_t>(number));
}

std::vector<SurfaceReceiver>& SharedReceivers::receivers() {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        receivers_[i].local = groups_[i].first + receivers_[i].local / float(groups_[i].samples);
        if (groups_[i].samples > 1)
            receivers_[i].normal = glm::normalize(receivers_[i].normal);
    }
    return receivers_;
}

}  // namespace brisance
