#include "medium_lighting/surface_occluders.h"

#include <cmath>

namespace brisance {

namespace {

struct Extent {
    vec3 low{1e30f}, high{-1e30f};
    void add(const vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    bool empty() const { return low.x > high.x; }
};

Extent extent_of_smoke(const Medium& medium) {
    Extent extent;
    for (std::size_t i = 0; i < medium.extinction.size(); ++i) {
        const bool glows = !medium.emission.empty() && medium.emission[i] != Rgb(0.0f);
        if (medium.extinction[i] > 0.0f || glows)
            extent.add(medium.local_of_node(medium.lattice.node(i)));
    }
    return extent;
}

// By the axes of the box and the triangle's normal: sees no triangle apart that is not, misses some that are.
bool may_touch(const Extent& box, const vec3& a, const vec3& b, const vec3& c) {
    const vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    if (glm::any(glm::greaterThan(low, box.high)) || glm::any(glm::lessThan(high, box.low)))
        return false;
    const vec3 normal = glm::cross(b - a, c - a);
    const vec3 middle = 0.5f * (box.low + box.high), half = 0.5f * (box.high - box.low);
    return std::abs(glm::dot(normal, middle - a)) <= glm::dot(glm::abs(normal), half);
}

}  // namespace

SurfaceOccluders::SurfaceOccluders(const Intersector& intersector, float spacing)
    : intersector_(intersector), moved_(spacing * kBesidePlanes) {}

float SurfaceOccluders::first_hit(const vec3& from, const vec3& direction, float far) const {
    const std::optional<SurfaceHit> hit = intersector_.first_hit({dvec3(from + moved_), dvec3(direction)}, far);
    return hit ? float(hit->distance) : far;
}

bool SurfaceOccluders::any_within(const vec3& centre, float radius) const {
    return intersector_.any_within(dvec3(centre + moved_), radius);
}

bool surfaces_reach_into(const Surroundings* surroundings, const Medium& medium) {
    if (!surroundings || !surroundings->has_surfaces())
        return false;
    const Extent box = extent_of_smoke(medium);
    if (box.empty())
        return false;
    for (const SceneMesh& mesh : surroundings->scene().meshes)
        for (const glm::uvec3& t : mesh.triangles)
            if (may_touch(box, mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]))
                return true;
    return false;
}

}  // namespace brisance
