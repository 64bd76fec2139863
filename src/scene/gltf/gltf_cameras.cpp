#include "scene/gltf/gltf_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace brisance {
namespace {

dvec3 column(const dmat4& m, int i) {
    return dvec3(m[i].x, m[i].y, m[i].z);
}

// Turns and moves as `m` does, without its scale, shear or reflection: z stays, y stays in the plane of y and z.
std::optional<dmat4> rigid(const dmat4& m) {
    const double z_length = glm::length(column(m, 2));
    if (!(z_length > 0.0) || !std::isfinite(z_length))
        return std::nullopt;
    const dvec3 z = column(m, 2) / z_length;
    const dvec3 x = glm::cross(column(m, 1), z);
    const double x_length = glm::length(x);
    if (!(x_length > 1e-12 * glm::length(column(m, 1))) || !std::isfinite(x_length))
        return std::nullopt;
    const dvec3 side = x / x_length, up = glm::cross(z, side);
    return dmat4(glm::dvec4(side, 0.0), glm::dvec4(up, 0.0), glm::dvec4(z, 0.0), m[3]);
}

SceneCamera camera_of(const GltfFile& file, const tinygltf::Camera& camera, const std::string& name) {
    const double yfov = camera.perspective.yfov, aspect = camera.perspective.aspectRatio;
    constexpr double kPi = 3.14159265358979323846;
    if (!(yfov > 0.0) || !(yfov < kPi))
        file.reject(fmt::format("camera {}: yfov is {} rad, not between 0 and pi", name, yfov));
    if (!(aspect >= 0.0))
        file.reject(fmt::format("camera {}: aspectRatio is {}, not above 0", name, aspect));
    SceneCamera result;
    result.name = name;
    result.vertical_fov_degrees = yfov * 180.0 / kPi;
    if (aspect > 0.0)  // 0: tinygltf's value for none
        result.aspect = aspect;
    return result;
}

int light_of(const tinygltf::Node& node) {
    const auto extension = node.extensions.find("KHR_lights_punctual");
    if (extension == node.extensions.end() || !extension->second.Has("light"))
        return -1;
    const tinygltf::Value& light = extension->second.Get("light");
    return light.IsInt() ? light.GetNumberAsInt() : -1;
}

LightSettings light_settings(const GltfFile& file, const tinygltf::Light& light, const std::string& name) {
    LightSettings settings;
    settings.name = name;
    if (light.type == "directional")
        settings.kind = LightKind::Sun;
    else if (light.type == "spot")
        settings.kind = LightKind::Spot;
    else if (light.type != "point")
        file.reject(fmt::format("light {} is of a kind that KHR_lights_punctual does not know", name));
    constexpr float kMostPower = 1e20f;  // sums of more overflow
    Rgb colour(1.0f);
    for (std::size_t c = 0; c < 3 && light.color.size() == 3; ++c)
        colour[static_cast<int>(c)] = static_cast<float>(light.color[c]);
    settings.power = colour * static_cast<float>(light.intensity);
    for (int c = 0; c < 3; ++c)
        if (!(settings.power[c] >= 0.0f && settings.power[c] <= kMostPower))
            file.reject(fmt::format("light {}: colour times intensity is not a number in [0, {}]", name, kMostPower));
    constexpr double kDegrees = 180.0 / 3.14159265358979323846;
    if (settings.kind == LightKind::Spot) {
        settings.inner_degrees = light.spot.innerConeAngle * kDegrees;
        settings.outer_degrees = light.spot.outerConeAngle * kDegrees;
        if (!(settings.inner_degrees >= 0.0) || !(settings.outer_degrees > settings.inner_degrees) ||
            settings.outer_degrees > 90.0 + 1e-6)
            file.reject(fmt::format("light {}: its cones must be 0 <= inner < outer <= pi / 2", name));
    }
    return settings;
}

}  // namespace

std::vector<SceneCamera> read_cameras(const GltfFile& file, const std::vector<PlacedNode>& nodes, Progress& progress) {
    std::vector<SceneCamera> cameras;
    for (const PlacedNode& placed : nodes) {
        const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(placed.node)];
        if (node.camera < 0)
            continue;
        const tinygltf::Camera& camera = checked(file, file.model.cameras, node.camera, "camera");
        const std::string name = !node.name.empty() ? node.name : camera.name;
        if (camera.type != "perspective") {
            progress.notice(fmt::format("{}: {} is not a perspective camera, it is left out", file.path.string(),
                                        label("camera", node.camera, name)));
            continue;
        }
        SceneCamera result = camera_of(file, camera, name);
        if (const auto matrix = rigid(placed.world_from_node)) {
            result.world_from_camera = *matrix;
            cameras.push_back(result);
        } else {
            progress.warning("flat-camera", fmt::format("{}: {} is left out, its node is scaled to nothing",
                                                        file.path.string(), label("camera", node.camera, name)));
        }
    }
    return cameras;
}

std::vector<LightSettings> read_lights(const GltfFile& file, const std::vector<PlacedNode>& nodes, Progress& progress) {
    std::vector<LightSettings> lights;
    bool ranges = false;
    for (const PlacedNode& placed : nodes) {
        const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(placed.node)];
        const int index = light_of(node);
        if (index < 0)
            continue;
        const tinygltf::Light& light = checked(file, file.model.lights, index, "light");
        LightSettings settings = light_settings(file, light, !node.name.empty() ? node.name : light.name);
        settings.position = column(placed.world_from_node, 3);
        settings.direction = -column(placed.world_from_node, 2);
        if (settings.kind != LightKind::Point && !(glm::length(settings.direction) > 0.0))
            file.reject(fmt::format("light {}: its node is scaled to nothing and has no direction", settings.name));
        lights.push_back(settings);
        ranges = ranges || light.range > 0.0;
    }
    if (ranges)
        progress.notice(file.path.string() + ": the ranges of lights are left out, light goes on");
    return lights;
}

bool moves_camera_or_light(const GltfFile& file, const std::vector<PlacedNode>& nodes) {
    return std::any_of(nodes.begin(), nodes.end(), [&](const PlacedNode& placed) {
        const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(placed.node)];
        return placed.moves && (node.camera >= 0 || light_of(node) >= 0);
    });
}

}  // namespace brisance
