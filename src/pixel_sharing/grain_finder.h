// Which samples are grains (divided_grains.h).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "camera_rays/picture.h"
#include "pixel_sharing/divided_grains.h"
#include "pixel_sharing/shared_bounce.h"

namespace brisance {

class GrainFinder {
public:
    // Samples of a pixel from which on one can stand out of the others.
    static constexpr int kFewestSamples = 4;

    // What a sample adds to its pixel.
    struct Shown {
        float luminance = 0.0f;  // [W/(m^2 sr)]
        vec3 normal{0.0f};       // of its surface, unit, the geometric one; 0: not known
    };
    // Keeps references. `samples`: of whole rows, in the order of pixels, as far as which pixels around are looked at;
    // `shown`: of each. `width`: of the picture, in pixels. `shared`: what shares light among pixels; null: nothing
    // does. `grains` gets the surfaces of the rows.
    GrainFinder(std::span<const SurfaceSample> samples, std::vector<Shown> shown, int width, const SharedBounce* shared,
                DividedGrains& grains);

    // A sample of one of the passes over its pixel. `found`: what it sees [W/(m^2 sr)], as often as it `stands_for`
    // others of its pixel. `left`: what it leaves to all pixels; null where it leaves nothing. `times`: how often
    // `shown` holds what the pixel shows of the sample.
    struct Sample {
        std::size_t number;
        const CellSum& found;
        std::array<SharedBounce::Sample*, 2> left;
        float stands_for, times;
    };
    // What of it is a grain goes to `grains`. Returns whether `found` does: the caller leaves it out. Of `left` nothing
    // is left then. Not thread-safe.
    bool take(const Sample& sample);

private:
    struct Pixel {
        float luminance = 0.0f;
        std::size_t begin = 0, end = 0;  // of its samples
    };
    // Luminance of a sample's parts, what it sees first, then what it leaves to all pixels [W/(m^2 sr)].
    using Parts = std::array<float, 3>;
    Parts parts(const Sample& sample) const;
    Parts alone(const Sample& sample, const Parts& parts, float pixels) const;
    DividedGrains::Surface surface(std::size_t sample) const;
    struct Around;
    Around around(std::size_t sample) const;

    std::span<const SurfaceSample> samples_;
    std::vector<Shown> shown_;
    std::size_t width_, origin_ = 0;  // the first pixel of the rows
    const SharedBounce* shared_;
    DividedGrains& grains_;
    std::vector<Pixel> pixels_;  // of the rows that have samples
};

}  // namespace brisance
