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

// Light along a ray up to `end` [m]: MM, MA where the field does not hold it, and MV and MS where they are not the
// field's.
struct LightOnRay {
    Rgb scattered{0.0f}, emitters{0.0f}, fire{0.0f}, surfaces{0.0f};
};
using LightRays = std::function<LightOnRay(const PixelRay& ray, double end)>;

struct PictureSettings {
    int samples_per_axis = 1;                    // anti-aliasing, along a pixel's side
    int medium_samples_per_axis = 0;             // fewer, where they are enough for the medium (pixel_rays.h); 0: all
    int finest_medium_samples_per_axis = 0;      // where light bends (look_again.h); 0: nowhere more
    float tolerance = 0.0f;                      // of a pixel by want of rays through the medium, over its luminance
    int edge_refinement = 1;                     // factor where light has edges (look_again.h)
    int parts = 2;                               // of a voxel's segment
    bool cells = true;                           // layers per ledger cell, ...
    CellSet layers = {Cell::V};                  // ... of these cells
    const Surroundings* surroundings = nullptr;  // rays end at its surfaces
    LightRays light_rays = {};                   // empty: the field holds MM and MA
    CellSet by_rays =
        {};  // those of MV, MS and MA that light_rays own: the field's, of which MM may be made, is hidden
    // A field of single scattering, or null. Where forward peaks count as no scattering (medium/similar_medium.h), MV,
    // MS and MA of the main field hold light that scattered more than once. This field then holds the light that
    // scattered once, and the rest counts as MM; of MS where rays own that, which it then has to hold.
    const SourceField* once = nullptr;
    float once_by_rays = 0.0f;     // the share of its MA in whose place light_rays come
    int pass = 0;                  // index among averaged pictures, each with its own random numbers
    glm::dvec2 sample_shift{0.0};  // of the rays of all pixels, in parts of their spacing (pixel_samples.h)
};

// A visible surface on one of a pixel's rays.
struct SurfaceSample {
    std::uint32_t pixel;
    std::uint64_t number;  // of the ray in its pixel, and of the pass (PictureSettings)
    Ray ray;
    SurfaceHit hit;
    float share = 1.0f;   // of the light along the ray, what the pixel shows
    float beside = 0.0f;  // luminance that the pixel shows beside its surfaces' light [W/(m^2 sr)]
};

// Light that surfaces scatter toward the camera: fills the row S of `light`, one entry per sample. A call has whole
// rows of a picture; which of them go together changes the result by no more than what interpolation on planes may.
using LightSurfaces = std::function<void(const std::vector<SurfaceSample>& samples, std::vector<CellSum>& light)>;

// Anti-aliasing samples along a pixel's side where there are surfaces, unless the shot says: their edges are sharp.
inline constexpr int kSurfaceSamples = 4;

// Rows of a picture that are drawn, and their surfaces lit, in one go. `rays`: of a pixel.
int rows_at_once(int width, int height, std::size_t rays);

// Beauty (R, G, B, A), cell layers, Z (opacity-weighted mean distance along the view axis, 1e10 where nothing is
// visible) and albedo (premultiplied by alpha). If `light_surfaces` is empty, surfaces are black except for their
// emission.
Image render_picture(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                     Progress& progress, const LightSurfaces& light_surfaces = {});

}  // namespace brisance
