// How fast an error changes over a sequence: its power over temporal frequency.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "metrics/comparison.h"

namespace brisance {

// Bands of temporal frequency f in cycles per frame, by period: what never changes (f = 0); drift over more than 8
// frames; 4 to 8 frames; less than 4 frames, down to the alternation of frames (f = 1/2). At 24 frames a second the eye
// sees flicker best at about 8 Hz, in the last one.
enum class TemporalBand { Still, Low, Mid, High };
constexpr int kTemporalBands = 4;
extern const std::array<const char*, kTemporalBands> kTemporalBandNames;
TemporalBand temporal_band(double cycles_per_frame);

// Powers of the error e = I - R of each pixel by the orthonormal cosine transform (DCT-II) over frames, summed over
// pixels and channels, over the sum of R^2 in all frames. They add up to the squared rRMSE of the sequence. The cosine
// transform continues a sequence as its mirror image, so that an error that drifts has no step at the ends whose power
// would be everywhere. Noise that is new in every frame has the same power at all frequencies.
struct TemporalSpectrum {
    std::vector<double> cycles_per_frame;  // k / 2N, for k = 0 .. N - 1
    std::vector<double> power;
    std::vector<double> noise_free_power;  // with two halves: by the product of both errors; may be below 0 by chance
    std::size_t pixels = 0;                // that it is made of
    std::size_t not_finite = 0;            // of these, left out: not finite in some frame

    // Root of a band's power, without the noise of the reference where that is known; a negative power counts as 0.
    std::array<double, kTemporalBands> bands() const;
};

// Takes frames one by one and keeps the errors of at most kSpectrumPixels pixels, on a regular lattice in the picture.
constexpr std::size_t kSpectrumPixels = 32768;

class ErrorOverTime {
public:
    // All frames of one size, with as many halves. Throws Error BadData when they are not.
    void add(const FrameAndReference& frame);
    std::size_t frames() const { return frames_; }
    TemporalSpectrum spectrum() const;

private:
    void begin(const FrameAndReference& frame);
    std::vector<float> errors(const Picture& image, const Picture& reference);

    int width_ = 0, height_ = 0;
    bool halves_ = false;
    std::size_t frames_ = 0;
    std::vector<std::size_t> pixels_;
    std::vector<bool> usable_;                // of pixels_
    std::vector<std::vector<float>> a_, b_;   // by frame: three channels of each of pixels_
    std::vector<std::vector<float>> square_;  // by frame: of the reference, or the product of its halves, by pixel
    std::vector<std::vector<float>> cross_;
};

}  // namespace brisance
