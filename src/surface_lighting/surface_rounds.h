// How many samples of a pixel are shaded, in rounds.
//
// Rays find the edges of surfaces and cost little; what they see there is most of the work. Where all rays of a pixel
// meet surfaces, only a quarter of them is shaded at first, spread evenly over the pixel. A second round shades another
// quarter or all, and further passes shade all of them again with other random numbers, where the rounds before tell
// that it is needed.
//
// A pixel's standard error may be a part of the geometric mean of its luminance and a typical one, which is that of the
// picture weighted by itself, <L^2> / <L>. So the errors of all pixels together are that part of the picture's root
// mean square, and the samples for it are few: they go where they take away most, as those in proportion to a pixel's
// standard error do, but dark pixels count for more than their error is in the picture.
//
// The error is estimated from samples: those of the pixels around, not its own. A pixel that got more samples where its
// own differ would keep its light where they miss a bright spot, and divide that by more where they do not: light of
// rare bright samples would be lost (4 % of the light between surfaces in a street). Light of the grids on bases has
// none, and edges of shadows that only its own samples know.
//
// Light of fire and smoke on bases, and what is sampled at each (reflections, emitters, light between surfaces), have
// rounds of their own: a penumbra says nothing of reflections. Where the rounds of one leave a pixel noisy, the other
// need not know its light any better.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "camera_rays/picture.h"

namespace brisance {

class SurfaceRounds {
public:
    // Whose samples tell the error of a pixel.
    enum class ToldBy : std::uint8_t {
        Others,  // pixels around it
        OwnToo,  // or its own, which tell more: for light without rare bright samples, that has edges as narrow as
                 // pixels
    };
    struct Tolerance {
        float part = 0.0f;     // of the geometric mean; 0: all samples are shaded, in the first round
        float typical = 0.0f;  // luminance [W/(m^2 sr)]; 0: it is not known, and the part is of the pixel alone
    };
    // Keeps a reference. `width`: of the picture, in pixels. `rays`: of a pixel.
    SurfaceRounds(std::span<const SurfaceSample> samples, int width, std::size_t rays, const Tolerance& tolerance,
                  ToldBy told_by);

    // Whether pixels of that many rays are shaded in rounds.
    static bool split(std::size_t rays);

    const std::vector<std::size_t>& first() const { return first_; }
    // What shading found at samples, as luminance [W/(m^2 sr)].
    struct Found {
        std::vector<float> noisy;   // with the noise that it has in the pixel
        std::vector<float> shared;  // among pixels: it counts for what the pixel shows
    };
    // The second round. `even`: luminance of each sample that is known of all [W/(m^2 sr)]. `other`: the rounds of
    // other light of the same samples, after its last one; null: there is none.
    std::vector<std::size_t> second(std::span<const float> even, const Found& found,
                                    const SurfaceRounds* other = nullptr);
    // A sample to shade once more, with the random numbers of that pass; the first one, of the rounds above, is 0.
    struct Again {
        std::size_t sample;
        std::uint32_t pass;
    };
    // After that, in the order of samples and passes. All passes of a sample stand for as much.
    std::vector<Again> further(std::span<const float> even, const Found& found);
    // For how many samples, by their shares, each pass of one stands, after the rounds that were asked for; 0: it was
    // not shaded.
    float stands_for(std::size_t sample) const;
    // In how many passes its pixel is shaded.
    float passes(std::size_t sample) const { return float(pixels_[pixel_of_[sample]].passes); }
    // The variance of luminance that the rounds leave, summed over all pixels; 0 where none asked for samples.
    double variance_left() const;

private:
    struct Pixel {
        std::size_t begin, end;      // of its samples
        std::uint32_t quarters = 4;  // of those that are shaded
        std::uint32_t passes = 1;
        float scale = 1.0f;     // of those shaded
        float shown = 0.0f;     // luminance [W/(m^2 sr)]
        float variance = 0.0f;  // of that for want of samples, were a quarter of them shaded
        float left = 0.0f;      // of the variance, after the last round
    };
    std::uint32_t quarter_of(std::size_t sample) const;
    void shade(Pixel& pixel, std::uint32_t quarters) const;
    void measure(Pixel& pixel, std::span<const float> even, const Found& found) const;
    // How many times as many samples the pixel wants; and the variance that those which it has leave.
    struct Wanted {
        float times, left;
    };
    // `beside`: variance that is tolerated beside other light.
    Wanted wanted(const Pixel& pixel, float beside) const;

    std::span<const SurfaceSample> samples_;
    std::size_t width_, per_axis_;
    Tolerance tolerance_;
    ToldBy told_by_;
    bool splits_;
    std::size_t origin_ = 0;               // the first pixel of the rows
    std::vector<Pixel> pixels_;            // of those with samples
    std::vector<std::uint32_t> number_;    // in pixels_, of every pixel of the rows; kNone
    std::vector<std::uint32_t> pixel_of_;  // of each sample
    std::vector<std::size_t> first_;
};

}  // namespace brisance
