#include "receivers/receivers.h"

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

namespace {

std::size_t groups_of(std::size_t points) {
    return (points + Receivers::kGroup - 1) / Receivers::kGroup;
}

}  // namespace

Receivers::Receivers(const std::vector<std::size_t>& counts, bool directions) {
    std::size_t groups = 0;
    for (const std::size_t count : counts) {
        blocks_.push_back({groups, groups_of(count), {}});
        groups += blocks_.back().group_count;
    }
    group_bounds.resize(groups);
    for (std::vector<float>* list : {&x, &y, &z})
        list->resize(groups * kGroup);
    for (std::vector<float>* list : {&out_x, &out_y, &out_z})
        list->resize(directions ? groups * kGroup : 0);
}

void Receivers::set_block(std::size_t block, const std::vector<vec3>& points, const std::vector<vec3>& toward_camera) {
    ReceiverBlock& b = blocks_[block];
    for (std::size_t i = 0; i < b.group_count * kGroup; ++i) {
        const std::size_t k = std::min(i, points.size() - 1), at = b.first_group * kGroup + i;
        const vec3& p = points[k];
        x[at] = p.x;
        y[at] = p.y;
        z[at] = p.z;
        if (!toward_camera.empty()) {
            out_x[at] = toward_camera[k].x;
            out_y[at] = toward_camera[k].y;
            out_z[at] = toward_camera[k].z;
        }
        group_bounds[at / kGroup].add(p);
        b.bounds.add(p);
    }
}

void Receivers::add_block(const std::vector<vec3>& points, const std::vector<vec3>& toward_camera) {
    if (points.empty())
        return;
    const std::size_t groups = group_bounds.size(), more = groups_of(points.size());
    blocks_.push_back({groups, more, {}});
    group_bounds.resize(groups + more);
    for (std::vector<float>* list : {&x, &y, &z})
        list->resize((groups + more) * kGroup);
    for (std::vector<float>* list : {&out_x, &out_y, &out_z})
        list->resize(toward_camera.empty() ? 0 : (groups + more) * kGroup);
    set_block(blocks_.size() - 1, points, toward_camera);
}

void Gathered::resize(std::size_t receivers, bool camera, bool directional) {
    fluence.assign(receivers * 3, 0.0f);
    scattered.assign(camera ? receivers * 3 : 0, 0.0f);
    moments.assign(directional ? receivers * 24 : 0, 0.0f);
}

namespace {

template <class Value, class Light>
std::vector<std::span<Value>> planes_of(Light& light) {
    const std::size_t receivers = light.fluence.size() / 3;
    std::vector<std::span<Value>> planes;
    for (auto* field : {&light.fluence, &light.scattered, &light.moments})
        for (std::size_t first = 0; first < field->size(); first += receivers)
            planes.push_back(std::span<Value>(*field).subspan(first, receivers));
    return planes;
}

}  // namespace

std::vector<std::span<float>> Gathered::planes() {
    return planes_of<float>(*this);
}

std::vector<std::span<const float>> Gathered::planes() const {
    return planes_of<const float>(*this);
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
    const auto all = planes();
    for (std::size_t c = 0; c < all.size(); ++c)
        parallel_for(
            all[c].size(), [&](std::size_t i) { all[c][i] *= factor[int(c % 3)]; }, kAtOnce);
}

}  // namespace brisance
