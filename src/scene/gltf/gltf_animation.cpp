#include "scene/gltf/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "scene/gltf/gltf_accessor.h"
#include "scene/gltf/gltf_morph.h"

namespace brisance {
namespace {

using glm::dquat;
using glm::dvec4;

// Keys of one channel, `width` numbers a value; three such values a key where it is a cubic spline.
struct Keys {
    std::vector<float> times, values;
    std::size_t width = 3, values_per_key = 1;
    std::size_t first = 0, components = 3;  // of each value: what value() gives, four numbers at most

    std::size_t middle() const { return values_per_key == 3 ? 1 : 0; }

    // The value of key k; of splines, part 0 and 2 are its tangents before and after, part 1 is the value.
    dvec4 value(std::size_t k, std::size_t part) const {
        dvec4 v(0.0);
        for (std::size_t c = 0; c < components; ++c)
            v[static_cast<int>(c)] = values[(k * values_per_key + part) * width + first + c];
        return v;
    }

    // Whether moments may differ: other values than the first key's, or tangents.
    bool change() const {
        const std::size_t per_key = values_per_key * width;
        for (std::size_t i = 0; times.size() > 1 && i < values.size(); ++i) {
            const bool tangent = i % per_key / width != middle();
            if (values[i] != (tangent ? 0.0f : values[i % per_key]))
                return true;
        }
        return false;
    }
};

// Keys of values of `width` numbers, which the accessor holds as elements of `components` numbers.
Keys read_keys(const GltfFile& file, const tinygltf::AnimationSampler& sampler, int components, std::size_t width,
               const std::string& what) {
    Keys keys;
    keys.width = width;
    keys.components = static_cast<std::size_t>(components);
    keys.values_per_key = sampler.interpolation == "CUBICSPLINE" ? 3 : 1;
    for (const int accessor : {sampler.input, sampler.output})  // which bounds how many there can be
        if (checked(file, file.model.accessors, accessor, "animation accessor").bufferView < 0)
            file.reject(what + " has no data");
    keys.times = read_floats(file, sampler.input, 1, what + ": times");
    keys.values = read_floats(file, sampler.output, components, what + ": values");
    if (keys.times.empty() || keys.values.size() != keys.times.size() * keys.values_per_key * width)
        file.reject(fmt::format("{} does not have {} for each time", what,
                                width == keys.components ? "one value" : fmt::format("{} weights", width)));
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
        return a;  // gltf_nodes.cpp reports it
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
    const std::size_t middle = keys.middle();
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

// One channel of one animation, of a node that exists.
class Channel {
public:
    Channel(const GltfFile& file, const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel)
        : file_(file),
          animation_(animation),
          channel_(channel),
          what_(label("animation of node", channel.target_node, channel.target_path)) {
        checked(file_, file_.model.nodes, channel_.target_node, "animated node");
    }

    void apply(std::vector<Pose>& poses, double seconds, Progress& progress) const {
        Pose& pose = poses[static_cast<std::size_t>(channel_.target_node)];
        const std::string& path = channel_.target_path;
        if (path == "weights")
            return apply_weights(pose, seconds, progress);
        if (path != "translation" && path != "rotation" && path != "scale") {
            progress.notice(fmt::format("{}: {} is left out", file_.path.string(), what_));
            return;
        }
        if (pose.matrix) {
            progress.warning("animated-matrix",
                             fmt::format("{}: {} has a matrix, its animation is left out", file_.path.string(),
                                         label("node", channel_.target_node, "")));
            return;
        }
        const int components = path == "rotation" ? 4 : 3;
        const Keys keys = read_keys(file_, sampler(), components, static_cast<std::size_t>(components), what_);
        const dvec4 value = value_at(keys, sampler().interpolation, seconds);
        if (path == "rotation")
            pose.rotation = value;
        else
            (path == "scale" ? pose.scale : pose.translation) = dvec3(value.x, value.y, value.z);
        pose.moves = pose.moves || keys.change();
    }

private:
    void apply_weights(Pose& pose, double seconds, Progress& progress) const {
        const tinygltf::Node& node = file_.model.nodes[static_cast<std::size_t>(channel_.target_node)];
        const std::size_t targets = node.mesh < 0 ? 0 : morph_target_count(file_, node.mesh);
        if (targets == 0) {
            progress.notice(fmt::format("{}: {} is left out, there are no morph targets", file_.path.string(), what_));
            return;
        }
        Keys keys = read_keys(file_, sampler(), 1, targets, what_);
        pose.weights.resize(targets);
        for (keys.first = 0; keys.first < targets; ++keys.first)
            pose.weights[keys.first] = value_at(keys, sampler().interpolation, seconds).x;
        pose.morphs = pose.morphs || keys.change();
    }

    const tinygltf::AnimationSampler& sampler() const {
        const auto& sampler = checked(file_, animation_.samplers, channel_.sampler, "animation sampler");
        if (sampler.interpolation != "LINEAR" && sampler.interpolation != "STEP" &&
            sampler.interpolation != "CUBICSPLINE")
            file_.reject(what_ + " has an interpolation that glTF does not know");
        return sampler;
    }

    const GltfFile& file_;
    const tinygltf::Animation& animation_;
    const tinygltf::AnimationChannel& channel_;
    std::string what_;
};

}  // namespace

void apply_animations(const GltfFile& file, double seconds, std::vector<Pose>& poses, Progress& progress) {
    for (const tinygltf::Animation& animation : file.model.animations)
        for (const tinygltf::AnimationChannel& channel : animation.channels)
            if (channel.target_node >= 0)  // else an extension's
                Channel(file, animation, channel).apply(poses, seconds, progress);
}

}  // namespace brisance
