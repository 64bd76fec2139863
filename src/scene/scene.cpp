#include "scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "scene/memory_budget.h"

namespace brisance {
namespace {

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

}  // namespace

std::size_t Scene::triangle_count() const {
    std::size_t count = 0;
    for (const SceneMesh& mesh : meshes)
        count += mesh.triangles.size();
    return count;
}

bool Scene::is_glossy() const {
    return std::ranges::any_of(materials, [](const SceneMaterial& m) { return needs_energy_tables(m.surface); });
}

bool Scene::is_flat() const {
    constexpr double kRounding = 1e-6;  // of positions, over their distance from a corner
    std::optional<dvec3> corner, normal;
    for (const SceneMesh& mesh : meshes)
        for (const glm::uvec3& t : mesh.triangles) {
            const dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
            if (const dvec3 n = glm::cross(b - a, c - a); !normal && glm::dot(n, n) > 0.0) {
                corner = a;
                normal = glm::normalize(n);
            }
            for (const dvec3& p : {a, b, c})
                if (normal && std::abs(glm::dot(*normal, p - *corner)) > kRounding * glm::length(p - *corner))
                    return false;
        }
    return true;
}

double Scene::largest_coordinate() const {
    float out = 0.0f;
    for (const SceneMesh& mesh : meshes)
        for (const vec3& p : mesh.positions)
            out = std::max({out, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return double(out);
}

std::uint64_t Scene::bytes() const {
    std::uint64_t sum = bytes_of(meshes) + bytes_of(materials) + bytes_of(textures) + bytes_of(cameras);
    for (const SceneMesh& mesh : meshes)
        sum += bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.uv) + bytes_of(mesh.triangles);
    for (const std::shared_ptr<const Texture>& texture : textures)
        sum += sizeof(Texture) + bytes_of(texture->bytes) + bytes_of(texture->floats);
    return sum;
}

void MemoryBudget::claim(const std::string& where, double bytes, double triangles) {
    bytes_ += bytes;
    triangles_ += triangles;
    if (bytes_ <= limit_)
        return;
    constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
    throw Error(ExitCode::Temporary,
                fmt::format("{}: with it the set's surfaces ({:.0f} triangles so far) need about {:.2f} GiB, more than "
                            "the {:.2f} GiB allowed; use simpler files, or a machine with more memory",
                            where, triangles_, bytes_ / kGiB, limit_ / kGiB));
}

std::uint64_t MemoryBudget::left() const {
    return bytes_ < limit_ ? static_cast<std::uint64_t>(std::min(limit_ - bytes_, 0x1p62)) : 0;
}

}  // namespace brisance
