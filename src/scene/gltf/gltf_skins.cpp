#include "scene/gltf/gltf_skins.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/gltf/gltf_accessor.h"

namespace brisance {
namespace {

int attribute_of_set(const tinygltf::Primitive& primitive, const char* kind, std::size_t set) {
    const auto found = primitive.attributes.find(fmt::format("{}_{}", kind, set));
    return found != primitive.attributes.end() ? found->second : -1;
}

// JOINTS_n and WEIGHTS_n of all vertices: four joints each, and their weights.
struct SkinSet {
    std::vector<std::uint32_t> joints;
    std::vector<float> weights;
};

SkinSet read_set(const GltfFile& file, const tinygltf::Primitive& primitive, const Skin& skin, std::size_t set,
                 std::size_t vertices, const std::string& name) {
    const std::string joints = fmt::format("{}: JOINTS_{}", name, set);
    const std::string weights = fmt::format("{}: WEIGHTS_{}", name, set);
    const int joints_accessor = attribute_of_set(primitive, "JOINTS", set);
    const int weights_accessor = attribute_of_set(primitive, "WEIGHTS", set);
    for (const auto& [accessor, what] : {std::pair(joints_accessor, &joints), std::pair(weights_accessor, &weights)})
        if (const std::size_t count = element_count(file, accessor, *what); count != vertices)
            file.reject(fmt::format("{} has {} elements, and there are {} vertices", *what, count, vertices));
    SkinSet result{read_indices(file, joints_accessor, joints, 4), read_floats(file, weights_accessor, 4, weights)};
    for (const float w : result.weights)
        if (!(w >= 0.0f) || !std::isfinite(w))
            file.reject(fmt::format("{} has the weight {}, which is not a number from 0 on", weights, w));
    for (std::size_t i = 0; i < result.joints.size(); ++i)
        if (result.joints[i] >= skin.joints.size())
            file.reject(fmt::format("{} names joint {}, and {} has {} joints", joints, result.joints[i], skin.name,
                                    skin.joints.size()));
    return result;
}

// The mean of the joints' maps for one vertex, and whether it has any weight.
std::pair<Affine, bool> blended(const std::vector<SkinSet>& sets, const Skin& skin, std::size_t vertex) {
    Affine sum{dmat3(0.0), dvec3(0.0)};
    double total = 0.0;
    for (const SkinSet& set : sets)
        for (std::size_t i = 4 * vertex; i < 4 * vertex + 4; ++i)
            if (const double w = set.weights[i]; w > 0.0) {
                const Affine& joint = skin.joints[set.joints[i]];
                sum.linear += w * joint.linear;
                sum.offset += w * joint.offset;
                total += w;
            }
    if (total == 0.0)
        return {skin.joints[sets.front().joints[4 * vertex]], false};
    return {{sum.linear / total, sum.offset / total}, true};
}

// A triangle is mirrored where most of its corners are.
void turn_mirrored(const std::vector<std::uint8_t>& mirrored, SceneMesh& mesh) {
    for (glm::uvec3& t : mesh.triangles)
        if (mirrored[t.x] + mirrored[t.y] + mirrored[t.z] >= 2)
            std::swap(t.y, t.z);
}

}  // namespace

GltfSkins::GltfSkins(const GltfFile& file, const std::vector<PlacedNode>& nodes, const dvec3& origin,
                     MemoryBudget& budget)
    : file_(file), nodes_(nodes), origin_(origin), budget_(budget) {}

const Skin& GltfSkins::skin(int index) {
    if (const auto known = skins_.find(index); known != skins_.end())
        return known->second;
    const tinygltf::Skin& skin = checked(file_, file_.model.skins, index, "skin");
    budget_.claim(file_.path.string(), static_cast<double>(skin.joints.size() * (sizeof(Affine) + sizeof(dmat4))));
    if (placed_.empty())
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            placed_[nodes_[i].node] = static_cast<int>(i);
    return skins_[index] = read(index);
}

Skin GltfSkins::read(int index) const {
    const tinygltf::Skin& source = file_.model.skins[static_cast<std::size_t>(index)];
    Skin skin{label("skin", index, source.name), {}, false};
    if (source.joints.empty())
        file_.reject(skin.name + " has no joints");
    const std::vector<dmat4> inverse_bind =
        inverse_bind_matrices(source.inverseBindMatrices, source.joints.size(), skin.name);
    for (std::size_t j = 0; j < source.joints.size(); ++j) {
        checked(file_, file_.model.nodes, source.joints[j], (skin.name + ": node").c_str());
        const auto found = placed_.find(source.joints[j]);
        if (found == placed_.end())
            file_.reject(fmt::format("{}: its joint, node {}, is not in the scene", skin.name, source.joints[j]),
                         "export the joints with the mesh");
        const PlacedNode& node = nodes_[static_cast<std::size_t>(found->second)];
        skin.joints.push_back(Affine::local(node.world_from_node * inverse_bind[j], origin_));
        skin.moves = skin.moves || node.moves;
    }
    return skin;
}

std::vector<dmat4> GltfSkins::inverse_bind_matrices(int accessor, std::size_t joints, const std::string& name) const {
    std::vector<dmat4> matrices(joints, dmat4(1.0));
    if (accessor == -1)
        return matrices;
    const std::string what = name + ": inverse bind matrices";
    const tinygltf::Accessor& described =
        checked(file_, file_.model.accessors, accessor, (what + ": accessor").c_str());
    if (described.type != TINYGLTF_TYPE_MAT4 || described.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        file_.reject(what + " are not 4x4 matrices of floats");
    if (described.bufferView < 0)  // which bounds how many there can be
        file_.reject(what + " have no data");
    const std::size_t count = element_count(file_, accessor, what);
    if (count < joints)
        file_.reject(fmt::format("{} are {}, and there are {} joints", what, count, joints));
    budget_.claim(file_.path.string(), static_cast<double>(count) * 16 * sizeof(float));
    const std::vector<float> numbers = read_floats(file_, accessor, 16, what);
    for (std::size_t j = 0; j < joints; ++j) {
        for (std::size_t i = 0; i < 16; ++i) {
            const float x = numbers[16 * j + i];
            const double last_row = i == 15 ? 1.0 : 0.0;
            if (!std::isfinite(x) || (i % 4 == 3 && !(std::abs(x - last_row) <= 1e-4)))
                file_.reject(fmt::format("{}: number {} is not finite, or its last row is not 0 0 0 1", what, j));
            matrices[j][static_cast<int>(i / 4)][static_cast<int>(i % 4)] = i % 4 == 3 ? last_row : double{x};
        }
    }
    return matrices;
}

std::size_t skin_set_count(const GltfFile& file, const tinygltf::Primitive& primitive, const std::string& name) {
    std::size_t joints = 0, weights = 0;
    while (attribute_of_set(primitive, "JOINTS", joints) >= 0)
        ++joints;
    while (attribute_of_set(primitive, "WEIGHTS", weights) >= 0)
        ++weights;
    if (joints == 0 || joints != weights)
        file.reject(fmt::format("{} has a skin, {} sets of joints and {} of weights; each needs the other", name,
                                joints, weights));
    return joints;
}

void pose_by_skin(const GltfFile& file, const tinygltf::Primitive& primitive, const Skin& skin, const std::string& name,
                  SceneMesh& mesh, Progress& progress) {
    const std::size_t vertices = mesh.positions.size();
    std::vector<SkinSet> sets(skin_set_count(file, primitive, name));
    for (std::size_t s = 0; s < sets.size(); ++s)
        sets[s] = read_set(file, primitive, skin, s, vertices, name);
    std::vector<std::uint8_t> mirrored(vertices);
    std::size_t without_weight = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto [map, has_weight] = blended(sets, skin, v);
        without_weight += has_weight ? 0 : 1;
        mirrored[v] = map.mirrors() ? 1 : 0;
        mesh.positions[v] = map.position(mesh.positions[v]);
        if (!mesh.normals.empty())
            mesh.normals[v] = NormalMap(map).normal(mesh.normals[v]);
    }
    turn_mirrored(mirrored, mesh);
    if (without_weight > 0)
        progress.warning("skin-weights", fmt::format("{}: {}: {} vertices without weight follow their first joint",
                                                     file.path.string(), name, without_weight));
}

}  // namespace brisance
