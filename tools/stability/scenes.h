// Scenes that several families use.
#pragma once

#include "stability/case.h"

namespace brisance::stability {

// A square picture of `pixels`^2 that is `width` metres wide at `target`. `up` is any direction across the view.
CameraSettings camera_at(const dvec3& eye, const dvec3& target, double width, int pixels);

// `paths`: per pixel, where the path tracer renders.
Scene scene_of(const media::Recipe& recipe, const CameraSettings& camera, int paths);

// The same scene among these surfaces and lights.
Scene with_set(Scene scene, const SceneSettings& set);

// Smoke that emits as it absorbs, source function 1 before the albedo is taken off, in a ball of 1 m radius.
media::Recipe isothermal_ball(int nodes, double optical_radius, double albedo);

// The same ball with emission of 1 W/(m^3 sr) whatever it absorbs.
media::Recipe burning_ball(int nodes, double optical_radius, double albedo);

// From 1000 m, the whole ball of 1 m and a little more.
CameraSettings camera_on_ball(int pixels);

// From 1000 m, the middle tenth of the ball: all pixels look through the centre but for 0.3 % of the chord.
CameraSettings camera_on_centre(int pixels);

// `nodes` voxels of `edge` metres along z between z = 0 and its far end, wide enough to fill a camera on the axis:
// emission-absorption slabs. Optical depth nodes * voxel_depth; source function 1.
media::Recipe absorbing_slab(int nodes, double edge, double voxel_depth);

// Looks along the slab's axis from below; off the lattice's symmetry planes.
CameraSettings camera_on_slab(int nodes, double edge);

}  // namespace brisance::stability
