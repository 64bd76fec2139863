#include "geometry/surface_point.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Least cosine of the shading normal to the viewer.
constexpr double kJustSeen = 1e-3;

template <class T>
T interpolate(const std::vector<T>& values, const glm::uvec3& t, const vec2& b) {
    return (1.0f - b.x - b.y) * values[t.x] + b.x * values[t.y] + b.y * values[t.z];
}

struct Lookup {
    const Scene& scene;
    const SceneMesh& mesh;
    glm::uvec3 triangle;
    vec2 uv{0.0f};

    Lookup(const Scene& s, const SurfaceHit& hit)
        : scene(s), mesh(s.meshes[hit.mesh]), triangle(mesh.triangles[hit.triangle]) {
        if (!mesh.uv.empty())
            uv = interpolate(mesh.uv, triangle, hit.barycentric);
    }

    const SceneMaterial& material() const { return scene.materials[mesh.material]; }
    vec4 operator()(const TextureUse& use) const {
        if (use.texture < 0 || mesh.uv.empty())
            return vec4(1.0f);
        return scene.textures[use.texture]->at(use.texture_from_uv * vec3(uv, 1.0f));
    }
};

float unit_range(float x) {
    return std::clamp(x, 0.0f, 1.0f);
}

SurfaceMaterial material_at(const Lookup& look) {
    const SceneMaterial& m = look.material();
    SurfaceMaterial out = m.surface;
    out.base_colour = glm::clamp(out.base_colour * Rgb(look(m.base_colour)), Rgb(0.0f), Rgb(1.0f));
    const vec4 metal_rough = look(m.metal_rough);
    out.metallic = unit_range(out.metallic * metal_rough.z);
    out.roughness = unit_range(out.roughness * metal_rough.y);
    out.transmission = unit_range(out.transmission * look(m.transmission).x);
    out.specular = unit_range(out.specular * look(m.specular).w);
    out.specular_colour *= Rgb(look(m.specular_colour));
    return out;
}

// The directions in which u and v grow, for normal maps. Zero where the triangle has no area in the texture.
void tangents(const Lookup& look, dvec3& u, dvec3& v) {
    const glm::uvec3& t = look.triangle;
    const dvec3 e1 = dvec3(look.mesh.positions[t.y]) - dvec3(look.mesh.positions[t.x]);
    const dvec3 e2 = dvec3(look.mesh.positions[t.z]) - dvec3(look.mesh.positions[t.x]);
    const glm::dvec2 d1 = glm::dvec2(look.mesh.uv[t.y]) - glm::dvec2(look.mesh.uv[t.x]);
    const glm::dvec2 d2 = glm::dvec2(look.mesh.uv[t.z]) - glm::dvec2(look.mesh.uv[t.x]);
    const double det = d1.x * d2.y - d1.y * d2.x;
    u = v = dvec3(0.0);
    if (det == 0.0)
        return;
    u = (d2.y * e1 - d1.y * e2) / det;
    v = (d1.x * e2 - d2.x * e1) / det;
}

// glTF's normal maps: x along growing u, y against growing v (which runs downward), z along the normal.
dvec3 mapped_normal(const Lookup& look, const dvec3& normal) {
    const SceneMaterial& m = look.material();
    if (m.normal.texture < 0 || look.mesh.uv.empty())
        return normal;
    dvec3 u, v;
    tangents(look, u, v);
    u -= glm::dot(u, normal) * normal;
    if (!(glm::dot(u, u) > 0.0))
        return normal;
    u = glm::normalize(u);
    dvec3 bitangent = glm::cross(normal, u);
    if (glm::dot(bitangent, v) > 0.0)
        bitangent = -bitangent;
    const vec4 texel = look(m.normal);
    const double x = (2.0 * texel.x - 1.0) * m.normal_scale, y = (2.0 * texel.y - 1.0) * m.normal_scale;
    const dvec3 bent = x * u + y * bitangent + std::max(2.0 * texel.z - 1.0, 1e-3) * normal;
    return glm::normalize(bent);
}

dvec3 shading_normal(const Lookup& look, const SurfaceHit& hit, const dvec3& geometric) {
    dvec3 n = geometric;
    if (!look.mesh.normals.empty()) {
        n = dvec3(interpolate(look.mesh.normals, look.triangle, hit.barycentric));
        const double length = glm::length(n);
        n = length > 1e-6 ? n / length : geometric;
        if (glm::dot(n, geometric) < 0.0)
            n = -n;
    }
    return mapped_normal(look, n);
}

// Turns n toward the viewer until their cosine is `least`.
dvec3 bent_toward(const dvec3& n, const dvec3& viewer, double least) {
    const double cosine = glm::dot(n, viewer);
    if (cosine >= least)
        return n;
    const dvec3 across = n - cosine * viewer;
    const double length = glm::length(across);
    if (!(length > 1e-12))
        return viewer;
    return least * viewer + std::sqrt(1.0 - least * least) / length * across;
}

// Embree subtracts single-precision vertices from the ray's origin and multiplies the differences: several roundings,
// each relative to the coordinates and edges at hand.
double clearance_of(const Triangle& t, const dvec3& p) {
    const auto largest = [](const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
    const double size = std::max({largest(t.b - t.a), largest(t.c - t.a), largest(t.c - t.b)});
    return 16.0 * 0x1p-24 * (largest(p) + size);
}

}  // namespace

Triangle triangle_of(const Scene& scene, std::uint32_t mesh, std::uint32_t triangle) {
    const SceneMesh& m = scene.meshes[mesh];
    const glm::uvec3& t = m.triangles[triangle];
    return {dvec3(m.positions[t.x]), dvec3(m.positions[t.y]), dvec3(m.positions[t.z])};
}

float alpha_at(const Scene& scene, const SurfaceHit& hit) {
    const Lookup look(scene, hit);
    return unit_range(look.material().alpha * look(look.material().base_colour).w);
}

Rgb emission_at(const Scene& scene, const SurfaceHit& hit) {
    const Lookup look(scene, hit);
    const SceneMaterial& m = look.material();
    return m.emits() ? m.emission * Rgb(look(m.emission_colour)) : Rgb(0.0f);
}

dvec3 SurfacePoint::start_toward(const dvec3& other) const {
    const bool above = glm::dot(geometric_normal, other - position) >= 0.0;
    return position + (above ? clearance : -clearance) * geometric_normal;
}

Ray SurfacePoint::leaving(const dvec3& direction) const {
    const bool above = glm::dot(geometric_normal, direction) >= 0.0;
    return {position + (above ? clearance : -clearance) * geometric_normal, direction};
}

SurfacePoint surface_point(const Scene& scene, const SurfaceHit& hit, const dvec3& toward_viewer) {
    const Lookup look(scene, hit);
    const SceneMaterial& m = look.material();
    const Triangle t = triangle_of(scene, hit.mesh, hit.triangle);
    const double u = hit.barycentric.x, v = hit.barycentric.y;
    SurfacePoint out;
    out.position = (1.0 - u - v) * t.a + u * t.b + v * t.c;
    out.geometric_normal = glm::normalize(t.normal());
    out.front = glm::dot(out.geometric_normal, toward_viewer) >= 0.0;
    out.material = material_at(look);
    out.clearance = clearance_of(t, out.position);
    if (m.emits() && (out.front || m.double_sided))
        out.emission = m.emission * Rgb(look(m.emission_colour));
    const double side = out.front ? 1.0 : -1.0;
    const dvec3 seen = bent_toward(side * shading_normal(look, hit, out.geometric_normal), toward_viewer, kJustSeen);
    const bool keeps_outside = out.material.transmission > 0.0f && !out.material.thin;
    out.frame = frame_around(keeps_outside ? side * seen : seen);
    return out;
}

}  // namespace brisance
