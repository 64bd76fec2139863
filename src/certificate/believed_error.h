// The error that a finished picture is believed to have: what a model of its method's errors expects, corrected by few
// unbiased samples.
//
// The model knows errors to a factor. A survey of few samples is right on average, whatever the model leaves out, but
// noisy where errors are small. Bayes' theorem joins them. The model is a distribution of the logarithm of the error e
// about that of the expected one: Student's t with three degrees of freedom, for a picture unlike those that the model
// was made from errs as no normal distribution allows. The survey's squared error is e^2 and noise that follows
// Student's t with the survey's degrees of freedom. What is believed is the median of the distribution that results,
// and its interval holds 95 % of it. A survey without noise decides alone, and so does the model without samples.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "certificate/certificate.h"

namespace brisance {

struct ExpectedError {
    std::string cell;     // of the ledger; empty: the picture
    double error = 0.0;   // ||I - R|| / ||R||, as CertifiedError
    double spread = 0.0;  // scale of the distribution of the error's logarithm; 0: the error is known
};

// Degrees of freedom of the model's distribution, and half the interval of the model alone, over its spread: 95 % of
// that distribution.
constexpr double kDegreesOfModel = 3.0, kHalfWidthOfModel = 3.182;

struct BelievedError {
    std::string cell;
    double error = 0.0;
    Interval interval;
    double model = 0.0;  // the expected error
};

// `sampled`: null where there are no samples.
BelievedError believed_error(const ExpectedError& expected, const CertifiedError* sampled);

struct Belief {
    std::vector<BelievedError> errors;  // the picture first
    std::uint64_t samples = 0, pixels = 0;

    const BelievedError* of(const std::string& cell) const;  // null: none
    // With what a certificate says of the same picture: errors, and the ratios of believed to certified ones.
    nlohmann::ordered_json to_json(const Certificate* certificate = nullptr) const;
    // "2.1 % (1.8 to 2.5 %); V 0.4 %, MV ...", for people.
    std::string line() const;
    // "believed over certified 0.95; V 1.1, MV ...". Empty where the certificate knows no error.
    std::string ratios(const Certificate& certificate) const;
};

}  // namespace brisance
