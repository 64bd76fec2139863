// Candidates of varying density.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "point_fixture.h"

namespace brisance {
namespace {

constexpr int kStrips = 8;
constexpr float kFall = 6.0f;  // octaves of density from left to right

// Uniform in y; strips of equal width in x hold geometrically falling numbers of points.
std::vector<vec3> falling(std::size_t n, std::uint64_t seed) {
    std::vector<vec3> points = testing::square(n, seed);
    for (vec3& p : points)
        p.x = -std::log2(1.0f - p.x * (1.0f - std::exp2(-kFall))) / kFall;
    return points;
}

std::array<double, kStrips> counts(const std::vector<vec3>& points) {
    std::array<double, kStrips> count{};
    for (const vec3& p : points)
        count[std::min(int(p.x * kStrips), kStrips - 1)] += 1.0;
    return count;
}

// Survivors of n candidates that stay with probability s each would vary by sqrt(n s (1 - s)); chosen ones vary less.
// Four times that (1 chance in 16 000 each), and 2 % for the border and the density that changes within r_k.
TEST(Density, IsKeptByAdaptiveRadii) {
    constexpr std::size_t n = 100'000, target = 10'000;
    const std::vector<vec3> points = falling(n, 30);
    const auto before = counts(points);
    const auto after = counts(testing::chosen(points, eliminate(points, target, testing::adaptive())));
    for (int k = 0; k < kStrips; ++k) {
        const double share = double(target) / n, expected = share * before[k];
        std::printf("strip %d: %.0f of %.0f, expected %.0f\n", k, after[k], before[k], expected);
        EXPECT_NEAR(after[k], expected, 4.0 * std::sqrt(expected * (1.0 - share)) + 0.02 * expected) << k;
    }
}

// Wherever there are enough candidates, an equal number stays.
TEST(Density, IsLevelledByUniformRadii) {
    constexpr std::size_t n = 100'000, target = 2'000;
    const std::vector<vec3> points = falling(n, 31);
    const auto before = counts(points);
    const auto after = counts(testing::chosen(points, eliminate(points, target, testing::uniform(1.0))));
    for (int k = 0; k < kStrips; ++k) {
        const double expected = double(target) / kStrips;
        std::printf("strip %d: %.0f of %.0f\n", k, after[k], before[k]);
        EXPECT_NEAR(after[k], expected, 4.0 * std::sqrt(expected)) << k;
    }
}

// In space too: a ball twice as dense as the rest of the cube.
TEST(Density, IsKeptInVolumes) {
    std::vector<vec3> points = testing::cube(60'000, 32);
    const auto in_ball = [](const vec3& p) { return glm::distance(p, vec3(0.5f)) < 0.3f; };
    for (const vec3& p : testing::cube(60'000, 33))
        if (in_ball(p))
            points.push_back(p);
    const auto inside = [&](const std::vector<vec3>& all) {
        return double(std::count_if(all.begin(), all.end(), in_ball)) / double(all.size());
    };
    const std::vector<vec3> survivors = testing::chosen(points, eliminate(points, 6'000, testing::adaptive(3)));
    const double expected = inside(points), error = std::sqrt(expected * (1.0 - expected) / 6'000);
    std::printf("share inside %.4f, of candidates %.4f\n", inside(survivors), expected);
    EXPECT_NEAR(inside(survivors), expected, 4.0 * error + 0.02 * expected);
}

}  // namespace
}  // namespace brisance
