// A noisy residual of a picture, blurred as much as its noise demands.
//
// The residual is known twice, with independent noise. A pyramid of blurred and halved pictures divides it into bands,
// from single pixels to the whole (P. Burt, E. Adelson, The Laplacian Pyramid as a Compact Image Code, 1983). In each
// band the product of both estimates has the mean of the residual's own square, since independent noise cancels, and
// the square of their mean has that of residual and noise together. Their quotient is the gain that leaves the least
// square error, Wiener's: bands that are noise vanish, and bands that are known stay. There is one gain for a band, so
// that few numbers are learned from many pixels, and gains change continuously with the samples.
//
// Samples of paths have heavy tails. Where a band is noisy, no pixel of it moves by more than four times the error that
// all have relative to their light, which leaves no grains.
//
// Blurs are weighted, so that light does not spread to where the weight is 0, such as the black around smoke.
#pragma once

#include <vector>

#include "core/vec.h"

namespace brisance {

// Of every pixel, rows from the top.
struct NoisyResidual {
    int width = 0, height = 0;
    std::vector<Rgb> estimates[2];  // independent, unbiased
    std::vector<float> weight;      // not negative; the residual is assumed to be alike relative to it
};

// Sums over all pixels of the squares of the residual and of its noise, in the mean of both estimates.
struct ResidualBand {
    double residual = 0.0, noise = 0.0;  // the former may fall below 0 by chance
    double variance = 0.0;               // of the former
    // Of least square error, from 0 to 1.
    double gain() const;
    // What it leaves of the residual's square, if there were so many times the samples.
    double left(double samples) const;
};

struct SmoothResidual {
    std::vector<Rgb> values;          // of every pixel; 0 where the weight is
    std::vector<ResidualBand> bands;  // the finest first
};

SmoothResidual smooth_residual(NoisyResidual residual);

}  // namespace brisance
