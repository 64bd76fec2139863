// One point light: adjacent levels of the hierarchy share it, and none of it is lost or counted twice.
#include <gtest/gtest.h>

#include "gather_fixture.h"

namespace brisance {
namespace {

using namespace testing;

std::unique_ptr<Lit> lamp(const dmat4& world_from_index = cubic(0.1), float extinction = 0.0f) {
    Recipe r;
    r.box = cube(-56, 56);
    r.world_from_index = world_from_index;
    r.density = [](const ivec3& n) { return glm::all(glm::lessThan(glm::abs(n), ivec3(52))) ? 1.0f : 0.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = std::max(extinction, 1e-30f);
    return single_light(make_medium(r), ivec3(3, -2, 5));
}

TEST(OneLight, FallsOffWithTheSquareOfDistanceThroughAllLevels) {
    const auto lit = lamp();
    ASSERT_GE(lit->grid.levels.size(), 4u);
    const vec3 light = lit->medium.local_of_node({3, -2, 5});
    const float h = lit->medium.spacing;
    const double a = std::cbrt(3.0 / (4.0 * kPiExact)) * h;
    for (const float alpha : {1.0f, 1.5f, 2.0f, 3.0f}) {
        std::vector<vec3> points;
        std::vector<double> distance;
        for (int i = 0; i < 640; ++i) {
            distance.push_back(2.0 * h * std::pow(500.0, i / 639.0));
            points.push_back(light +
                             float(distance.back()) * glm::normalize(vec3(0.3f + std::sin(i), 0.2f, std::cos(i))));
        }
        const std::vector<float> fluence = at_points(*lit, lighting(ShadowMethod::None, alpha), points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double d = glm::length(dvec3(points[i]) - dvec3(light));
            const double ratio = fluence[i] * d * d;
            // Level 0 is a ball of the voxel's volume: 1 + a^2 / (5 d^2) + ... of the point light's.
            const double ball = d < 2.0 * alpha * h ? 0.25 * a * a / (d * d) : 0.0;
            ASSERT_GT(ratio, 1.0 - 2e-5) << d / h << " spacings, alpha " << alpha;
            ASSERT_LT(ratio, 1.0 + 2e-5 + ball) << d / h << " spacings, alpha " << alpha;
        }
    }
}

TEST(OneLight, LightsAllOtherNodesAsAPointDoes) {
    const auto lit = lamp(transform(some_linear_map(), dvec3(0.0)));
    for (const float alpha : {1.0f, 2.0f}) {
        const Gathered gathered = at_all_nodes(*lit, lighting(ShadowMethod::None, alpha));
        const vec3 light = lit->medium.local_of_node({3, -2, 5});
        for (std::size_t i = 0; i < lit->medium.lattice.node_count(); ++i) {
            const double d = glm::length(dvec3(lit->medium.local_of_node(node_at(lit->medium, i))) - dvec3(light));
            if (d > 0.0) {
                ASSERT_NEAR(gathered.fluence[i] * d * d, 1.0, 5e-5);
            }
        }
    }
}

TEST(OneLight, NearItsVoxelIsABallNotAPoint) {
    const auto lit = lamp();
    const vec3 light = lit->medium.local_of_node({3, -2, 5});
    const double a = std::cbrt(3.0 / (4.0 * kPiExact)) * lit->medium.spacing;
    std::vector<vec3> points;
    std::vector<double> expected;
    for (const double t : {0.0, 0.02, 0.3, 0.9, 0.99999, 1.0, 1.00001, 1.1, 2.0, 3.0}) {
        points.push_back(light + vec3(float(t * a), 0.0f, 0.0f));
        const double log = std::abs(t - 1.0) < 1e-3 ? 0.0 : (1.0 - t * t) * std::log(std::abs((1.0 + t) / (1.0 - t)));
        expected.push_back((t == 0.0 ? 3.0 : 0.75 * (2.0 + log / t)) / (a * a));
    }
    const std::vector<float> fluence = at_points(*lit, lighting(ShadowMethod::None), points);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(fluence[i] / expected[i], 1.0, 2e-3) << "point " << i;
}

TEST(OneLight, InUniformSmokeIsDimmedByBeersLawAtEveryDistance) {
    const auto lit = lamp(cubic(0.1), 0.5f);
    const vec3 light = lit->medium.local_of_node({3, -2, 5});
    std::vector<vec3> points;
    for (int i = 0; i < 320; ++i) {
        const float d = 0.3f * std::pow(14.0f, float(i) / 319.0f);  // to 4.2 m, inside the smoke
        points.push_back(light + d * glm::normalize(vec3(0.3f + std::sin(i), 0.2f, std::cos(i))));
    }
    for (const ShadowMethod method : {ShadowMethod::Exact, ShadowMethod::Maps}) {
        const std::vector<float> fluence = at_points(*lit, lighting(method), points);
        // Maps are linear between their distances where the exponential is convex: up to two percent too bright.
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double d = glm::length(dvec3(points[i]) - dvec3(light));
            ASSERT_NEAR(fluence[i] * d * d / std::exp(-0.5 * d), 1.0, 0.03) << d << " m";
        }
    }
}

TEST(OneLight, TwoLightsAddUp) {
    const auto first = lamp(), both = lamp();
    const ivec3 other(-20, 7, 1);
    both->intensity[both->medium.lattice.find_node(other)] = Rgb(5.0f);
    both->build_grid(0);
    const auto second = single_light(first->medium, other);
    const LightingSettings settings = lighting(ShadowMethod::None);
    const Gathered a = at_all_nodes(*first, settings), b = at_all_nodes(*second, settings),
                   sum = at_all_nodes(*both, settings);
    double error = 0.0, total = 0.0;
    for (std::size_t i = 0; i < sum.fluence.size() / 3; ++i) {
        // Centres of coarse lights lie between the two: equal only on the whole.
        error += sum.fluence[i] - (a.fluence[i] + 5.0 * b.fluence[i]);
        total += sum.fluence[i];
    }
    EXPECT_NEAR(error / total, 0.0, 0.01);
}

}  // namespace
}  // namespace brisance
