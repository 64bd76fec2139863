// Random streams are uniform, and streams of different names are independent.
//
// Chi-square tests pass unless their statistic is among the one in ten thousand highest or lowest; correlations lie
// within four standard errors, which one in sixteen thousand does not. Keys are fixed: what passes once passes always.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "core/rng.h"
#include "fixtures/estimate.h"

namespace brisance {
namespace {

using testing::chi_square_tail;
using testing::kSigmas;

constexpr double kRare = 1e-4;
constexpr int kDraws = 1 << 20;

// Counts that should be equal.
void expect_even(const std::vector<int>& counts, const char* what) {
    double total = 0.0, chi_square = 0.0;
    for (const int count : counts)
        total += count;
    const double mean = total / double(counts.size());
    for (const int count : counts)
        chi_square += (count - mean) * (count - mean) / mean;
    const double tail = chi_square_tail(chi_square, int(counts.size()) - 1);
    EXPECT_GT(tail, kRare) << what << ": chi-square " << chi_square << " for " << counts.size() << " cells";
    EXPECT_LT(tail, 1.0 - kRare) << what << ": more even than chance: chi-square " << chi_square;
}

TEST(Rng, OneStreamIsUniform) {
    constexpr int kCells = 1024;
    for (const Stream stream : {Stream::EscapeRay, Stream::Path, Stream::StoredTrack, stream_of("photons/roulette")}) {
        Rng singles(stream, 5, 9), doubles(stream, 9, 5);
        std::vector<int> of_singles(kCells), of_doubles(kCells);
        for (int i = 0; i < kDraws; ++i) {
            const float x = singles.next();
            const double y = doubles.next_double();
            ASSERT_TRUE(x >= 0.0f && x < 1.0f && y >= 0.0 && y < 1.0) << x << ", " << y;
            ++of_singles[int(x * kCells)];
            ++of_doubles[int(y * kCells)];
        }
        expect_even(of_singles, "next");
        expect_even(of_doubles, "next_double");
    }
}

// Names of modules never meet the numbers of the enumeration.
TEST(Rng, StreamsThatAreNamedDiffer) {
    static_assert(stream_of("photons") != stream_of("photons/roulette"));
    static_assert(stream_of("") > Stream::StoredTrack);
    Rng one(stream_of("photons"), 3), other(stream_of("photons/roulette"), 3);
    EXPECT_NE(one.next_double(), other.next_double());
}

// A histogram of the leading bits is blind to all that follow them.
TEST(Rng, LowBitsAreUniformToo) {
    constexpr int kCells = 256;
    Rng singles(Stream::Path, 1), doubles(Stream::Path, 2);
    std::vector<int> of_singles(kCells), of_doubles(kCells);
    for (int i = 0; i < kDraws; ++i) {
        ++of_singles[int(std::uint32_t(singles.next() * 0x1p24f) % kCells)];
        ++of_doubles[int(std::uint64_t(doubles.next_double() * 0x1p53) % kCells)];
    }
    expect_even(of_singles, "last 8 of 24 bits");
    expect_even(of_doubles, "last 8 of 53 bits");
}

// The numbers that two generators draw together: their correlation, and the even filling of the unit square, which sees
// dependence without correlation.
void expect_independent(const char* what, const std::function<std::pair<double, double>(std::uint64_t)>& pair) {
    constexpr int kSide = 32;
    std::vector<int> square(kSide * kSide);
    double sum = 0.0;
    for (std::uint64_t i = 0; i < kDraws; ++i) {
        const auto [x, y] = pair(i);
        sum += (x - 0.5) * (y - 0.5);
        ++square[int(x * kSide) * kSide + int(y * kSide)];
    }
    const double standard_error = std::sqrt(double(kDraws)) / 12.0;  // a uniform number's variance is 1/12
    EXPECT_LT(std::abs(sum), kSigmas * standard_error) << what;
    expect_even(square, what);
}

double first(Stream stream, std::uint64_t a, std::uint64_t b = 0) {
    return Rng(stream, a, b).next_double();
}

TEST(Rng, NeighbouringKeysAreIndependent) {
    constexpr Stream s = Stream::Path, next = Stream::PathRotation;
    constexpr std::uint64_t kFrame = std::uint64_t(1) << 32;
    expect_independent("streams", [&](std::uint64_t i) { return std::pair(first(s, i), first(next, i)); });
    expect_independent("pixels",
                       [&](std::uint64_t i) { return std::pair(first(s, 2 * i, 3), first(s, 2 * i + 1, 3)); });
    expect_independent("samples",
                       [&](std::uint64_t i) { return std::pair(first(s, 3, 2 * i), first(s, 3, 2 * i + 1)); });
    expect_independent("pixel and sample exchanged",
                       [&](std::uint64_t i) { return std::pair(first(s, i, i + 1), first(s, i + 1, i)); });
    expect_independent("keys that differ above 32 bits",
                       [&](std::uint64_t i) { return std::pair(first(s, i), first(s, i + kFrame)); });
}

TEST(Rng, DrawsOfOneStreamAreIndependent) {
    for (const int gap : {1, 2, 3}) {
        Rng rng(Stream::Photon, 11, std::uint64_t(gap));
        expect_independent("draws", [&](std::uint64_t) {
            const double x = rng.next_double();
            for (int skipped = 1; skipped < gap; ++skipped)
                rng.next_double();
            return std::pair(x, rng.next_double());
        });
    }
}

// Streams of keys that follow each other must not be one sequence, shifted: SplitMix64 adds a constant at each draw.
TEST(Rng, OneStreamIsNotAnotherShifted) {
    for (int shift = 1; shift <= 4; ++shift)
        expect_independent("shifted", [&](std::uint64_t i) {
            Rng rng(Stream::Path, i);
            for (int k = 0; k < shift; ++k)
                rng.next_double();
            return std::pair(rng.next_double(), first(Stream::Path, i + std::uint64_t(shift)));
        });
}

TEST(Rng, AKeyNamesItsNumbers) {
    std::vector<double> expected;
    Rng reference(Stream::Surface, 17, 4);
    for (int i = 0; i < 100; ++i)
        expected.push_back(reference.next_double());
    // Whoever else draws in between.
    Rng again(Stream::Surface, 17, 4), other(Stream::Surface, 17, 5);
    for (const double value : expected) {
        EXPECT_EQ(again.next_double(), value);
        other.next();
    }
}

// Two of so many random numbers of 53 bits are equal once in thirty thousand times.
TEST(Rng, NoTwoKeysShareTheirNumbers) {
    std::set<double> seen;
    for (std::uint64_t stream = 1; stream <= 8; ++stream)
        for (std::uint64_t a = 0; a < 256; ++a)
            for (std::uint64_t b = 0; b < 256; ++b)
                seen.insert(first(static_cast<Stream>(stream), a, b));
    EXPECT_EQ(seen.size(), 8u * 256u * 256u);
}

}  // namespace
}  // namespace brisance
