// Sums in fixed point: the same bits in any order, with the stated resolution and range.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/fixed_sums.h"
#include "core/nearest_whole.h"
#include "core/parallel.h"
#include "core/rng.h"

namespace brisance {
namespace {

constexpr std::size_t kSums = 5;

struct Addend {
    std::size_t sum;
    dvec3 value;
};

// Of sizes from 1 down to a millionth, and of both signs.
std::vector<Addend> addends(std::size_t count) {
    std::vector<Addend> list(count);
    Rng rng(Stream::Points, 1);
    for (Addend& a : list) {
        a.sum = std::min(std::size_t(rng.next() * kSums), kSums - 1);
        for (int c = 0; c < 3; ++c)
            a.value[c] = (rng.next() < 0.3f ? -1.0 : 1.0) * std::pow(10.0, -6.0 * rng.next_double());
    }
    return list;
}

std::vector<dvec3> read_all(const FixedSums& sums) {
    std::vector<dvec3> values;
    for (std::size_t s = 0; s < kSums; ++s)
        values.push_back(sums.read(s));
    return values;
}

std::vector<dvec3> added(const std::vector<Addend>& list) {
    FixedSums sums(kSums, 1.0);
    for (const Addend& a : list)
        sums.add(a.sum, a.value);
    return read_all(sums);
}

// Of all sizes up to 2^62, and where rounding is hardest: at halves and beside them.
TEST(NearestWhole, IsThatOfTheStandardLibrary) {
    Rng rng(Stream::Points, 3);
    for (int i = 0; i < 300000; ++i) {
        const double size = std::exp2(std::floor(62.0 * rng.next_double())), x = size * (2.0 * rng.next_double() - 1.0);
        const double half = std::floor(x) + 0.5;
        for (const double y : {x, half, std::nextafter(half, x), std::nextafter(half, half + 1.0),
                               std::nextafter(half, half - 1.0), std::floor(x)})
            ASSERT_EQ(nearest_whole(y), std::llround(y)) << y;
    }
    const double below_half = std::nextafter(0.5, 0.0);
    EXPECT_EQ(nearest_whole(below_half), 0);
    EXPECT_EQ(nearest_whole(-below_half), 0);
    EXPECT_EQ(nearest_whole(0.5), 1);
    EXPECT_EQ(nearest_whole(-0.5), -1);
}

// As track lengths are added: several steps of one sum at once.
TEST(FixedSums, OfStepsAddedBeforeAreTheSame) {
    const std::vector<Addend> list = addends(20000);
    FixedSums sums(kSums, 1.0);
    std::vector<FixedSums::Steps> steps(kSums, FixedSums::Steps(0));
    for (const Addend& a : list)
        steps[a.sum] += sums.steps(a.value);
    for (std::size_t s = 0; s < kSums; ++s)
        sums.add_steps(s, steps[s]);
    EXPECT_EQ(read_all(sums), added(list));
}

TEST(FixedSums, StartAtNothing) {
    const FixedSums sums(kSums, 3.0);
    for (const dvec3& value : read_all(sums))
        EXPECT_EQ(value, dvec3(0.0));
    EXPECT_EQ(sums.bytes(), kSums * 3 * sizeof(std::int64_t));
}

TEST(FixedSums, KnowNoOrder) {
    std::vector<Addend> list = addends(20000);
    const std::vector<dvec3> forward = added(list);
    std::ranges::reverse(list);
    EXPECT_EQ(added(list), forward);
    std::ranges::sort(list, {}, [](const Addend& a) { return a.value.x; });
    EXPECT_EQ(added(list), forward);
    // In plain doubles the order shows; without that, the test above would say nothing.
    double up = 0.0, down = 0.0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        up += list[i].value.x;
        down += list[list.size() - 1 - i].value.x;
    }
    EXPECT_NE(up, down);
}

TEST(FixedSums, KnowNoThreads) {
    const std::vector<Addend> list = addends(50000);
    const std::vector<dvec3> expected = added(list);
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        FixedSums sums(kSums, 1.0);
        parallel_for(list.size(), [&](std::size_t i) { sums.add(list[i].sum, list[i].value); });
        EXPECT_EQ(read_all(sums), expected) << threads << " threads";
    }
}

TEST(FixedSums, RoundToTheNearestStep) {
    for (const double whole : {1.0, 7.3e-12, 4.1e9}) {
        const double step = whole * 0x1p-46;
        FixedSums sums(1, whole);
        sums.add(0, {3.4 * step, 3.6 * step, -3.6 * step});
        const dvec3 read = sums.read(0) / step;
        EXPECT_NEAR(read.x, 3.0, 1e-12) << whole;
        EXPECT_NEAR(read.y, 4.0, 1e-12) << whole;
        EXPECT_NEAR(read.z, -4.0, 1e-12) << whole;
    }
}

// A sum of n values is off by half a step for each, at most.
TEST(FixedSums, LoseHalfAStepAnAddition) {
    const std::vector<Addend> list = addends(20000);
    std::vector<dvec3> exact(kSums, dvec3(0.0));
    std::vector<int> count(kSums);
    for (const Addend& a : list) {
        exact[a.sum] += a.value;
        ++count[a.sum];
    }
    const std::vector<dvec3> found = added(list);
    for (std::size_t s = 0; s < kSums; ++s)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[s][c], exact[s][c], 0.5 * count[s] * 0x1p-46 + 1e-12) << s;
}

TEST(FixedSums, HoldTwoToTheSixteenthTimesTheWhole) {
    constexpr double whole = 0.75;
    FixedSums at_once(1, whole), in_parts(1, whole);
    at_once.add(0, whole * 0x1p16 * dvec3(1.0, -1.0, 0.5));
    EXPECT_EQ(at_once.read(0), whole * 0x1p16 * dvec3(1.0, -1.0, 0.5));
    for (int i = 0; i < 1 << 16; ++i)
        in_parts.add(0, whole * dvec3(1.0, -1.0, 0.5));
    EXPECT_EQ(in_parts.read(0), at_once.read(0));
}

// Where no light is expected at all, the unit is tiny, not zero: nothing is divided by it.
TEST(FixedSums, OfNothingAreZero) {
    FixedSums sums(1, 0.0);
    sums.add(0, dvec3(0.0));
    EXPECT_EQ(sums.read(0), dvec3(0.0));
}

}  // namespace
}  // namespace brisance
