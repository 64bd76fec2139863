// The primary rays of a pixel.
//
// Surfaces have edges finer than a pixel and want many rays. The medium does not: rays a part of a voxel apart know it
// (automatic_samples()). Where all of a pixel's rays end at about the same depth, the medium is therefore integrated
// along fewer rays, those of a picture without surfaces, and their mean transmittance dims what lies behind.
#pragma once

#include <span>
#include <vector>

#include "camera/pixel_samples.h"
#include "camera_rays/picture.h"
#include "medium/lattice/local_bounds.h"

namespace brisance {

// Pixels along the side of a tile. Rays of a tile follow each other, so that those that one brick of the medium meets
// find it in the caches.
inline constexpr int kSideOfTile = 16;

// A surface that one of a pixel's rays found, with how much of its light arrives.
struct FoundSurface {
    SurfaceSample sample;
    float weight;
};

// Luminance of directly visible emission (cells V and A) over the rays of a pixel [W/(m^2 sr)].
struct Glare {
    float least = 0.0f, most = 0.0f;  // of A alone, if pixels share rays through the medium
    float step = 0.0f;                // largest difference between neighbouring rays that see both
};

class PixelRays {
public:
    // Keeps references.
    PixelRays(const SourceField& field, const Camera& camera, const PictureSettings& settings);

    std::size_t count() const { return samples_.size(); }  // in a pixel
    // Light up to the first surfaces. Appends those to `found`, unless it is null.
    RaySum trace(int x, int y, std::vector<FoundSurface>* found, Glare* glare) const;

private:
    struct Rays {
        std::vector<PixelRay> rays;
        std::vector<std::optional<SurfaceHit>> hits;
        std::vector<float> direct, ends;  // luminance of V and A along each, and of A
    };
    PixelRay ray(int x, int y, const PixelSample& sample, std::uint32_t number) const;
    std::optional<SurfaceHit> hit(const Ray& ray) const;
    bool end_together(const Rays& of) const;
    RaySum trace_each(Rays& of, std::vector<FoundSurface>* found) const;
    RaySum trace_shared(int x, int y, Rays& of, std::vector<FoundSurface>* found) const;

    const SourceField& field_;
    const Camera& camera_;
    const PictureSettings& settings_;
    std::vector<PixelSample> samples_;
    std::vector<PixelSample> medium_samples_;  // empty: each ray integrates the medium
    double beyond_;                            // distance from the eye behind which there is no medium [m]
};

}  // namespace brisance
