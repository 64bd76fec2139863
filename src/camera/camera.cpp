#include "camera/camera.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace brisance {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

dmat4 look_at(const CameraSettings& s) {
    const dvec3 view = s.target - s.eye;
    const dvec3 side = glm::cross(view, s.up);
    if (!(glm::length(view) > 0.0))
        throw Error(ExitCode::Usage, "camera: eye and target coincide; move one of them");
    if (!(glm::length(side) > 1e-9 * glm::length(view) * glm::length(s.up)))
        throw Error(ExitCode::Usage, "camera: up is parallel to the view or zero; choose another up");
    const dvec3 right = glm::normalize(side);
    const dvec3 back = -glm::normalize(view);
    dmat4 m(1.0);
    m[0] = glm::dvec4(right, 0.0);
    m[1] = glm::dvec4(glm::cross(back, right), 0.0);
    m[2] = glm::dvec4(back, 0.0);
    m[3] = glm::dvec4(s.eye, 1.0);
    return m;
}

// The distance from a box's middle at which all its corners fill nine tenths of the picture at most.
double fitting_distance(const dvec3& half_size, const dvec3& back, const CameraSettings& s) {
    constexpr double fill = 0.9;
    const dvec3 right = glm::normalize(glm::cross(-back, s.up));
    const dvec3 up = glm::cross(back, right);
    const double vertical = fill * std::tan(0.5 * s.vertical_fov_degrees * kDegree);
    const double horizontal = vertical * s.width / s.height;
    double distance = 1e-9;
    for (int k = 0; k < 8; ++k) {
        const dvec3 corner = half_size * dvec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
        const double nearer = glm::dot(corner, back);
        distance = std::max({distance, nearer + std::abs(glm::dot(corner, right)) / horizontal,
                             nearer + std::abs(glm::dot(corner, up)) / vertical});
    }
    return distance;
}

// Looking at a box from the front, slightly above and from the right.
CameraSettings framed_on(dvec3 low, dvec3 high, const dvec3& up, const CameraSettings& like) {
    if (!(low.x <= high.x))
        low = dvec3(-1.0), high = dvec3(1.0);
    CameraSettings s = like;
    s.world_from_camera.reset();
    s.target = 0.5 * (low + high);
    s.up = up;
    const dvec3 right(1.0, 0.0, 0.0);
    const dvec3 back = glm::normalize(0.25 * right + glm::cross(right, up) + 0.22 * up);
    s.eye = s.target + back * fitting_distance(0.5 * (high - low), back, s);
    return s;
}

}  // namespace

Camera::Camera(const CameraSettings& settings, const Medium& medium) : settings_(settings) {
    world_from_camera_ = settings.world_from_camera ? *settings.world_from_camera : look_at(settings);
    if (!(std::abs(glm::determinant(dmat3(world_from_camera_))) > 1e-12))
        throw Error(ExitCode::Usage, "camera: world_from_camera is singular");
    right_ = glm::normalize(dvec3(world_from_camera_[0]));
    up_ = glm::normalize(dvec3(world_from_camera_[1]));
    forward_ = -glm::normalize(dvec3(world_from_camera_[2]));
    const dvec3 reference(medium.world_from_index * glm::dvec4(dvec3(medium.reference_node), 1.0));
    eye_ = dvec3(world_from_camera_[3]) - reference;
    tan_half_ = std::tan(0.5 * settings.vertical_fov_degrees * kDegree);
}

Ray Camera::ray(double x, double y) const {
    const double u = (2.0 * x - settings_.width) / settings_.height * tan_half_;
    const double v = (settings_.height - 2.0 * y) / settings_.height * tan_half_;
    return {eye_, glm::normalize(forward_ + u * right_ + v * up_)};
}

std::optional<glm::dvec2> Camera::project(const dvec3& local) const {
    const dvec3 away = local - eye_;
    const double depth = glm::dot(away, forward_);
    if (!(depth > 0.0))
        return std::nullopt;
    const double pixels = 0.5 * settings_.height / (tan_half_ * depth);  // per metre at that depth
    return glm::dvec2(0.5 * settings_.width + pixels * glm::dot(away, right_),
                      0.5 * settings_.height - pixels * glm::dot(away, up_));
}

dmat4 Camera::camera_from_world() const {
    return glm::inverse(world_from_camera_);
}

CameraSettings framed_camera(const Medium& medium, const CameraSettings& like) {
    dvec3 low(1e300), high(-1e300);
    for (std::size_t b = 0; b < medium.lattice.brick_count(); ++b) {
        const std::size_t base = b * BrickLattice::kNodes;
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            if (medium.extinction[base + n] <= 0.0f &&
                (medium.emission.empty() || medium.emission[base + n] == Rgb(0.0f)))
                continue;
            const dvec3 p = medium.world_of_local(
                medium.local_of_node(medium.lattice.first_node(b) + BrickLattice::node_in_brick(n)));
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    return framed_on(low, high, dvec3(0.0, 0.0, 1.0), like);
}

CameraSettings framed_camera(const Scene& scene, const dvec3& up, const CameraSettings& like) {
    dvec3 low(1e300), high(-1e300);
    for (const SceneMesh& mesh : scene.meshes)
        for (const vec3& p : mesh.positions) {
            low = glm::min(low, dvec3(p));
            high = glm::max(high, dvec3(p));
        }
    return framed_on(low + scene.origin, high + scene.origin, up, like);
}

}  // namespace brisance
