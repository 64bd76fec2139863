#include "scene/quick_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.h"
#include "scene/gltf/gltf_meshes.h"

namespace brisance {
namespace {

using glm::uvec3;

int add_material(const QuickMaterial& quick, const std::string& name, bool thin, Scene& scene) {
    SceneMaterial material;
    material.name = name;
    material.surface.base_colour = quick.colour;
    material.surface.metallic = quick.metallic;
    material.surface.roughness = quick.roughness;
    material.surface.ior = quick.ior;
    material.surface.specular = quick.specular;
    material.surface.transmission = quick.transmission;
    material.emission = quick.emission;
    material.surface.thin = thin && quick.transmission > 0.0f;
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

// How far the last corner is from the plane of the others, as a share of the quad's size.
double out_of_plane(const std::array<dvec3, 4>& corners) {
    const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const dvec3 across = corners[3] - corners[0];
    const double size = glm::length(normal) * (glm::length(across) + glm::length(corners[2] - corners[0]));
    return size > 0.0 ? std::abs(glm::dot(normal, across)) / size : 0.0;
}

// An icosahedron whose triangles are split into four again and again, corners moved out onto the unit sphere.
struct Icosphere {
    std::vector<dvec3> corners;
    std::vector<uvec3> triangles;
};

Icosphere icosahedron() {
    const double g = (1.0 + std::sqrt(5.0)) / 2.0;
    Icosphere result;
    result.corners = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    for (dvec3& corner : result.corners)
        corner = glm::normalize(corner);
    result.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    return result;
}

Icosphere split(const Icosphere& coarse) {
    Icosphere fine{coarse.corners, {}};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [entry, fresh] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.corners.size()));
        if (fresh)
            fine.corners.push_back(glm::normalize(coarse.corners[a] + coarse.corners[b]));
        return entry->second;
    };
    for (const uvec3& t : coarse.triangles) {
        const std::uint32_t a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
        fine.triangles.insert(fine.triangles.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
    }
    return fine;
}

const Icosphere& unit_sphere() {
    static const Icosphere sphere = split(split(split(split(split(icosahedron())))));
    return sphere;
}

}  // namespace

void add_quad(const QuickQuad& quad, const std::string& name, Scene& scene, Progress& progress) {
    SceneMesh mesh;
    mesh.name = name;
    for (const dvec3& corner : quad.corners)
        mesh.positions.push_back(vec3(corner - scene.origin));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    LeftOut left_out;
    leave_out_unusable(mesh, left_out);
    if (mesh.triangles.empty()) {
        progress.warning("no-area", name + " has no area, it is left out");
        return;
    }
    left_out.warn(name, progress);
    if (out_of_plane(quad.corners) > 1e-4)
        progress.warning("not-flat", name + " is not flat, it is two triangles that meet between corners 0 and 2");
    mesh.material = add_material(quad.material, name, true, scene);
    scene.meshes.push_back(std::move(mesh));
}

// Lamps are hung exactly on ceilings, which would hide them as rounding goes: they are moved to their front by a few
// roundings.
void add_quad_light(const LightSettings& light, double extent, Scene& scene, Progress& progress) {
    QuickQuad quad;
    quad.corners = light.corners;
    const dvec3 normal = glm::cross(light.corners[2] - light.corners[0], light.corners[3] - light.corners[1]);
    double largest = extent;
    for (const dvec3& corner : light.corners)
        largest = std::max(largest, glm::length(corner - scene.origin));
    if (const double length = glm::length(normal); length > 0.0)
        for (dvec3& corner : quad.corners)
            corner += 0x1p-18 * largest / length * normal;
    quad.material.colour = Rgb(0.0f);
    quad.material.emission = light.power;
    add_quad(quad, light.name.empty() ? "quad light" : light.name, scene, progress);
}

void add_sphere(const QuickSphere& sphere, const std::string& name, Scene& scene, MemoryBudget& budget) {
    const dvec3 centre = sphere.centre - scene.origin;
    if (!(sphere.radius > 0.0) || !std::isfinite(sphere.radius) || !std::isfinite(glm::dot(centre, centre)))
        throw Error(ExitCode::BadData, fmt::format("{}: its radius is {}; give a radius above 0, and finite numbers",
                                                   name, sphere.radius));
    const Icosphere& unit = unit_sphere();
    budget.claim(name,
                 bytes_with_tree(static_cast<double>(unit.triangles.size()), static_cast<double>(unit.corners.size())),
                 static_cast<double>(unit.triangles.size()));
    SceneMesh mesh;
    mesh.name = name;
    mesh.triangles = unit.triangles;
    for (const dvec3& corner : unit.corners) {
        mesh.positions.push_back(vec3(centre + sphere.radius * corner));
        mesh.normals.push_back(vec3(corner));
    }
    mesh.material = add_material(sphere.material, name, false, scene);
    scene.meshes.push_back(std::move(mesh));
}

}  // namespace brisance
