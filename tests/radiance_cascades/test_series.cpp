// The series of bounces by radiance cascades, against paths and against independent rays.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/parallel.h"
#include "fixtures/glowing_series.h"

namespace brisance {
namespace {

using namespace testing;

ScatteringSettings by_cascades(int level = 0) {
    ScatteringSettings settings;
    settings.solver = ScatteringSolver::RadianceCascades;
    settings.lattice_level = level;
    return settings;
}

struct Case {
    float optical_radius, albedo, mean_cosine;
};

class SeriesByCascades : public ::testing::TestWithParam<Case> {};

// What is emitted escapes or is absorbed, and what is scattered says what is absorbed.
TEST_P(SeriesByCascades, LosesAsMuchAsPathsDo) {
    const auto [radius, albedo, g] = GetParam();
    constexpr int kNodes = 6;
    const Estimate paths = escaped_by_paths(radius, albedo, g, kNodes);
    const Fire fire(kNodes, radius, albedo, g);
    const double emitted = emitted_power(fire.lit.medium).x;
    for (const bool balance : {true, false}) {
        ScatteringCosts costs;
        const double scattered = 4.0 * kPi64 * total(fire.solved(by_cascades(), costs, balance).front().intensity).x;
        const double escaped = 1.0 - scattered * (1.0 - albedo) / albedo / emitted;
        std::printf("radius %g albedo %g g %g, %s: escaped %.4f, by paths %.4f +- %.4f, %d bounces\n", radius, albedo,
                    g, balance ? "balanced" : "as gathered", escaped, paths.mean[0], paths.error[0], costs.bounces);
        EXPECT_NEAR(escaped, paths.mean[0], kSigmas * paths.error[0] + (balance ? 0.006 : 0.03));
    }
}

INSTANTIATE_TEST_SUITE_P(Balls, SeriesByCascades,
                         ::testing::Values(Case{0.5f, 0.5f, 0.0f}, Case{2.0f, 0.5f, 0.0f}, Case{2.0f, 0.9f, 0.0f},
                                           Case{8.0f, 0.9f, 0.0f}, Case{0.5f, 0.9f, 0.5f}, Case{2.0f, 0.9f, 0.5f},
                                           Case{8.0f, 0.5f, 0.5f}));

class EnergyOfCascades : public ::testing::TestWithParam<float> {};

// Rays of their own count what escapes; the flights say what collides, almost without the balance's help.
TEST_P(EnergyOfCascades, IsConserved) {
    const float g = GetParam();
    const Fire fire(8, 2.0f, 0.9f, g);
    for (const int level : {0, 1}) {
        ScatteringCosts costs;
        fire.solved(by_cascades(level), costs);
        ASSERT_TRUE(costs.balance);
        ASSERT_TRUE(costs.cascades);
        const BounceBalance& b = *costs.balance;
        std::printf("g %g level %d: collided %.4f x %.4f + escaped %.4f +- %.4f = %.4f\n", g, level, b.collided,
                    b.scale, b.escaped, b.escaped_error, b.sum());
        EXPECT_NEAR(b.sum(), 1.0, kSigmas * b.escaped_error + 0.003);
        EXPECT_NEAR(b.scale, 1.0, 0.02);
    }
}

INSTANTIATE_TEST_SUITE_P(MeanCosines, EnergyOfCascades, ::testing::Values(0.0f, 0.5f));

// Two solvers that share nothing but the lattice and the table of escape: node by node the same light.
TEST(SeriesByCascades, AgreesWithTheHierarchy) {
    for (const float g : {0.0f, 0.5f}) {
        const Fire fire(6, 3.0f, 0.9f, g);
        ScatteringCosts costs, others;
        ScatteringSettings hierarchy;
        hierarchy.lattice_level = 0;
        const ScatteredLight a = fire.solved(by_cascades(), costs).front();
        const ScatteredLight b = fire.solved(hierarchy, others).front();
        EXPECT_FALSE(others.cascades);
        double squares = 0.0, all = 0.0;
        for (std::size_t i = 0; i < a.intensity.size(); ++i) {
            squares += std::pow(a.intensity[i].x - b.intensity[i].x, 2);
            all += std::pow(b.intensity[i].x, 2);
        }
        std::printf("g %g: root mean square difference %.4f\n", g, std::sqrt(squares / all));
        EXPECT_LT(std::sqrt(squares / all), 0.02);
    }
}

TEST(SeriesByCascades, OrdersApartAreTheSum) {
    const Fire fire(8, 2.0f, 0.7f, 0.0f);
    ScatteringCosts costs;
    const dvec3 together = total(fire.solved(by_cascades(1), costs).front().intensity);
    dvec3 apart(0.0);
    ScatteringCosts more;
    const auto orders = fire.solved(by_cascades(1), more, true, true);
    EXPECT_EQ(orders.size(), std::size_t(more.bounces) + 2);  // the first, and the tail
    for (const ScatteredLight& order : orders)
        apart += total(order.intensity);
    EXPECT_NEAR(apart.x / together.x, 1.0, 1e-5);
}

TEST(SeriesByCascades, ThreadsChangeNoBit) {
    const Fire fire(6, 1.0f, 0.6f, 0.5f);
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        ScatteringCosts costs;
        return fire.solved(by_cascades(), costs).front();
    };
    const ScatteredLight one = with(1), many = with(5);
    ASSERT_EQ(one.intensity.size(), many.intensity.size());
    EXPECT_EQ(std::memcmp(one.intensity.data(), many.intensity.data(), one.intensity.size() * sizeof(Rgb)), 0);
    EXPECT_EQ(one.directional, many.directional);
}

}  // namespace
}  // namespace brisance
