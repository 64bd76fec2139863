// Where a ray meets a surface, and what is there.
#pragma once

#include "geometry/intersector.h"
#include "surfaces/bsdf.h"

namespace brisance {

struct SurfacePoint {
    dvec3 position;          // local [m], in the triangle's plane
    dvec3 geometric_normal;  // unit, out of the triangle's front
    ShadingFrame frame;      // of the BSDF: opaque surfaces face the viewer, those that transmit keep their outside
    SurfaceMaterial material;
    Rgb emission{0.0f};      // radiance toward the viewer [W/(m^2 sr)]
    bool front = true;       // the viewer is on the side of the geometric normal
    double clearance = 0.0;  // distance from the plane beyond which rays in single precision miss the triangle [m]

    // A ray from just above the surface, on the side that `direction` goes to.
    Ray leaving(const dvec3& direction) const;
    // The same point just above the surface, on the side of `other`.
    dvec3 start_toward(const dvec3& other) const;

    // Whether interpolated normals would let light through the surface itself between these directions: what they call
    // reflection must stay on one side of the triangle, what they call transmission must cross it.
    bool leaks(const dvec3& wo, const dvec3& wi) const {
        const auto same_side = [&](const dvec3& n) { return glm::dot(n, wi) * glm::dot(n, wo) > 0.0; };
        return same_side(frame.normal) != same_side(geometric_normal);
    }
};

// `toward_viewer`: unit. Normals that interpolation or a normal map turns away from the viewer are bent back until they
// are just seen, so that silhouettes do not go black.
SurfacePoint surface_point(const Scene& scene, const SurfaceHit& hit, const dvec3& toward_viewer);

// Radiance that the front of a triangle emits at a point [W/(m^2 sr)]. The back emits the same where the material is
// double sided.
Rgb emission_at(const Scene& scene, const SurfaceHit& hit);

// [1] 0..1
float alpha_at(const Scene& scene, const SurfaceHit& hit);

// A triangle's vertices, and its normal (not unit: twice the area long).
struct Triangle {
    dvec3 a, b, c;
    dvec3 normal() const { return glm::cross(b - a, c - a); }
};
Triangle triangle_of(const Scene& scene, std::uint32_t mesh, std::uint32_t triangle);

}  // namespace brisance
