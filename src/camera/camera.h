// A pinhole camera: pixels to rays in the medium's local space.
#pragma once

#include <optional>

#include "camera/settings.h"
#include "medium/lattice/voxel_walk.h"
#include "scene/scene.h"

namespace brisance {

class Camera {
public:
    // Throws Error Usage when eye and target coincide, up is parallel to the view, or the matrix is singular.
    Camera(const CameraSettings& settings, const Medium& medium);

    // Through the point (x, y) of the picture in pixels: (0, 0) is the outer corner of the top left pixel.
    Ray ray(double x, double y) const;
    // The point of the picture at which a local position is seen; none where it is not in front of the eye.
    std::optional<glm::dvec2> project(const dvec3& local) const;
    dvec3 eye_local() const { return eye_; }
    dvec3 forward() const { return forward_; }
    dmat4 camera_from_world() const;
    // Width of a pixel per metre of distance along the view axis.
    double pixel_angle() const { return 2.0 * tan_half_ / settings_.height; }
    const CameraSettings& settings() const { return settings_; }

private:
    CameraSettings settings_;
    dmat4 world_from_camera_{1.0};
    dvec3 eye_{0.0};
    dvec3 right_{0.0}, up_{0.0}, forward_{0.0};
    double tan_half_ = 0.0;
};

// A camera that sees all of the medium's emission and smoke from the front, slightly above the middle, z up.
CameraSettings framed_camera(const Medium& medium, const CameraSettings& like);
// The same for all triangles of a scene.
CameraSettings framed_camera(const Scene& scene, const dvec3& up, const CameraSettings& like);

}  // namespace brisance
