// Which samples of a call are shaded, in two rounds.
//
// Rays find the edges of surfaces and cost little; what they see there is most of the work. Where all rays of a pixel
// meet surfaces, only a quarter of them is shaded at first, spread evenly over the pixel. The others follow in a second
// round where the first tells that they are needed: where the standard error of the mean of its samples is above what
// is tolerated, relative to the luminance of the pixel and those beside. That error is estimated from the few samples
// themselves. One pixel's are too few to tell grains from their absence, so that its variance is at least the mean of
// those beside.
//
// Light of fire and smoke on bases, and what is sampled at each (reflections, emitters, light between surfaces), have
// rounds of their own: a penumbra says nothing of reflections. Where the second round of one leaves a pixel noisy, the
// other need not know its light any better.
#pragma once

#include <span>
#include <vector>

#include "camera_rays/picture.h"

namespace brisance {

class SurfaceRounds {
public:
    // Keeps a reference. `width`: of the picture, in pixels. `rays`: of a pixel. `tolerance`: standard error of a
    // pixel over its luminance; 0: all samples are shaded in the first round.
    SurfaceRounds(std::span<const SurfaceSample> samples, int width, std::size_t rays, float tolerance);

    const std::vector<std::size_t>& first() const { return first_; }
    // What shading found at samples of the first round, as luminance [W/(m^2 sr)].
    struct Found {
        std::vector<float> noisy;   // with the noise that it has in the pixel
        std::vector<float> shared;  // among pixels: it counts for what the pixel shows
    };
    // The second round. `even`: luminance of each sample that is known of all [W/(m^2 sr)]. `other`: the rounds of
    // other light of the same samples, after its second one; null: there is none.
    std::vector<std::size_t> second(std::span<const float> even, const Found& found,
                                    const SurfaceRounds* other = nullptr);
    // For how many samples, by their shares, one stands, after the rounds that were asked for; 0: it was not shaded.
    float stands_for(std::size_t sample) const;

private:
    struct Pixel {
        std::size_t begin, end;  // of its samples
        bool few = false;        // are shaded first, ...
        bool refined = false;    // ... and the others then
        float scale = 1.0f;      // of those few
        float shown = 0.0f;      // luminance [W/(m^2 sr)]
        float variance = 0.0f;   // of that for want of samples
        float left = 0.0f;       // of the variance, after the second round
    };
    bool among_few(std::size_t sample) const;
    void measure(Pixel& pixel, std::span<const float> even, const Found& found) const;
    // `beside`: variance that is tolerated beside other light.
    void decide(std::size_t at, float beside);

    std::span<const SurfaceSample> samples_;
    std::size_t width_, per_axis_;
    float tolerance_;
    std::size_t origin_ = 0;               // the first pixel of the rows
    std::vector<Pixel> pixels_;            // of those with samples
    std::vector<std::uint32_t> number_;    // in pixels_, of every pixel of the rows; kNone
    std::vector<std::uint32_t> pixel_of_;  // of each sample
    std::vector<std::size_t> first_;
};

}  // namespace brisance
