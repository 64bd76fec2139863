#include "gathering/receivers.h"

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr std::size_t kAtOnce = 1 << 16;  // values that one task adds or scales

}  // namespace

vec3 direction_toward(const vec3& eye, const vec3& p) {
    const vec3 offset = eye - p;
    const float distance = glm::length(offset);
    return distance > 0.0f ? offset / distance : vec3(0.0f, 0.0f, 1.0f);
}

void Receivers::add_block(const std::vector<vec3>& points, const std::vector<vec3>& toward_camera) {
    if (points.empty())
        return;
    ReceiverBlock block;
    block.first_group = x.size() / kGroup;
    const std::size_t padded = (points.size() + kGroup - 1) / kGroup * kGroup;
    block.group_count = padded / kGroup;
    for (std::size_t i = 0; i < padded; ++i) {
        const std::size_t k = std::min(i, points.size() - 1);
        const vec3& p = points[k];
        x.push_back(p.x);
        y.push_back(p.y);
        z.push_back(p.z);
        if (!toward_camera.empty()) {
            out_x.push_back(toward_camera[k].x);
            out_y.push_back(toward_camera[k].y);
            out_z.push_back(toward_camera[k].z);
        }
        if (i % kGroup == 0)
            group_bounds.emplace_back();
        group_bounds.back().add(p);
        block.bounds.add(p);
    }
    blocks_.push_back(block);
}

void Gathered::resize(std::size_t receivers, bool camera, bool directional) {
    fluence.assign(receivers * 3, 0.0f);
    scattered.assign(camera ? receivers * 3 : 0, 0.0f);
    moments.assign(directional ? receivers * 24 : 0, 0.0f);
}

void Gathered::add(const Gathered& other) {
    const auto sum = [](std::vector<float>& a, const std::vector<float>& b) {
        parallel_for(
            std::min(a.size(), b.size()), [&](std::size_t i) { a[i] += b[i]; }, kAtOnce);
    };
    sum(fluence, other.fluence);
    sum(scattered, other.scattered);
    sum(moments, other.moments);
}

void Gathered::scale(const Rgb& factor) {
    for (auto* field : {&fluence, &scattered, &moments}) {
        const std::size_t plane = field == &moments ? field->size() / 24 : field->size() / 3;
        parallel_for(
            field->size(), [&](std::size_t i) { (*field)[i] *= factor[int(i / plane % 3)]; }, kAtOnce);
    }
}

}  // namespace brisance
