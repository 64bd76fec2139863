#include "scene/gltf/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "scene/gltf/gltf_accessor.h"

namespace brisance {
namespace {

using glm::dquat;
using glm::dvec4;

// A node's own transform, before its parents'; `matrix` replaces the others (glTF 2.0, section 3.5.3).
struct Pose {
    dvec3 translation{0.0}, scale{1.0};
    dvec4 rotation{0.0, 0.0, 0.0, 1.0};  // quaternion x y z w
    std::optional<dmat4> matrix;
};

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
    const dvec4 q = pose.rotation / length;
    return glm::translate(dmat4(1.0), pose.translation) * glm::mat4_cast(dquat(q.w, q.x, q.y, q.z)) *
           glm::scale(dmat4(1.0), pose.scale);
}

// Keys of one channel, `components` numbers each; three such values a key where it is a cubic spline.
struct Keys {
    std::vector<float> times, values;
    std::size_t components = 3, values_per_key = 1;

    // The value of key k; of splines, part 0 and 2 are its tangents before and after, part 1 is the value.
    dvec4 value(std::size_t k, std::size_t part) const {
        dvec4 v(0.0);
        for (std::size_t c = 0; c < components; ++c)
            v[static_cast<int>(c)] = values[(k * values_per_key + part) * components + c];
        return v;
    }
};

Keys read_keys(const GltfFile& file, const tinygltf::AnimationSampler& sampler, int components,
               const std::string& what) {
    Keys keys;
    keys.components = static_cast<std::size_t>(components);
    keys.values_per_key = sampler.interpolation == "CUBICSPLINE" ? 3 : 1;
    for (const int accessor : {sampler.input, sampler.output})  // which bounds how many there can be
        if (checked(file, file.model.accessors, accessor, "animation accessor").bufferView < 0)
            file.reject(what + " has no data");
    keys.times = read_floats(file, sampler.input, 1, what + ": times");
    keys.values = read_floats(file, sampler.output, components, what + ": values");
    if (keys.times.empty() || keys.values.size() != keys.times.size() * keys.values_per_key * keys.components)
        file.reject(what + " does not have one value for each time");
    for (std::size_t k = 0; k < keys.times.size(); ++k)
        if (!std::isfinite(keys.times[k]) || (k > 0 && !(keys.times[k] > keys.times[k - 1])))
            file.reject(what + ": its times do not increase");
    for (const float value : keys.values)
        if (!std::isfinite(value))
            file.reject(what + " has values that are not finite");
    return keys;
}

dvec4 slerp(dvec4 a, dvec4 b, double t) {
    const double la = glm::length(a), lb = glm::length(b);
    if (!(la > 0.0) || !(lb > 0.0))
        return a;  // matrix_of reports it
    const dquat q =
        glm::slerp(dquat(a.w / la, a.x / la, a.y / la, a.z / la), dquat(b.w / lb, b.x / lb, b.y / lb, b.z / lb), t);
    return {q.x, q.y, q.z, q.w};
}

// Hermite's cubic between two keys that are `span` seconds apart (glTF 2.0, appendix C.4).
dvec4 cubic(const Keys& keys, std::size_t k, double t, double span) {
    const double t2 = t * t, t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * keys.value(k, 1) + span * (t3 - 2.0 * t2 + t) * keys.value(k, 2) +
           (3.0 * t2 - 2.0 * t3) * keys.value(k + 1, 1) + span * (t3 - t2) * keys.value(k + 1, 0);
}

dvec4 value_at(const Keys& keys, const std::string& interpolation, double seconds) {
    const std::size_t middle = keys.values_per_key == 3 ? 1 : 0;
    const auto later =
        std::upper_bound(keys.times.begin(), keys.times.end(), seconds, [](double s, float time) { return s < time; });
    if (later == keys.times.begin())
        return keys.value(0, middle);
    const auto k = static_cast<std::size_t>(later - keys.times.begin()) - 1;
    if (later == keys.times.end() || interpolation == "STEP")
        return keys.value(k, middle);
    const double span = static_cast<double>(keys.times[k + 1]) - keys.times[k];
    const double t = (seconds - keys.times[k]) / span;
    if (middle == 1)
        return cubic(keys, k, t, span);
    if (keys.components == 4)
        return slerp(keys.value(k, 0), keys.value(k + 1, 0), t);
    return glm::mix(keys.value(k, 0), keys.value(k + 1, 0), t);
}

// One channel of one animation.
class Channel {
public:
    Channel(const GltfFile& file, const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel)
        : file_(file), animation_(animation), channel_(channel) {}

    void apply(std::vector<Pose>& poses, double seconds, Progress& progress) const {
        const auto node = static_cast<std::size_t>(channel_.target_node);
        checked(file_, file_.model.nodes, channel_.target_node, "animated node");
        const std::string what = label("animation of node", channel_.target_node, channel_.target_path);
        const std::string& path = channel_.target_path;
        if (path == "weights")
            return;  // reported with the meshes, which keep their base shape
        if (path != "translation" && path != "rotation" && path != "scale") {
            progress.notice(fmt::format("{}: {} is left out", file_.path.string(), what));
            return;
        }
        if (poses[node].matrix) {
            progress.warning("animated-matrix",
                             fmt::format("{}: {} has a matrix, its animation is left out", file_.path.string(),
                                         label("node", channel_.target_node, "")));
            return;
        }
        const auto& sampler = checked(file_, animation_.samplers, channel_.sampler, "animation sampler");
        if (sampler.interpolation != "LINEAR" && sampler.interpolation != "STEP" &&
            sampler.interpolation != "CUBICSPLINE")
            file_.reject(what + " has an interpolation that glTF does not know");
        const Keys keys = read_keys(file_, sampler, path == "rotation" ? 4 : 3, what);
        const dvec4 value = value_at(keys, sampler.interpolation, seconds);
        if (path == "rotation")
            poses[node].rotation = value;
        else
            (path == "scale" ? poses[node].scale : poses[node].translation) = dvec3(value.x, value.y, value.z);
    }

private:
    const GltfFile& file_;
    const tinygltf::Animation& animation_;
    const tinygltf::AnimationChannel& channel_;
};

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

}  // namespace

std::vector<PlacedNode> place_nodes(const GltfFile& file, const dmat4& world_from_file, double seconds,
                                    Progress& progress) {
    const std::vector<tinygltf::Node>& nodes = file.model.nodes;
    std::vector<Pose> poses(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
        poses[i] = pose_of(file, static_cast<int>(i));
    for (const tinygltf::Animation& animation : file.model.animations)
        for (const tinygltf::AnimationChannel& channel : animation.channels)
            if (channel.target_node >= 0)  // else an extension's
                Channel(file, animation, channel).apply(poses, seconds, progress);

    std::vector<PlacedNode> placed;
    std::vector<bool> seen(nodes.size());
    std::vector<PlacedNode> open;  // nodes whose parent is placed; a list, so that depth costs no stack
    const auto push_all = [&](const std::vector<int>& indices, const dmat4& world_from_parent) {
        for (auto i = indices.rbegin(); i != indices.rend(); ++i)
            open.push_back({*i, world_from_parent});
    };
    push_all(root_nodes(file), world_from_file);
    while (!open.empty()) {
        const auto [index, world_from_parent] = open.back();
        open.pop_back();
        const tinygltf::Node& node = checked(file, nodes, index, "node");
        const auto i = static_cast<std::size_t>(index);
        if (seen[i])
            file.reject(label("node", index, node.name) + " is its own ancestor, or has two parents");
        seen[i] = true;
        placed.push_back({index, world_from_parent * matrix_of(file, poses[i], index)});
        push_all(node.children, placed.back().world_from_node);
    }
    return placed;
}

}  // namespace brisance
