// A noisy residual of a picture, blurred as much as its noise demands.
//
// The residual is known twice, with independent noise. A pyramid of blurred and halved pictures divides it into bands,
// from single pixels to the whole (P. Burt, E. Adelson, The Laplacian Pyramid as a Compact Image Code, 1983). In each
// band the product of both estimates has the mean of the residual's own square, since independent noise cancels, and
// the square of their mean has that of residual and noise together. Their quotient is the gain that leaves the least
// square error, Wiener's: bands that are noise vanish, and bands that are known stay. Gains are learned apart for each
// octave of the weight, which follows the light: what samples tell of a bright fire says nothing of a dim floor beside
// it, where they are rare and each is many times as bright as the light. There is no other difference between pixels,
// so that few numbers are learned from many of them, and gains change continuously with the samples.
//
// By chance the residual of pure noise seems to be more than nothing half of the time, and where noise is many times
// the light, even a small gain shows as blotches. What lies below two standard deviations therefore counts as noise,
// and what lies above counts less (as W. James and C. Stein shrink means, 1961). Samples of paths have heavy tails
// besides, and there are many bands and octaves, some of which always seem to be known: together they are not taken for
// more than can be believed of the residual, and no pixel moves by more than four times the root mean square of the
// residual of those like it, which leaves no grains.
//
// Blurs are weighted, so that light does not spread to where the weight is 0, such as the black around smoke.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "core/vec.h"

namespace brisance {

// Of every pixel, rows from the top.
struct NoisyResidual {
    int width = 0, height = 0;
    std::vector<Rgb> estimates[2];  // independent, unbiased; times the divisor
    std::vector<float> weight;      // not negative; the residual is assumed to be alike relative to it
    // In all that both estimates are made of: bands that hardly have one in a pixel of theirs are left out.
    double divisor = 1.0;
    double samples = std::numeric_limits<double>::infinity();
};

// Sums over pixels of a band.
struct ResidualEnergy {
    double residual = 0.0;  // the residual's square; may fall below 0 by chance
    double noise = 0.0;     // that of the noise in the mean of both estimates
    double variance = 0.0;  // of `residual`
    double weight = 0.0;    // the weight's square
    double believed = 1.0;  // so much of what seems to be known

    // Of a pixel between two octaves each takes its share, of the variance, too: that is a little more than it has.
    void add(const ResidualEnergy& other, double share);
    // As if there were so many times the samples: the part of the residual's square that is hardly chance and is
    // believed, and the gain of least square error, from 0 to 1, if the noise counts for so much.
    double known(double samples = 1.0) const;
    double gain(double samples = 1.0, double noise_counts = 1.0) const;
    // The root of the former, over that of the weight's square.
    double relative() const;
};

struct ResidualBand {
    std::vector<ResidualEnergy> octaves;  // of the weight's square, the largest first
    // What the picture loses or gains by the residual and by the noise in this band, over their squares: bands overlap.
    double residual_counts = 1.0, noise_counts = 1.0;
    double levels = 1.0;  // octaves of wavelength

    // As the picture has them: the residual in all octaves, and the part of its square that is known.
    ResidualEnergy sum() const;
    double known() const;
    // What gains would leave of the residual's square with so many times the samples, noise included.
    double left(double samples = 1.0) const;
    // The part that they take away.
    double gain() const;
};

// The square of a residual that can be believed, of all that bands seem to know of it; empty: that.
using Believable = std::function<double(const std::vector<ResidualBand>&)>;

struct SmoothResidual {
    std::vector<Rgb> values;          // of every pixel; 0 where the weight is
    std::vector<ResidualBand> bands;  // the finest first, with all that are not told apart
};

SmoothResidual smooth_residual(const NoisyResidual& residual, const Believable& believable = {});
// Its bands alone, without putting them together.
std::vector<ResidualBand> residual_bands(const NoisyResidual& residual, const Believable& believable = {});

}  // namespace brisance
