#include "shot/check_shot.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "virtual_lights/choices.h"

namespace brisance {
namespace {

using Given = std::map<std::string, std::string>;

constexpr double kRigidTolerance = 1e-4;  // matrices come from files with six digits

[[noreturn]] void reject(const Given& given, const std::string& key, const std::string& why) {
    throw Error(ExitCode::Usage, fmt::format("{}: {}: {}", given.at(key), key, why));
}

void check_matrix(const Given& given, const dmat4& m) {
    const std::string key = "camera.world_from_camera";
    for (const char* other : {"camera.eye", "camera.target", "camera.up"})
        if (given.contains(other))
            reject(
                given, key,
                fmt::format("cannot be combined with {}, which is given too ({}); remove one", other, given.at(other)));
    if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0)
        reject(given, key,
               "the last row must be 0 0 0 1; the 16 numbers are row after row, translation at the rows' ends");
    const dmat3 axes(m);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j)
            if (!(std::abs(glm::dot(axes[i], axes[j]) - (i == j ? 1.0 : 0.0)) < kRigidTolerance))
                reject(given, key, "must be rigid (a rotation and a translation), without scale or shear");
    if (glm::determinant(axes) < 0.0)
        reject(given, key, "is mirrored; it must be right-handed: x right, y up, looking along -z");
}

void check_look_at(const Given& given, const CameraSettings& camera) {
    for (const auto& [key, other] : {std::pair{"camera.eye", "camera.target"}, {"camera.target", "camera.eye"}})
        if (given.contains(key) && !given.contains(other))
            reject(given, key, fmt::format("is given without {}; give both, or none for a framed camera", other));
    const std::string up_key = given.contains("camera.up") ? "camera.up" : "camera.eye";
    const double up = glm::length(camera.up);
    if (given.contains("camera.up") && !(up > 0.0))
        reject(given, up_key, "has no length");
    if (!given.contains("camera.eye"))
        return;
    const dvec3 forward = camera.target - camera.eye;
    const double distance = glm::length(forward);
    if (!(distance > 0.0))
        reject(given, "camera.eye", "is where camera.target is: there is no direction to look in");
    if (glm::length(glm::cross(forward, camera.up)) < 1e-9 * distance * up)
        reject(given, up_key, "the camera looks along camera.up; choose another up, e.g. [0, 1, 0]");
}

void check_fire(const Given& given, const FireSettings& fire) {
    if (fire.temperature_in.x == fire.temperature_in.y)
        reject(given, "fire.temperature_in", "the two values must differ");
    if (fire.modulate_by_flame && fire.model != FireModel::Blackbody && fire.model != FireModel::NormalizedBlackbody)
        reject(given, "fire.modulate_by_flame", "works with fire.model blackbody or blackbody_normalized only");
}

// Lamps in the place of the fire are lights of a hierarchy of one level.
void check_fire_lights(const Given& given, const Shot& shot) {
    if (shot.fire_lights.sampling != kFireByHierarchy && shot.lighting.clusters > 0)
        reject(given, given.contains("lighting.clusters") ? "lighting.clusters" : "fire_lights.sampling",
               "lamps in the place of the fire go with fire_lights.sampling=hierarchy only, not with " +
                   shot.fire_lights.sampling);
}

// Of choices that do not go with lights of all kinds together, and what would do; empty: all do.
std::string why_not_unified(const Shot& shot, const std::string& key) {
    if (key == "lighting.clusters" && shot.lighting.clusters > 0)
        return "lamps in the place of the fire need lighting.clusters=0";
    if (key == "fire_lights.sampling" && shot.unified_lights.smoke && shot.fire_lights.sampling != kFireByHierarchy)
        return "the fire's lights are among those of all kinds, on surfaces and in smoke: fire_lights.sampling=" +
               std::string(kFireByHierarchy) + ", or unified_lights.smoke=false";
    if (key == "virtual_lights.resampling_neighbours" && shot.virtual_lights.resampling_neighbours > 0)
        return "pixels reuse what virtual lights alone have chosen: resampling_neighbours=0";
    if (key == "output.layers.bound" && shot.output.bound_layers)
        return "what the bound takes is not told apart in one sum of all lights: output.layers.bound=false";
    return {};
}

void check_unified_lights(const Given& given, const Shot& shot) {
    if (shot.unified_lights.sampling == kLightsApart)
        return;
    for (const char* key :
         {"lighting.clusters", "fire_lights.sampling", "virtual_lights.resampling_neighbours", "output.layers.bound"})
        if (const std::string why = why_not_unified(shot, key); !why.empty())
            reject(given, given.contains(key) ? key : "unified_lights.sampling",
                   fmt::format("does not go with unified_lights.sampling={}: {}; or unified_lights.sampling={}",
                               shot.unified_lights.sampling, why, kLightsApart));
}

void check_tracing(const Given& given, const Shot& shot) {
    const TracingSettings& t = shot.tracing;
    if (shot.method == RenderMethod::Path && shot.seconds <= 0.0 && t.samples == 0 && t.seconds <= 0.0 &&
        t.error <= 0.0)
        reject(given, "tracing.samples", "is none: the render would never end; give tracing.seconds or tracing.error");
}

void check_scattering(const Given& given, const ScatteringSettings& scattering) {
    if (scattering.solver == ScatteringSolver::Diffusion && scattering.bounces > 2)
        reject(given, "scattering.bounces",
               "scattering.solver=diffusion knows the sum of all bounces only; give all, or at most 2");
}

void check_layers(const Given& given, const Shot& shot) {
    if (const std::string reason = why_no_bound_layers(shot); !reason.empty())
        throw Error(ExitCode::Usage, fmt::format("{}: {}", given.at("output.layers.bound"), reason));
}

void check_lights(const Given& given, const SceneSettings& scene) {
    int environments = 0;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const LightSettings& light = scene.lights[i];
        const auto refuse = [&](const std::string& why) {
            reject(given, "scene.lights", fmt::format("light [{}] {}", i, why));
        };
        if ((light.kind == LightKind::Spot || light.kind == LightKind::Sun) && !(glm::length(light.direction) > 0.0))
            refuse("has a direction of no length");
        if (light.kind == LightKind::Spot && light.inner_degrees > light.outer_degrees)
            refuse("has inner_degrees above outer_degrees");
        if (light.kind == LightKind::Environment && ++environments > 1)
            refuse("is a second environment; there can be only one");
    }
}

void check_time(const Given& given, const TimeSettings& time, const std::string& key) {
    if (!time.curve.empty() && time.speed != 1.0)
        reject(given, key, "gives time.curve and time.speed, which both say how fast time runs; remove one");
}

void check_volumes(const Given& given, const std::vector<FurtherVolume>& volumes) {
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const VolumeSettings& v = volumes[i].volume;
        const auto refuse = [&](const std::string& why) {
            reject(given, "volumes", fmt::format("volume [{}] {}", i, why));
        };
        if (v.box.has_value() == !v.file.empty())
            refuse("needs either a file or a box");
        if (v.box && (volumes[i].time || volumes[i].velocity))
            refuse("is a box, which has no time; remove its time and velocity");
        if (volumes[i].time)
            check_time(given, *volumes[i].time, "volumes");
        if (v.box && !glm::all(glm::lessThan(v.box->low, v.box->high)))
            refuse("is a box whose low is not below its high on every axis");
        if (v.box && volumes[i].changes.model.value_or(FireModel::None) != FireModel::None)
            refuse("is a homogeneous box, which cannot emit; remove its fire_model");
    }
}

}  // namespace

std::string why_no_bound_layers(const Shot& shot) {
    if (!shot.output.bound_layers)
        return {};
    if (!shot.output.cell_layers)
        return "output.layers.bound needs output.layers.cells=true: it divides the layer SS";
    return why_no_bound(shot.virtual_lights, "output.layers.bound", "output.layers.bound=false");
}

void check_shot(const Shot& shot, const Given& given, const std::string& source) {
    if (shot.volume.file.empty() && shot.volumes.empty() && shot.scene.empty())
        throw Error(ExitCode::Usage,
                    fmt::format("{}: volume.file is missing, and so is a scene: which file to render", source));
    check_lights(given, shot.scene);
    check_volumes(given, shot.volumes);
    check_time(given, shot.time, "time.curve");
    if (shot.camera.world_from_camera)
        check_matrix(given, *shot.camera.world_from_camera);
    else
        check_look_at(given, shot.camera);
    check_fire(given, shot.medium.fire);
    check_fire_lights(given, shot);
    check_unified_lights(given, shot);
    check_tracing(given, shot);
    check_scattering(given, shot.scattering);
    check_layers(given, shot);
}

}  // namespace brisance
