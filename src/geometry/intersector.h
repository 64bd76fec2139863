// Intersects rays with the triangles of a scene. Only this module includes Embree (3 or 4).
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "core/ray.h"
#include "scene/scene.h"

namespace brisance {

struct SurfaceHit {
    double distance = 0.0;  // [m]
    std::uint32_t mesh = 0, triangle = 0;
    vec2 barycentric{0.0f};  // weights of the triangle's second and third vertex
};

// Watertight: a ray cannot slip between two triangles that share an edge. Single precision: a ray that leaves a surface
// starts at SurfacePoint::leaving (surface_point.h), which is far enough from it and no farther.
// Cut-outs let rays through where their texture says so; blends in proportion, decided by a number made from the ray.
class Intersector {
public:
    // Builds the hierarchy. Keeps a reference to the scene. Throws Error Temporary where memory runs out.
    explicit Intersector(const Scene& scene);
    ~Intersector();
    Intersector(const Intersector&) = delete;
    Intersector& operator=(const Intersector&) = delete;

    bool empty() const;  // no triangles: nothing was built
    std::optional<SurfaceHit> first_hit(const Ray& ray, double end = std::numeric_limits<double>::infinity()) const;
    bool occluded(const Ray& ray, double end = std::numeric_limits<double>::infinity()) const;
    // Whether a triangle may lie within `radius` [m] of the position. False is exact; true may be returned for some
    // triangles slightly farther away.
    bool any_within(const dvec3& position, double radius) const;

    const Scene& scene() const { return scene_; }
    std::uint64_t bytes() const;  // of the hierarchy

private:
    struct Embree;
    const Scene& scene_;
    std::unique_ptr<Embree> embree_;
};

}  // namespace brisance
