// Camera rays to pixels.
#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <limits>
#include <vector>

#include "camera/camera.h"
#include "camera_rays/ray_sum.h"
#include "camera_rays/source_field.h"
#include "core/progress.h"
#include "emitters/surroundings.h"
#include "film/image.h"

namespace brisance {

// Integrates one ray against the fields' own interpolation. Each cell's segment is halved `halvings` + 1 ways; on every
// part extinction and source are constant (their values at Gauss points, so that the cell's optical depth is exact for
// two parts) and the part is integrated in closed form with phi1. `end`: where a surface ends the ray [m].
RaySum integrate(const SourceField& field, const Ray& ray, int parts,
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

// A camera ray of a pixel.
struct PixelRay {
    std::uint32_t pixel;
    std::uint64_t number;  // of the ray in its pixel, and of the pass (PictureSettings)
    Ray ray;
};

// Along a ray up to `end` [m]: MM, and MA where the field holds none.
struct LightOnRay {
    Rgb scattered{0.0f}, emitters{0.0f};
};
using LightRays = std::function<LightOnRay(const PixelRay& ray, double end)>;

struct PictureSettings {
    int samples_per_axis = 1;  // anti-aliasing, along a pixel's side
    int edge_refinement = 1;   // as many times more where light has edges (refine_edges.h)
    int parts = 2;             // of a cell's segment
    bool cells = true;         // layers per ledger cell, ...
    std::array<bool, kCells> layers = layers_of({Cell::V});  // ... of these cells
    const Surroundings* surroundings = nullptr;              // rays end at its surfaces
    LightRays light_rays = {};                               // empty: the field holds MM and MA
    int pass = 0;  // of several pictures that are averaged: each with random numbers of its own

    static constexpr std::array<bool, kCells> layers_of(std::initializer_list<Cell> cells) {
        std::array<bool, kCells> layers{};
        for (const Cell cell : cells)
            layers[static_cast<int>(cell)] = true;
        return layers;
    }
};

// A surface that the camera sees, on one of a pixel's rays.
struct SurfaceSample {
    std::uint32_t pixel;
    std::uint64_t number;  // of the ray in its pixel, and of the pass (PictureSettings)
    Ray ray;
    SurfaceHit hit;
};

// Light that surfaces scatter toward the camera: fills the row S of `light`, one entry per sample. The same for any
// split of a picture's samples into calls.
using LightSurfaces = std::function<void(const std::vector<SurfaceSample>& samples, std::vector<CellSum>& light)>;

// The samples along a pixel's side that keep neighbouring rays within a fifth of a voxel where the medium is nearest.
int automatic_samples(const Camera& camera, const SourceField& field);

// Beauty (R, G, B, A), cell layers, Z (opacity-weighted mean distance along the view axis, 1e10 where nothing is) and
// albedo (premultiplied by alpha). `light_points` empty: the field holds the lighting.
// `light_surfaces` empty: surfaces are black, but for what they emit.
Image render_picture(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                     const LightPoints& light_points, Progress& progress, const LightSurfaces& light_surfaces = {});

}  // namespace brisance
