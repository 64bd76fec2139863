#include "virtual_lights/flux/partition_of_unity.h"

#include <algorithm>

namespace brisance {

namespace {

constexpr std::size_t kLeaf = 4;
// Least cosine between the normals of a point and of a light that covers it (Li et al., as they released it).
constexpr float kSameWay = 0.7f;

// Height above the surface at which visibility from a light is tested, of the light's radius.
constexpr float kAbove = 0.05f;

// Keeps the largest weights; of equal ones those of lower index, whatever the order of calls.
void insert(LightShares& shares, std::uint32_t light, float weight) {
    const auto before = [&](int i) {
        return shares.weight[i] > weight || (shares.weight[i] == weight && shares.light[i] < light);
    };
    int at = shares.count;
    if (at == LightShares::kMost && before(--at))
        return;
    for (; at > 0 && !before(at - 1); --at) {
        shares.light[at] = shares.light[at - 1];
        shares.weight[at] = shares.weight[at - 1];
    }
    shares.light[at] = light;
    shares.weight[at] = weight;
    shares.count = std::min(shares.count + 1, LightShares::kMost);
}

bool inside(const vec3& p, const vec3& low, const vec3& high) {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
}

}  // namespace

PartitionOfUnity::PartitionOfUnity(const Intersector& surfaces, std::span<const VirtualLight> lights)
    : surfaces_(&surfaces) {
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const VirtualLight& l = lights[i];
        spheres_.push_back(
            {vec3(l.position), float(l.radius), float(l.share), vec3(l.frame.normal), l.scene_material, i});
    }
    if (!spheres_.empty())
        build(lights, spheres_, 0);
}

void PartitionOfUnity::build(std::span<const VirtualLight> lights, std::span<Sphere> spheres, std::size_t first) {
    const std::size_t node = nodes_.size();
    vec3 low(1e30f), high(-1e30f), least(1e30f), most(-1e30f);
    for (const Sphere& s : spheres) {
        const float radius = float(lights[s.light].radius) * 1.0001f;
        low = glm::min(low, s.centre - radius);
        high = glm::max(high, s.centre + radius);
        least = glm::min(least, s.centre);
        most = glm::max(most, s.centre);
    }
    nodes_.push_back({low, high, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(spheres.size())});
    if (spheres.size() <= kLeaf)
        return;
    const vec3 size = most - least;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = spheres.size() / 2;
    std::nth_element(spheres.begin(), spheres.begin() + static_cast<std::ptrdiff_t>(half), spheres.end(),
                     [&](const Sphere& a, const Sphere& b) {
                         return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.light < b.light;
                     });
    nodes_[node].count = 0;
    build(lights, spheres.first(half), first);
    nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
    build(lights, spheres.subspan(half), first + half);
}

// Between points a little above the surface, so that it does not occlude itself where it is curved.
bool PartitionOfUnity::hidden(const Sphere& sphere, const vec3& position, const vec3& normal) const {
    const float above = kAbove * sphere.radius;
    const dvec3 from(position + above * normal), offset = dvec3(sphere.centre + above * sphere.normal) - from;
    const double length = glm::length(offset);
    return length > 0.0 && surfaces_->occluded({from, offset / length}, length);
}

LightShares PartitionOfUnity::shares(const dvec3& position, const dvec3& normal, int scene_material) const {
    LightShares out;
    if (nodes_.empty())
        return out;
    const vec3 p(position), n(normal);
    std::array<std::uint32_t, 64> stack;
    std::size_t waiting = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
        const std::uint32_t at = stack[--waiting];
        const Node& node = nodes_[at];
        if (!inside(p, node.low, node.high))
            continue;
        if (node.count == 0) {
            stack[waiting++] = node.first;
            stack[waiting++] = at + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Sphere& s = spheres_[i];
            const vec3 away = p - s.centre;
            const float weight = s.share * (1.0f - glm::dot(away, away) / (s.radius * s.radius));
            if (weight > 0.0f && s.scene_material == scene_material && glm::dot(n, s.normal) > kSameWay &&
                !hidden(s, p, n))
                insert(out, s.light, weight);
        }
    }
    float sum = 0.0f;
    for (int i = 0; i < out.count; ++i)
        sum += out.weight[i];
    for (int i = 0; i < out.count; ++i)
        out.weight[i] /= sum;
    return out;
}

}  // namespace brisance
