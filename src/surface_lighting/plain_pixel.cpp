#include "surface_lighting/plain_pixel.h"

#include <algorithm>
#include <cmath>

#include "geometry/surface_point.h"

namespace brisance {

namespace {

// Least cosine between the triangles' normals.
constexpr double kFacesAlike = 0.999;
// How far rays may meet others off the plane of the first, over the distance to its ray: what their angle explains, and
// rounding.
constexpr double kRounding = 1e-4;

bool is_plain(const SceneMaterial& m) {
    const TextureUse* const uses[] = {&m.base_colour, &m.metal_rough,     &m.transmission,
                                      &m.specular,    &m.specular_colour, &m.normal};
    return std::ranges::all_of(uses, [](const TextureUse* use) { return use->texture < 0; }) && has_base(m.surface) &&
           m.surface.transmission == 0.0f && m.alpha_mode == AlphaMode::Opaque;
}

}  // namespace

bool shows_plain_surface(const Scene& scene, std::span<const SurfaceSample> pixel) {
    const SurfaceHit& first = pixel.front().hit;
    const SceneMesh& mesh = scene.meshes[first.mesh];
    if (!is_plain(scene.materials[mesh.material]))
        return false;
    const dvec3 normal = glm::normalize(triangle_of(scene, first.mesh, first.triangle).normal());
    const auto position = [](const SurfaceSample& s) { return s.ray.origin + s.hit.distance * s.ray.direction; };
    return std::ranges::all_of(pixel, [&](const SurfaceSample& s) {
        if (s.hit.mesh != first.mesh)
            return false;
        if (s.hit.triangle == first.triangle)
            return true;
        const dvec3 n = glm::normalize(triangle_of(scene, s.hit.mesh, s.hit.triangle).normal()),
                    aside = position(s) - position(pixel.front());
        const double sine = glm::length(glm::cross(n, normal));
        return glm::dot(n, normal) > kFacesAlike &&
               std::abs(glm::dot(aside, normal)) <= (sine + kRounding) * glm::length(aside);
    });
}

}  // namespace brisance
