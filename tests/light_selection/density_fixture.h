// Tests of densities over segments, and pairs of segments in all relations.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fixtures/estimate.h"
#include "tracking/segment.h"

namespace brisance::testing {

// A density's integral from 0, on a mesh that is fine around `centre`, down to 1e-13 of the length.
class Cumulative {
public:
    template <class Density>
    Cumulative(double length, double centre, const Density& density) {
        constexpr int kPoints = 20'000;
        const double c = std::clamp(centre, 0.0, length);
        for (int i = kPoints; i > 0 && c > 0.0; --i)
            places_.push_back(c - c * graded(double(i) / kPoints));
        places_.push_back(c);
        for (int i = 1; i <= kPoints && c < length; ++i)
            places_.push_back(c + (length - c) * graded(double(i) / kPoints));
        sums_.push_back(0.0);
        for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
            const double a = places_[i], b = places_[i + 1];
            sums_.push_back(sums_.back() + (b - a) / 6.0 * (density(a) + 4.0 * density(0.5 * (a + b)) + density(b)));
        }
    }
    double whole() const { return sums_.back(); }
    double at(double t) const {
        const auto after = std::upper_bound(places_.begin(), places_.end() - 1, t);
        const auto i = std::max<std::ptrdiff_t>(after - places_.begin(), 1);
        const double part = (t - places_[i - 1]) / std::max(places_[i] - places_[i - 1], 1e-300);
        return std::lerp(sums_[i - 1], sums_[i], std::clamp(part, 0.0, 1.0));
    }

private:
    static double graded(double x) { return x >= 1.0 ? 1.0 : std::exp(30.0 * (x - 1.0)); }
    std::vector<double> places_, sums_;
};

// The density integrates to one, and samples follow it: their cumulative density is uniform.
template <class Density>
void expect_density(const Density& density, double length, double centre, const char* what) {
    const Cumulative cumulative(length, centre, [&](double t) { return density.pdf(t); });
    EXPECT_NEAR(cumulative.whole(), 1.0, 1e-5) << what;
    constexpr int kBins = 64, kSamples = 32'000;
    std::vector<int> count(kBins, 0);
    Rng rng(Stream::Points, 3);
    for (int i = 0; i < kSamples; ++i) {
        const double t = density.sample(rng);
        ASSERT_GE(t, 0.0) << what;
        ASSERT_LE(t, length) << what;
        ++count[std::clamp(static_cast<int>(cumulative.at(t) * kBins), 0, kBins - 1)];
    }
    double chi_square = 0.0;
    for (const int n : count)
        chi_square += std::pow(n - double(kSamples) / kBins, 2) / (double(kSamples) / kBins);
    EXPECT_GT(chi_square_tail(chi_square, kBins - 1), 1e-4) << what << ": " << chi_square;
}

struct Lines {
    const char* name;
    Segment camera, light;
};

inline dvec3 unit(double x, double y, double z) {
    return glm::normalize(dvec3(x, y, z));
}

inline std::vector<Lines> many_lines() {
    const Segment along_x{{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 2.0};
    return {{"skew", along_x, {{0.3, -1.0, 0.2}, unit(0.4, 1.0, 0.1), 1.7}},
            {"almost touching", along_x, {{0.0, -1.0, 1e-6}, {0.0, 1.0, 0.0}, 2.0}},
            {"crossing", along_x, {{0.2, -1.0, 0.0}, {0.0, 1.0, 0.0}, 1.5}},
            {"crossing behind the ray's start", along_x, {{0.2, 0.3, 0.0}, {0.0, 1.0, 0.0}, 1.5}},
            {"starting on the other ray", along_x, {{0.2, 0.0, 0.0}, unit(0.1, 1.0, 0.3), 1.5}},
            {"parallel", along_x, {{-0.5, 0.25, 0.0}, {1.0, 0.0, 0.0}, 3.0}},
            {"opposite", along_x, {{1.5, 0.01, 0.0}, {-1.0, 0.0, 0.0}, 3.0}},
            {"almost parallel", along_x, {{-0.5, 0.25, 0.0}, unit(1.0, 1e-9, 1e-8), 3.0}},
            {"at a small angle", along_x, {{-0.5, 0.001, 0.0}, unit(1.0, 1e-3, 1e-2), 3.0}},
            {"far apart", along_x, {{5e4, 3e4, 1e4}, unit(0.3, 1.0, -0.2), 10.0}},
            {"short beside long", along_x, {{0.1, 1e-4, 2e-4}, unit(0.3, 1.0, -0.2), 1e-5}},
            {"tiny", {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1e-9}, {{0.0, 1e-9, 2e-9}, unit(1.0, 1.0, 1.0), 1e-9}},
            {"astronomical", {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1e12}, {{4e11, -2e11, 1e9}, {0.0, 1.0, 0.0}, 1e12}}};
}

inline double foot(const Segment& segment, const dvec3& point) {
    return glm::dot(point - segment.start, segment.direction);
}

// Where two lines are closest, on the first.
inline double closest(const Segment& a, const Segment& b) {
    const dvec3 turn = a.direction - glm::dot(a.direction, b.direction) * b.direction;
    const double sine2 = glm::dot(turn, turn);
    return sine2 > 0.0 ? -glm::dot(a.start - b.start, turn) / sine2 : 0.0;
}

}  // namespace brisance::testing
