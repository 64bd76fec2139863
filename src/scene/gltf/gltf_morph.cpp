#include "scene/gltf/gltf_morph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/gltf/gltf_accessor.h"

namespace brisance {
namespace {

// The displacements of one attribute by one target, times its weight, added to `values`.
void displace(const GltfFile& file, int accessor, double weight, const std::string& what, std::vector<vec3>& values) {
    if (element_count(file, accessor, what) != values.size())
        file.reject(fmt::format("{} are not as many as the {} vertices", what, values.size()));
    if (weight == 0.0)
        return;
    const std::vector<vec3> displacements = read_vectors<vec3>(file, accessor, what);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const vec3& d = displacements[i];
        if (!std::isfinite(d.x) || !std::isfinite(d.y) || !std::isfinite(d.z))
            file.reject(what + " are not all finite");
        values[i] = vec3(dvec3(values[i]) + weight * dvec3(d));
    }
}

}  // namespace

std::size_t morph_target_count(const GltfFile& file, int mesh) {
    const tinygltf::Mesh& m = checked(file, file.model.meshes, mesh, "mesh");
    for (const tinygltf::Primitive& primitive : m.primitives)
        if (primitive.targets.size() != m.primitives.front().targets.size())
            file.reject(label("mesh", mesh, m.name) + " has primitives with different numbers of morph targets");
    return m.primitives.empty() ? 0 : m.primitives.front().targets.size();
}

std::vector<double> morph_weights(const GltfFile& file, const PlacedNode& placed) {
    const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(placed.node)];
    const std::size_t targets = morph_target_count(file, node.mesh);
    if (targets == 0)
        return {};
    const std::vector<double>& of_mesh = file.model.meshes[static_cast<std::size_t>(node.mesh)].weights;
    std::vector<double> weights = !placed.weights.empty() ? placed.weights
                                  : !node.weights.empty() ? node.weights
                                  : !of_mesh.empty()      ? of_mesh
                                                          : std::vector<double>(targets, 0.0);
    if (weights.size() != targets)
        file.reject(fmt::format("{} has {} weights, and its mesh {} morph targets",
                                label("node", placed.node, node.name), weights.size(), targets));
    if (!std::all_of(weights.begin(), weights.end(), [](double w) { return std::isfinite(w); }))
        file.reject(label("node", placed.node, node.name) + " has weights that are not finite");
    return weights;
}

void morph(const GltfFile& file, const tinygltf::Primitive& primitive, const std::vector<double>& weights,
           const std::string& name, SceneMesh& mesh, Progress& progress) {
    for (std::size_t t = 0; t < primitive.targets.size(); ++t)
        for (const auto& [attribute, accessor] : primitive.targets[t]) {
            const std::string what = fmt::format("{}, morph target {}: displacements", name, t);
            if (attribute == "POSITION")
                displace(file, accessor, weights[t], what + " of positions", mesh.positions);
            else if (attribute == "NORMAL" && !mesh.normals.empty())
                displace(file, accessor, weights[t], what + " of normals", mesh.normals);
            else if (attribute.starts_with("TEXCOORD_"))
                progress.notice(file.path.string() + ": texture coordinates of morph targets are left out");
        }
}

}  // namespace brisance
