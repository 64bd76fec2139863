// Errors of an image against its reference, each a single number. All are relative: they depend neither on the unit nor
// on the exposure.
#pragma once

#include <cstddef>
#include <span>

#include "core/vec.h"

namespace brisance {

constexpr double kEpsilonShare = 1e-2;  // of the reference's mean: what relMSE and MAPE add to small denominators
constexpr double kTrimmedShare = 1e-3;  // of the pixels, those of largest error, that relMSE leaves out
constexpr double kNoiseMargin = 2.0;  // errors below this multiple of the reference's noise say nothing about the image

// Of an image I from a reference R, over all pixels and channels. Infinite where the denominator is 0 and the numerator
// is not, as with a black reference.
struct Differences {
    double rrmse = 0.0;    // ||I - R|| / ||R||
    double relmse = 0.0;   // mean of (I - R)^2 / (R^2 + epsilon^2), channels averaged first, without the trimmed pixels
    double mape = 0.0;     // mean of |I - R| / (|R| + epsilon)
    double mean = 0.0;     // mean(I) / mean(R) - 1: the bias
    double epsilon = 0.0;  // kEpsilonShare of the mean of |R|, in the pixels' unit
    std::size_t trimmed = 0;  // kTrimmedShare of the pixels, rounded down
};

// All values finite; both of the same size, in the same order.
Differences measure_differences(std::span<const Rgb> image, std::span<const Rgb> reference);

// Of an image I from a reference known by two independent halves A and B.
struct HalvesDifferences {
    // sqrt(max(0, sum (I - A)(I - B) / sum A B)). The noise of A and of B is independent of each other and of I, so its
    // square has the expectation of the true squared rRMSE, without what the noise of (A + B) / 2 adds to rRMSE. 0 also
    // where chance makes the sum negative: then the error is below what the halves resolve.
    double noise_free = 0.0;
    double reference_noise = 0.0;  // rRMSE of (A + B) / 2 by its noise: ||A - B|| / 2 / ||(A + B) / 2||
};

HalvesDifferences measure_halves(std::span<const Rgb> image, std::span<const Rgb> a, std::span<const Rgb> b);

// An rRMSE against (A + B) / 2 that measures the noise of the reference rather than the image: below kNoiseMargin times
// the reference's noise. Says nothing about the noise-free error, which may be far smaller.
inline bool below_noise(double rrmse, double reference_noise) {
    return rrmse < kNoiseMargin * reference_noise;
}

}  // namespace brisance
