#include "render/shutter/animation.h"

#include <algorithm>

namespace brisance {

namespace {

bool same_light(const LightSettings& a, const LightSettings& b) {
    return a.position == b.position && a.direction == b.direction;
}

bool same_mesh(const SceneMesh& a, const SceneMesh& b) {
    return a.positions == b.positions;
}

}  // namespace

bool stand_still(const Surroundings& a, const Surroundings& b) {
    const std::vector<LightSettings>&la = a.scene().lights, &lb = b.scene().lights;
    const std::vector<SceneMesh>&ma = a.scene().meshes, &mb = b.scene().meshes;
    return std::equal(la.begin(), la.end(), lb.begin(), lb.end(), same_light) &&
           std::equal(ma.begin(), ma.end(), mb.begin(), mb.end(), same_mesh);
}

bool stand_still(const CameraSettings& a, const CameraSettings& b) {
    return a.eye == b.eye && a.target == b.target && a.up == b.up && a.world_from_camera == b.world_from_camera &&
           a.vertical_fov_degrees == b.vertical_fov_degrees;
}

}  // namespace brisance
