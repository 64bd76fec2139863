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
// besides: no pixel moves by more than four times the root mean square of the residual of those like it, which leaves
// no grains.
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

// Sums over pixels of a band.
struct ResidualEnergy {
    double residual = 0.0;  // the residual's square; may fall below 0 by chance
    double noise = 0.0;     // that of the noise in the mean of both estimates
    double variance = 0.0;  // of `residual`
    double weight = 0.0;    // the weight's square

    // Of a pixel between two octaves each takes its share, of the variance, too: that is a little more than it has.
    void add(const ResidualEnergy& other, double share);
    // As if there were so many times the samples: the part of the residual's square that is hardly chance, and the gain
    // of least square error, from 0 to 1, if the noise counts for so much.
    double known(double samples = 1.0) const;
    double gain(double samples = 1.0, double noise_counts = 1.0) const;
    // The root of the former, over that of the weight's square.
    double relative() const;
};

struct ResidualBand {
    std::vector<ResidualEnergy> octaves;  // of the weight's square, the largest first
    double noise_counts = 1.0;            // beside the residual, as bands overlap
    ResidualEnergy sum() const;
    // What gains would leave of the residual's square with so many times the samples, noise included. As bands overlap,
    // of a smooth residual it is up to a third too little, and of noise too much.
    double left(double samples = 1.0) const;
    // The part that they take away.
    double gain() const;
};

struct SmoothResidual {
    std::vector<Rgb> values;          // of every pixel; 0 where the weight is
    std::vector<ResidualBand> bands;  // the finest first
};

SmoothResidual smooth_residual(NoisyResidual residual);

}  // namespace brisance
