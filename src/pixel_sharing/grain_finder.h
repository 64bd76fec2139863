// Which samples are grains (divided_grains.h), and what they show.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "camera_rays/picture.h"
#include "pixel_sharing/divided_grains.h"
#include "pixel_sharing/shared_bounce.h"

namespace brisance {

class GrainFinder {
public:
    // What a sample adds to its pixel.
    struct Shown {
        float luminance = 0.0f;  // [W/(m^2 sr)]
        vec3 normal{0.0f};       // of its surface, unit; 0: not known
    };
    // Keeps references. `samples`: of whole rows, in the order of pixels; `shown`: of each. `width`: of the picture, in
    // pixels. `shared`: what shares light among pixels; null: nothing does. `grains` gets the surfaces of the rows.
    GrainFinder(std::span<const SurfaceSample> samples, std::vector<Shown> shown, int width, const SharedBounce* shared,
                DividedGrains& grains);

    // Whether a sample is a grain. Then `grains` has it, and the caller leaves `found` out. `found`: what it sees
    // [W/(m^2 sr)], as often as it `stands_for` others of its pixel; `left`: what it leaves to all pixels, null where
    // it leaves nothing, of which a grain keeps none. Not thread-safe.
    bool take(std::size_t sample, float stands_for, const CellSum& found, std::span<SharedBounce::Sample* const> left);

private:
    struct Pixel {
        float luminance = 0.0f;
        std::size_t begin = 0, end = 0;  // of its samples
    };
    DividedGrains::Surface surface(std::size_t sample) const;
    struct Around;
    Around around(std::size_t sample) const;
    template <class Noise>
    float excess(std::size_t sample, const Noise& noise) const;

    std::span<const SurfaceSample> samples_;
    std::vector<Shown> shown_;
    std::size_t width_, origin_ = 0;  // the first pixel of the rows
    const SharedBounce* shared_;
    DividedGrains& grains_;
    std::vector<Pixel> pixels_;  // of the rows that have samples
};

}  // namespace brisance
