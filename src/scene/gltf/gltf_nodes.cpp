#include "scene/gltf/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>

#include "scene/gltf/gltf_animation.h"

namespace brisance {
namespace {

// numbers[0..n) of a node's property, all finite; false where the file does not give it.
template <class Store>
bool read_numbers(const GltfFile& file, const std::vector<double>& numbers, std::size_t n, const std::string& what,
                  const Store& store) {
    if (numbers.empty())
        return false;
    if (numbers.size() != n || !std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        file.reject(fmt::format("{} must be {} finite numbers", what, n));
    store(numbers.data());
    return true;
}

Pose pose_of(const GltfFile& file, int index) {
    const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(index)];
    const std::string name = label("node", index, node.name);
    Pose pose;
    read_numbers(file, node.translation, 3, "translation of " + name, [&](const double* x) {
        pose.translation = {x[0], x[1], x[2]};
    });
    read_numbers(file, node.scale, 3, "scale of " + name, [&](const double* x) { pose.scale = {x[0], x[1], x[2]}; });
    read_numbers(file, node.rotation, 4, "rotation of " + name, [&](const double* x) {
        pose.rotation = {x[0], x[1], x[2], x[3]};
    });
    read_numbers(file, node.matrix, 16, "matrix of " + name, [&](const double* x) {
        pose.matrix.emplace();
        for (int i = 0; i < 16; ++i)
            (*pose.matrix)[i / 4][i % 4] = x[i];
    });
    return pose;
}

dmat4 matrix_of(const GltfFile& file, const Pose& pose, int index) {
    if (pose.matrix)
        return *pose.matrix;
    const double length = glm::length(pose.rotation);
    if (!(length > 1e-6) || !std::isfinite(length))
        file.reject(label("node", index, file.model.nodes[static_cast<std::size_t>(index)].name) +
                    " is rotated by a quaternion without length");
    const glm::dvec4 q = pose.rotation / length;
    return glm::translate(dmat4(1.0), pose.translation) * glm::mat4_cast(glm::dquat(q.w, q.x, q.y, q.z)) *
           glm::scale(dmat4(1.0), pose.scale);
}

std::vector<int> root_nodes(const GltfFile& file) {
    const tinygltf::Model& model = file.model;
    if (model.defaultScene >= 0)
        return checked(file, model.scenes, model.defaultScene, "scene").nodes;
    if (!model.scenes.empty())
        return model.scenes.front().nodes;
    std::vector<bool> child(model.nodes.size());
    for (const tinygltf::Node& node : model.nodes)
        for (const int c : node.children) {
            checked(file, model.nodes, c, "child node");
            child[static_cast<std::size_t>(c)] = true;
        }
    std::vector<int> roots;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        if (!child[i])
            roots.push_back(static_cast<int>(i));
    return roots;
}

// A node to be placed.
struct Child {
    int node = 0;
    dmat4 world_from_parent{1.0};
    bool parent_moves = false;
};

}  // namespace

std::vector<PlacedNode> place_nodes(const GltfFile& file, const dmat4& world_from_file, double seconds,
                                    Progress& progress) {
    const std::vector<tinygltf::Node>& nodes = file.model.nodes;
    std::vector<Pose> poses(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
        poses[i] = pose_of(file, static_cast<int>(i));
    apply_animations(file, seconds, poses, progress);

    std::vector<PlacedNode> placed;
    std::vector<bool> seen(nodes.size());
    std::vector<Child> open;  // nodes whose parent is placed; a list, so that depth costs no stack
    const auto push_all = [&](const std::vector<int>& indices, const dmat4& world_from_parent, bool parent_moves) {
        for (auto i = indices.rbegin(); i != indices.rend(); ++i)
            open.push_back({*i, world_from_parent, parent_moves});
    };
    push_all(root_nodes(file), world_from_file, false);
    while (!open.empty()) {
        const auto [index, world_from_parent, parent_moves] = open.back();
        open.pop_back();
        const tinygltf::Node& node = checked(file, nodes, index, "node");
        const auto i = static_cast<std::size_t>(index);
        if (seen[i])
            file.reject(label("node", index, node.name) + " is its own ancestor, or has two parents");
        seen[i] = true;
        placed.push_back({index, world_from_parent * matrix_of(file, poses[i], index), parent_moves || poses[i].moves,
                          poses[i].morphs, std::move(poses[i].weights)});
        push_all(node.children, placed.back().world_from_node, placed.back().moves);
    }
    return placed;
}

}  // namespace brisance
