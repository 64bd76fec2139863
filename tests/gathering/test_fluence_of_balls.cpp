// Fluence of a uniformly emitting ball, inside and outside, against its closed form and tables.
#include <gtest/gtest.h>

#include <algorithm>

#include "gather_fixture.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kNodes = 12;  // per radius of one metre

// Without extinction: 2 pi R + pi (R^2 - r^2) / r ln |(R + r) / (R - r)|, j = R = 1.
double transparent_ball(double r) {
    if (r < 1e-9)
        return 4.0 * kPiExact;
    const double log = std::abs(r - 1.0) < 1e-9 ? 0.0 : (1.0 - r * r) / r * std::log(std::abs((1.0 + r) / (1.0 - r)));
    return 2.0 * kPiExact + kPiExact * log;
}

const Lit& transparent() {
    static const Lit lit([] {
        Recipe r = glowing_ball(kNodes, 1.0f);
        r.density = nullptr;
        r.flame = [](const ivec3& n) { return ball(n, dvec3(0.0), kNodes); };
        r.settings.fire.convention = EmissionConvention::Direct;
        return make_medium(r);
    }());
    return lit;
}

TEST(FluenceOfBalls, ClosedFormAgreesWithThePublishedTable) {
    EXPECT_NEAR(transparent_ball(0.0), 12.566371, 1e-6);
    EXPECT_NEAR(transparent_ball(0.5), 11.460274, 1e-6);
    EXPECT_NEAR(transparent_ball(2.0), 1.106097, 1e-6);
}

TEST(FluenceOfBalls, WithoutExtinctionNodesInsideMatchTheClosedForm) {
    const Lit& lit = transparent();
    for (const float alpha : {1.0f, 2.0f}) {
        const Gathered g = at_all_nodes(lit, lighting(ShadowMethod::None, alpha));
        double sum = 0.0, worst = 0.0;
        int count = 0;
        for (std::size_t i = 0; i < lit.medium.lattice.node_count(); ++i) {
            const double r = glm::length(dvec3(lit.medium.local_of_node(node_at(lit.medium, i))));
            if (r > 0.9)
                continue;
            const double error = g.fluence[i] / transparent_ball(r) - 1.0;
            sum += error;
            worst = std::max(worst, std::abs(error));
            ++count;
        }
        EXPECT_LT(std::abs(sum / count), alpha < 1.5f ? 0.06 : 0.01) << "alpha " << alpha;
        EXPECT_LT(worst, alpha < 1.5f ? 0.15 : 0.03) << "alpha " << alpha;
    }
}

TEST(FluenceOfBalls, WithoutExtinctionPointsEverywhereMatchTheClosedForm) {
    std::vector<vec3> points;
    std::vector<double> radius;
    for (const double r : {0.0, 0.25, 0.5, 0.75, 0.9, 1.25, 1.5, 2.0, 4.0, 10.0, 300.0})
        for (int k = 0; k < 16; ++k) {
            const vec3 w = glm::normalize(vec3(noise(ivec3(k), 1), noise(ivec3(k), 2), noise(ivec3(k), 3)) - 0.5f);
            points.push_back(float(r) * w);
            radius.push_back(r);
        }
    const std::vector<float> fluence = at_points(transparent(), lighting(ShadowMethod::None), points);
    for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_NEAR(fluence[i] / transparent_ball(radius[i]), 1.0, 0.06) << "r = " << radius[i];
}

// A ball of one optical radius, absorbing what it emits: table of the adding-doubling reference, R = 1.
TEST(FluenceOfBalls, WithAbsorptionMatchesTheTable) {
    struct Case {
        float extinction;  // times one metre: the optical radius
        double expected[5];
    };
    constexpr double at[5] = {0.0, 0.25, 0.5, 0.75, 0.9};
    // j = 1, sigma = 1, radius R; in units of the ball of one metre the fluence scales with 1 / R.
    for (const Case& c : {Case{0.5f, {4.94448, 4.84356, 4.51819, 3.87148, 3.19092}},
                          Case{1.0f, {7.94346, 7.79574, 7.30850, 6.29151, 5.15282}},
                          Case{2.0f, {10.86570, 10.71848, 10.20095, 8.97095, 7.36963}},
                          Case{5.0f, {12.48170, 12.44680, 12.27751, 11.56789, 9.97660}}}) {
        const Lit lit(make_medium(glowing_ball(kNodes, c.extinction)));
        const auto octant = [&](const ivec3& n) { return std::min({n.x, n.y, n.z}) >= 0; };
        for (const ShadowMethod method : {ShadowMethod::Exact, ShadowMethod::Maps}) {
            const Gathered g = at_nodes(lit, lighting(method), octant);
            for (int k = 0; k < 5; ++k) {
                double sum = 0.0;
                int count = 0;
                for (std::size_t i = 0; i < lit.medium.lattice.node_count(); ++i) {
                    const double r = glm::length(dvec3(lit.medium.local_of_node(node_at(lit.medium, i))));
                    if (octant(node_at(lit.medium, i)) && std::abs(r - at[k]) < 0.5 / kNodes) {
                        sum += g.fluence[i];
                        ++count;
                    }
                }
                ASSERT_GT(count, 0);
                // Emission is extinction * 1: fluence over j of the table is the same number at sigma = 1.
                EXPECT_NEAR(sum / count / c.expected[k], 1.0, 0.03)
                    << "optical radius " << c.extinction << ", r = " << at[k] << ", maps "
                    << (method == ShadowMethod::Maps);
            }
        }
    }
}

}  // namespace
}  // namespace brisance
