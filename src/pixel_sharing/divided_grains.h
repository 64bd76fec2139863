// Grains ("fireflies"): samples that alone make much of what their pixel shows, and stand out of the pixels around.
//
// Light that is rare and bright leaves such noise whatever the number of samples, since every further one may be the
// next. The energy of a grain is right; its place in the picture is chance. So it is divided evenly among the pixels
// around that show the same surface, its own included: the picture's mean stays what it is (H. Rushmeier, G. Ward,
// Energy Preserving Non-Linear Filters, SIGGRAPH 1994). What several samples of a pixel find is no grain, however
// bright it is: highlights and lamps keep their place.
//
// SharedBounce divides the samples of surfaces that many pixels show, and leaves grains on what only a few do: rails,
// frames, far edges. There a grain falls to other sides of the same thing, and last to whatever is around.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "camera_rays/picture.h"
#include "pixel_sharing/shared_bounce.h"

namespace brisance {

class DividedGrains {
public:
    // What a sample adds to its pixel.
    struct Shown {
        float luminance = 0.0f;  // [W/(m^2 sr)]
        vec3 normal{0.0f};       // of its surface, unit; 0: not known
    };
    // Keeps a reference to the samples, which are in the order of pixels. `shown`: of each. `width`: of the picture, in
    // pixels. `shared`: what shares light among pixels; null: nothing does.
    DividedGrains(std::span<const SurfaceSample> samples, std::vector<Shown> shown, int width,
                  const SharedBounce* shared);

    // Whether a sample is a grain. Then its light is added to that of samples around, which `light` holds of each
    // [W/(m^2 sr)], and the caller leaves `found` out. `found`: what it sees [W/(m^2 sr)], as often as it `stands_for`
    // others of its pixel; `left`: what it leaves to all pixels, null where it leaves nothing, of which a grain keeps
    // none.
    bool divide(std::size_t sample, float stands_for, const CellSum& found, std::span<SharedBounce::Sample* const> left,
                std::vector<CellSum>& light) const;

private:
    struct Pixel {
        float luminance = 0.0f;
        std::size_t begin = 0, end = 0;  // of its samples
    };
    // One sample of each pixel around one, by what they have in common with it.
    struct Around {
        std::vector<std::size_t> surface, mesh, others;
    };
    Around around(std::size_t sample) const;
    bool on_one_surface(std::size_t sample, std::size_t other) const;
    const Pixel& pixel_of(std::size_t sample) const { return pixels_[samples_[sample].pixel - origin_]; }
    template <class Noise>
    std::vector<std::size_t> receivers(std::size_t sample, const Noise& noise) const;

    std::span<const SurfaceSample> samples_;
    std::vector<Shown> shown_;
    std::size_t width_, origin_ = 0;  // the first pixel of the rows
    const SharedBounce* shared_;
    std::vector<Pixel> pixels_;  // of the rows that have samples
};

}  // namespace brisance
