// Orders of scattering by diffusion, against paths and against the hierarchy.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/glowing_series.h"

namespace brisance {
namespace {

using namespace testing;

ScatteringSettings by_diffusion(bool limit = true) {
    ScatteringSettings settings;
    settings.solver = ScatteringSolver::Diffusion;
    settings.lattice_level = 0;
    settings.flux_limiter = limit;
    return settings;
}

struct Case {
    float optical_radius, albedo, mean_cosine, error;
};

class DiffusedLight : public ::testing::TestWithParam<Case> {};

// What is emitted escapes or is absorbed, and what is scattered says what is absorbed.
TEST_P(DiffusedLight, LosesAlmostAsMuchAsPathsDo) {
    const auto [radius, albedo, g, error] = GetParam();
    constexpr int kNodes = 10;
    const Estimate paths = escaped_by_paths(radius, albedo, g, kNodes);
    const Fire fire(kNodes, radius, albedo, g);
    const double emitted = emitted_power(fire.lit.medium).x;
    for (const bool limit : {true, false}) {
        ScatteringCosts costs;
        const double scattered = 4.0 * kPi64 * total(fire.solved(by_diffusion(limit), costs).front().intensity).x;
        const double escaped = 1.0 - scattered * (1.0 - albedo) / albedo / emitted;
        ASSERT_TRUE(costs.diffusion);
        EXPECT_TRUE(costs.diffusion->converged);
        std::printf("radius %g albedo %g g %g, %s: escaped %.4f, by paths %.4f +- %.4f; %d limiters, %d iterations\n",
                    radius, albedo, g, limit ? "limited" : "classical", escaped, paths.mean[0], paths.error[0],
                    costs.diffusion->limiters, costs.diffusion->iterations);
        if (limit) {
            EXPECT_NEAR(escaped, paths.mean[0], kSigmas * paths.error[0] + error);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Balls, DiffusedLight,
                         ::testing::Values(Case{0.5f, 0.9f, 0.0f, 0.02f}, Case{2.0f, 0.5f, 0.0f, 0.02f},
                                           Case{2.0f, 0.9f, 0.0f, 0.02f}, Case{8.0f, 0.9f, 0.0f, 0.02f},
                                           Case{2.0f, 0.9f, 0.5f, 0.02f}, Case{8.0f, 0.5f, 0.5f, 0.02f},
                                           Case{8.0f, 0.99f, 0.0f, 0.02f}));

// Node by node the same light as bounce after bounce, in a thick ball.
TEST(DiffusedLightInAThickBall, AgreesWithTheHierarchy) {
    for (const float g : {0.0f, 0.5f}) {
        const Fire fire(10, 6.0f, 0.9f, g);
        ScatteringCosts costs, others;
        ScatteringSettings hierarchy;
        hierarchy.lattice_level = 0;
        const ScatteredLight b = fire.solved(hierarchy, others).front();
        EXPECT_FALSE(others.diffusion);
        double difference[2];
        for (const bool limit : {true, false}) {
            const ScatteredLight a = fire.solved(by_diffusion(limit), costs).front();
            double squares = 0.0, all = 0.0, sum = 0.0;
            for (std::size_t i = 0; i < a.intensity.size(); ++i) {
                squares += std::pow(a.intensity[i].x - b.intensity[i].x, 2);
                all += std::pow(b.intensity[i].x, 2);
                sum += a.intensity[i].x;
            }
            difference[limit] = std::sqrt(squares / all);
            std::printf("g %g, %s: root mean square difference %.4f, mean %+.4f\n", g, limit ? "limited" : "classical",
                        difference[limit], sum / total(b.intensity).x - 1.0);
        }
        EXPECT_LT(difference[true], g == 0.0f ? 0.06 : 0.1);
        EXPECT_LT(difference[true], 0.6 * difference[false]);
    }
}

TEST(DiffusedLightInOrders, AreOnceAndAllOthers) {
    const Fire fire(8, 2.0f, 0.7f, 0.0f);
    ScatteringCosts costs;
    const dvec3 together = total(fire.solved(by_diffusion(), costs).front().intensity);
    const auto orders = fire.solved(by_diffusion(), costs, true, true);
    ASSERT_EQ(orders.size(), 2u);
    const ScatteredLight once = scattered_light(fire.lit.medium, fire.first, fire.smoke);
    EXPECT_EQ(total(orders[0].intensity).x, total(once.intensity).x);
    EXPECT_NEAR((total(orders[0].intensity).x + total(orders[1].intensity).x) / together.x, 1.0, 1e-5);
    EXPECT_EQ(costs.bounces, 0);
}

// Without albedo nothing is scattered, and the equation is never set up.
TEST(DiffusedLightInOrders, OfBlackSmokeAreNone) {
    const Fire fire(6, 2.0f, 0.0f, 0.0f);
    ScatteringCosts costs;
    EXPECT_EQ(total(fire.solved(by_diffusion(), costs).front().intensity).x, 0.0);
    EXPECT_FALSE(costs.diffusion);
}

}  // namespace
}  // namespace brisance
