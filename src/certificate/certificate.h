// The estimated error of a finished picture against the truth.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "certificate/pixel_survey.h"

namespace brisance {

// The error of the picture, or of one of its ledger cells relative to that cell's own truth R. Infinite bounds mean
// that nothing is known.
struct CertifiedError {
    std::string cell;         // of the ledger; empty: the picture
    double square = 0.0;      // unbiased estimate of error^2: may fall below 0 by chance; certificates may be averaged
    double error = 0.0;       // ||I - R|| / ||R||, over all pixels and channels: root of the square, or of 0
    Interval error_interval;  // from 0 where an error of 0 cannot be excluded; its end is then an upper bound
    double mean = 0.0;        // mean(I) / mean(R) - 1
    Interval mean_interval;
    double largest_share = 0.0;  // of the squared error's variance, from the pair of pixels that adds most
    double square_deviation = std::numeric_limits<double>::infinity();  // standard error of `square`
    double degrees_of_freedom = 0.0;  // of the survey of the squared differences that this is of
};

struct Certificate {
    std::vector<CertifiedError> errors;  // the picture first
    std::uint64_t samples = 0;           // in all
    std::uint64_t pixels = 0;            // drawn; some perhaps more than once
    std::uint64_t samples_per_pixel = 0;
    int seed = 0;
    std::uint64_t not_finite_pixels = 0;   // of the picture; the certificate leaves them out
    std::uint64_t not_finite_samples = 0;  // counted as 0

    // Contains no times, so that equal renders have equal certificates.
    nlohmann::ordered_json to_json() const;
    // "error 0.8 % (0.6 to 1.0 %), mean +0.1 % (-0.1 to +0.3 %) at 95 % confidence; V ...", for people.
    std::string line() const;
};

}  // namespace brisance
