#include "estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/parallel.h"

namespace brisance::testing {

namespace {

// Roberts' three-dimensional sequence, shifted at random for every batch.
constexpr double kSteps[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};

double part(double x) {
    return x - std::floor(x);
}

// Counts the calls within each test.
std::uint64_t number_of_call() {
    static const ::testing::TestInfo* test = nullptr;
    static std::uint64_t count = 0;
    const auto* const now = ::testing::UnitTest::GetInstance()->current_test_info();
    count = now == test ? count + 1 : 0;
    test = now;
    return count;
}

}  // namespace

Estimate estimate(int numbers, std::uint64_t per_batch, const Sampler& sample) {
    const std::uint64_t first_key = number_of_call() * kBatches;
    std::vector<double> sums(std::size_t(kBatches) * numbers);
    parallel_for(kBatches, [&](std::size_t batch) {
        const std::uint64_t key = first_key + batch;
        Rng shift(Stream::PathRotation, key);
        const dvec3 first(shift.next_double(), shift.next_double(), shift.next_double());
        std::vector<double> out(numbers);
        for (std::uint64_t i = 0; i < per_batch; ++i) {
            Rng rng(Stream::Path, key, i);
            const dvec3 place(part(first.x + i * kSteps[0]), part(first.y + i * kSteps[1]),
                              part(first.z + i * kSteps[2]));
            sample(place, rng, out.data());
            for (int k = 0; k < numbers; ++k)
                sums[batch * numbers + k] += out[k] / double(per_batch);
        }
    });
    Estimate e{std::vector<double>(numbers), std::vector<double>(numbers), per_batch * kBatches};
    for (int k = 0; k < numbers; ++k) {
        for (int b = 0; b < kBatches; ++b)
            e.mean[k] += sums[b * numbers + k] / kBatches;
        double square = 0.0;
        for (int b = 0; b < kBatches; ++b)
            square += std::pow(sums[b * numbers + k] - e.mean[k], 2);
        e.error[k] = std::sqrt(square / (kBatches - 1.0) / kBatches);
    }
    return e;
}

// Where many samples are wanted a second pilot finds out what stratification is worth.
Estimate estimate_to(double relative, int numbers, const Sampler& sample, std::uint64_t most) {
    constexpr double margin = 0.85;  // below what is asked for, because pilots only guess
    constexpr double pilot = 8.0, large_pilot = 64.0, many = 4.0 * large_pilot;
    double per_batch = pilot;
    for (int attempt = 0;; ++attempt) {
        const Estimate e = estimate(numbers, static_cast<std::uint64_t>(per_batch), sample);
        double worst = 0.0;
        for (int k = 0; k < numbers; ++k)
            worst = std::max(worst, e.mean[k] != 0.0 ? e.error[k] / std::abs(e.mean[k]) : 0.0);
        const bool enough = worst <= relative || per_batch * kBatches >= double(most);
        if (attempt > 4 || (attempt > 0 && enough))
            return e;
        const double wanted = std::ceil(std::pow(worst / (margin * relative), 2) * per_batch);
        per_batch = std::clamp(wanted, pilot, std::floor(double(most) / kBatches));
        if (attempt == 0 && wanted > many)
            per_batch = large_pilot;
    }
}

Rows::~Rows() {
    constexpr double alike = 3.0;  // rows that one call estimates, as channels, go up and down together
    const double together = sum_ / std::sqrt(alike * std::max(count_, 1));
    EXPECT_LE(std::abs(together), kSigmas) << what_ << ": all rows together";
    std::printf(
        "%s: %d rows, worst deviation %.2f standard errors (%s), all together %+.2f, largest standard error "
        "%.3f %%\n",
        what_.c_str(), count_, worst_, worst_row_.c_str(), together, 100.0 * dullest_);
}

void Rows::expect(const std::string& row, double mean, double error, double truth, double allowance, double sharp) {
    ++count_;
    const double beyond = std::max(0.0, std::abs(mean - truth) - allowance);
    EXPECT_LE(beyond, kSigmas * error) << row << ": " << mean << " +- " << error << ", expected " << truth;
    EXPECT_LE(error, sharp * std::abs(truth)) << row << ": not sampled enough";
    if (error > 0.0 && beyond / error >= worst_) {
        worst_ = beyond / error;
        worst_row_ = row;
    }
    if (error > 0.0)
        sum_ += std::copysign(beyond / error, mean - truth);
    dullest_ = std::max(dullest_, error / std::abs(truth));
}

dvec3 uniform_direction(double u, double v) {
    const double z = 1.0 - 2.0 * u, r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {r * std::cos(2.0 * kPi64 * v), r * std::sin(2.0 * kPi64 * v), z};
}

double chi_square_tail(double chi_square, int degrees) {
    const double k = 2.0 / (9.0 * degrees);
    const double z = (std::cbrt(chi_square / degrees) - (1.0 - k)) / std::sqrt(k);
    return 0.5 * std::erfc(z / std::sqrt(2.0));
}

}  // namespace brisance::testing
