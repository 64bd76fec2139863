// Means of Monte Carlo estimators with their standard errors, and statements about them.
//
// Samples come in independent batches; within a batch they are stratified. The spread of the batches' means gives the
// standard error, whatever the stratification. Statements hold within four standard errors: by chance one in sixteen
// thousand fails, and seeds are fixed, so that what passes once passes always.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/rng.h"
#include "core/vec.h"

namespace brisance::testing {

constexpr double kPi64 = 3.14159265358979323846;
constexpr double kSigmas = 4.0;
constexpr double kSharp = 0.002;  // relative standard error that comparisons with tables are sampled to
constexpr int kBatches = 256;

struct Estimate {
    std::vector<double> mean, error;  // per number that the estimator returns
    std::uint64_t samples = 0;
};

// One sample: fills `out` from a stratified point of the unit cube and random numbers of its own.
using Sampler = std::function<void(const dvec3& place, Rng& rng, double* out)>;

// `per_batch` samples in each of kBatches batches, on all threads. Every call in a test has random numbers of its own,
// the same whenever the test runs.
Estimate estimate(int numbers, std::uint64_t per_batch, const Sampler& sample);

// As many samples as pilots say that a relative standard error `relative` of every number needs; the pilots' own
// samples are not used, so that choosing by them biases nothing. At most `most` samples in all.
Estimate estimate_to(double relative, int numbers, const Sampler& sample, std::uint64_t most = 4'000'000);

// Rows of a table, met within four standard errors each, and together: deviations of one sign add up to what none of
// them shows. `allowance` is what the row itself is known to (rounding, and the discretisation of the medium),
// absolute. Says at the end how close it was.
class Rows {
public:
    explicit Rows(std::string what) : what_(std::move(what)) {}
    ~Rows();
    Rows(const Rows&) = delete;
    Rows& operator=(const Rows&) = delete;

    void expect(const std::string& row, double mean, double error, double truth, double allowance,
                double sharp = kSharp);

private:
    std::string what_, worst_row_;
    int count_ = 0;
    double worst_ = 0.0, sum_ = 0.0, dullest_ = 0.0;
};

// A direction uniform over the sphere, from two numbers in [0, 1).
dvec3 uniform_direction(double u, double v);

// Probability that a chi-square variable of that many degrees of freedom is larger (Wilson and Hilferty's
// approximation).
double chi_square_tail(double chi_square, int degrees);

}  // namespace brisance::testing
