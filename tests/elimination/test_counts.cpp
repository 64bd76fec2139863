// The number of survivors, and their identity.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "point_fixture.h"

namespace brisance {
namespace {

using testing::adaptive;
using testing::uniform;

TEST(Counts, AreExact) {
    const std::vector<vec3> points = testing::square(20'000, 1);
    for (const std::size_t target : {0, 1, 2, 17, 500, 7'000, 19'999, 20'000, 30'000})
        for (const EliminationSettings& settings : {adaptive(), uniform(1.0)}) {
            const Survivors survivors = eliminate(points, target, settings);
            EXPECT_EQ(survivors.index.size(), std::min(target, points.size()));
            EXPECT_EQ(survivors.distance.size(), survivors.index.size());
        }
}

TEST(Counts, SurvivorsAreDifferentPointsInAscendingOrder) {
    const std::vector<vec3> points = testing::sphere(20'000, 2);
    const Survivors survivors = eliminate(points, 3'000, adaptive());
    EXPECT_TRUE(std::is_sorted(survivors.index.begin(), survivors.index.end(), std::less_equal<>()));
    EXPECT_LT(survivors.index.back(), points.size());
}

TEST(Counts, UniformDistanceIsThatOfTheClosestPacking) {
    const std::vector<vec3> points = testing::cube(5'000, 3);
    for (const float d : eliminate(points, 1'000, uniform(1.0)).distance)
        EXPECT_FLOAT_EQ(d, float(2.0 * std::sqrt(1.0 / (2.0 * std::sqrt(3.0) * 1000.0))));
    for (const float d : eliminate(points, 1'000, uniform(1.0, 3)).distance)
        EXPECT_FLOAT_EQ(d, float(2.0 * std::cbrt(1.0 / (4.0 * std::sqrt(2.0) * 1000.0))));
}

// A_i = (N_in / N_out) pi r_k^2 / k, with r_k found by trying all others.
TEST(Counts, AdaptiveDistanceIsThatOfTheKthNearest) {
    const std::vector<vec3> points = testing::torus(3'000, 4);
    for (const int k : {1, 7, 128, 2'500}) {
        EliminationSettings settings = adaptive();
        settings.neighbours = k;
        const Survivors survivors = eliminate(points, 600, settings);
        for (std::size_t n = 0; n < survivors.index.size(); n += 7) {
            std::vector<double> distances;
            for (const vec3& p : points)
                distances.push_back(glm::distance(dvec3(p), dvec3(points[survivors.index[n]])));
            std::nth_element(distances.begin(), distances.begin() + k, distances.end());
            const double area = 5.0 * 3.141592653589793 * distances[k] * distances[k] / k;
            EXPECT_NEAR(survivors.distance[n], 2.0 * std::sqrt(area / (2.0 * std::sqrt(3.0))), 2e-6) << k;
        }
    }
}

}  // namespace
}  // namespace brisance
