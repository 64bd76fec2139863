// Camera rays to pixels.
#pragma once

#include <functional>
#include <vector>

#include "camera/camera.h"
#include "camera_rays/ray_sum.h"
#include "camera_rays/source_field.h"
#include "core/progress.h"
#include "emitters/surroundings.h"
#include "film/image.h"

namespace brisance {

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
    int samples_per_axis = 1;                    // anti-aliasing, along a pixel's side
    int edge_refinement = 1;                     // as many times more where light has edges (refine_edges.h)
    int parts = 2;                               // of a voxel's segment
    bool cells = true;                           // layers per ledger cell, ...
    CellSet layers = {Cell::V};                  // ... of these cells
    const Surroundings* surroundings = nullptr;  // rays end at its surfaces
    LightRays light_rays = {};                   // empty: the field holds MM and MA
    // Where forward peaks count as no scattering (medium/similar_medium.h) MV and MA of the field hold light that
    // scattered more than once. This field holds what scattered once; the rest is then filed as MM. Null: not so.
    const SourceField* once = nullptr;
    int pass = 0;  // of several pictures that are averaged: each with random numbers of its own
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
// albedo (premultiplied by alpha). `light_surfaces` empty: surfaces are black, but for what they emit.
Image render_picture(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                     Progress& progress, const LightSurfaces& light_surfaces = {});

}  // namespace brisance
