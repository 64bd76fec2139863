// Camera rays to pixels.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "core/progress.h"
#include "emitters/surroundings.h"
#include "film/image.h"
#include "render/camera.h"
#include "render/cell_field.h"
#include "render/march.h"

namespace brisance {

// Integrates one ray against the fields' own interpolation. Each cell's segment is halved `halvings` + 1 ways; on every
// part extinction and source are constant (their values at Gauss points, so that the cell's optical depth is exact for
// two parts) and the part is integrated in closed form with phi1. `end`: where a surface ends the ray [m].
RaySum integrate(const CellField& field, const Ray& ray, int parts,
                 double end = std::numeric_limits<double>::infinity());

// Lighting asked for sample by sample instead of from a field (GatherMethod::RayMarch): fills `lighting` with the
// source function (albedo times in-scattered radiance) at each point, per scattering cell.
struct MarchPoint {
    vec3 local;
    vec3 toward_camera;
};
struct PointLighting {
    Rgb single{0.0f}, multiple{0.0f};
};
using LightPoints = std::function<void(const std::vector<MarchPoint>& points, std::vector<PointLighting>& lighting)>;

struct PictureSettings {
    int samples_per_axis = 1;  // anti-aliasing, along a pixel's side
    int parts = 2;             // of a cell's segment
    bool cells = true;         // layers per ledger cell
    bool has_single = false;
    bool has_multiple = false;
    const Surroundings* surroundings = nullptr;  // rays end at its surfaces
};

// The samples along a pixel's side that keep neighbouring rays within a fifth of a voxel where the medium is nearest.
int automatic_samples(const Camera& camera, const CellField& field);

// Beauty (R, G, B, A), cell layers, Z (opacity-weighted mean distance along the view axis, 1e10 where nothing is) and
// albedo (premultiplied by alpha). `light_points` empty: the field holds the lighting.
Image render_picture(const CellField& field, const Camera& camera, const PictureSettings& settings,
                     const LightPoints& light_points, Progress& progress);

}  // namespace brisance
