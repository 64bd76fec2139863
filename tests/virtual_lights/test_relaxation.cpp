// Lights that are moved apart in steps: how even they lie, and that they stay where deposits are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#include "core/rng.h"
#include "virtual_lights/placement/relaxation.h"

namespace brisance {
namespace {

// In a square of one metre. `dense`: more to the right, as x grows.
std::vector<vec3> random_deposits(std::size_t count, bool dense = false) {
    std::vector<vec3> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        Rng rng(Stream::Points, i);
        const double x = rng.next_double(), y = rng.next_double();
        out[i] = vec3(float(dense ? std::sqrt(x) : x), float(y), 0.0f);
    }
    return out;
}

VirtualLightSettings of_count(int count) {
    VirtualLightSettings settings;
    settings.count = count;
    return settings;
}

// Mean distance to the nearest other one, over that of as many random points far from any edge, 1/2 per root of
// density.
double evenness(const Survivors& lights, const std::vector<vec3>& at) {
    double sum = 0.0;
    for (const std::uint32_t i : lights.index) {
        float nearest = std::numeric_limits<float>::infinity();
        for (const std::uint32_t j : lights.index)
            if (j != i)
                nearest = std::min(nearest, glm::distance(at[i], at[j]));
        sum += nearest;
    }
    const double count = double(lights.index.size());
    return sum / count / (0.5 / std::sqrt(count));
}

// 400 lights of 8,000 deposits. By chance the ratio is 1, for want of neighbours beyond the edge rather 1.05, with a
// standard deviation of 0.026; a square lattice has 2. Elimination keeps lights further apart, as the stronger method.
TEST(Relaxation, MovesLightsApart) {
    const std::vector<vec3> deposits = random_deposits(8000);
    const VirtualLightSettings settings = of_count(400);
    const double by_chance = evenness(thin_at_random(deposits, settings), deposits),
                 relaxed = evenness(thin_by_relaxation(deposits, settings), deposits),
                 eliminated = evenness(thin_to_blue_noise(deposits, settings), deposits);
    std::printf("evenness by chance %.2f, relaxed %.2f, by elimination %.2f\n", by_chance, relaxed, eliminated);
    EXPECT_NEAR(by_chance, 1.05, 4.0 * 0.026 + 0.05);
    EXPECT_GT(relaxed, 1.25);
    EXPECT_GT(eliminated, relaxed);
}

// Three quarters of the deposits lie in the right half, and nearly as many of the lights: they are moved by distances
// alone, which shifts some of them to where deposits are few.
TEST(Relaxation, StaysWhereDepositsAre) {
    const std::vector<vec3> deposits = random_deposits(8000, true);
    const Survivors lights = thin_by_relaxation(deposits, of_count(400));
    ASSERT_EQ(lights.index.size(), 400u);
    EXPECT_TRUE(std::is_sorted(lights.index.begin(), lights.index.end()));
    EXPECT_EQ(std::set<std::uint32_t>(lights.index.begin(), lights.index.end()).size(), 400u);
    EXPECT_LT(lights.index.back(), 8000u);
    const auto right =
        std::count_if(lights.index.begin(), lights.index.end(), [&](std::uint32_t i) { return deposits[i].x > 0.5f; });
    EXPECT_GT(double(right), 0.55 * 400.0);
    EXPECT_LT(double(right), 0.8 * 400.0);
}

TEST(Relaxation, OfOddDepositsLosesNone) {
    const auto thinned = [](const std::vector<vec3>& deposits, int count) {
        return thin_by_relaxation(deposits, of_count(count)).index;
    };
    EXPECT_TRUE(thinned({}, 10).empty());
    EXPECT_EQ(thinned({vec3(1.0f)}, 10), std::vector<std::uint32_t>{0});
    EXPECT_EQ(thinned(std::vector<vec3>(100, vec3(1.0f)), 10).size(), 10u);  // all at one place
    EXPECT_EQ(thinned(random_deposits(50), 50).size(), 50u);                 // nowhere to go
    EXPECT_EQ(thinned(random_deposits(50), 1).size(), 1u);
}

}  // namespace
}  // namespace brisance
