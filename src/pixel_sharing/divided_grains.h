// Grains ("fireflies"): samples that alone make most of what their pixel shows, and stand out of the pixels around.
//
// Light that is rare and bright leaves such noise whatever the number of samples, since every further one may be the
// next. The energy of a grain is right; its place in the picture is chance. So it is divided among the pixels around
// that show the same surface: the picture's mean stays what it is (H. Rushmeier, G. Ward, Energy Preserving Non-Linear
// Filters, SIGGRAPH 1994). The brighter a grain is, the more pixels share it. What two samples of a pixel find alike is
// no grain, however bright it is, nor what several pixels around show: highlights, lamps and thin lit lines keep their
// place.
//
// SharedBounce divides the samples of surfaces that many pixels show, and leaves grains on what only a few do: rails,
// frames, far edges. There a grain falls to other sides of the same thing, and last to whatever is around. Its colour
// goes with it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cell.h"

namespace brisance {

class DividedGrains {
public:
    // The largest of those that a pixel shows.
    struct Surface {
        vec3 position{0.0f};     // local [m]
        vec3 normal{0.0f};       // unit, the geometric one; 0: not known
        std::uint32_t mesh = 0;  // of the scene
        float share = 0.0f;      // of the light of all its surfaces, what the pixel shows; 0: it shows none
    };
    static bool on_one_surface(const Surface& a, const Surface& b);

    static constexpr std::array<Cell, 4> kOfSurfaces = {Cell::SV, Cell::SM, Cell::SS, Cell::SA};
    struct Grain {
        std::uint32_t pixel = 0;
        Surface surface;
        float excess = 0.0f;                        // its luminance over that of the pixels around
        std::array<Rgb, kOfSurfaces.size()> light;  // what its pixel would show of it, of these cells [W/(m^2 sr)]
    };

    DividedGrains(int width, int height);
    static std::uint64_t bytes_of(int width, int height);  // without grains, which are few

    void show(std::uint32_t pixel, const Surface& surface) { surfaces_[pixel] = surface; }
    // In any order that does not depend on threads. Not thread-safe.
    void add(const Grain& grain) { grains_.push_back(grain); }
    bool empty() const { return grains_.empty(); }

    // When all are there. After that, of a cell of surfaces: what pixels show of all grains, and of all pixels and
    // channels the expected sum of squares of the noise that this is, taken that grains are rare.
    void divide();
    std::vector<Rgb> pixels(Cell cell) const;
    double square_error(Cell cell) const;

private:
    enum class TakesPart : std::uint8_t { Surface, Mesh, All };
    struct Spread {
        TakesPart who = TakesPart::Surface;
        float radius = 0.0f;                           // [pixels]
        float weights = 0.0f, squares = 0.0f;          // sums
        int left = 0, right = 0, top = 0, bottom = 0;  // pixels, inclusive
    };
    Spread spread(const Grain& grain) const;
    float weight(const Grain& grain, const Spread& spread, int x, int y) const;

    int width_, height_;
    std::vector<Surface> surfaces_;  // of each pixel
    std::vector<Grain> grains_;
    std::vector<Spread> spreads_;  // of each grain
};

}  // namespace brisance
