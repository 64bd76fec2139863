// Directions of the cascades cover the sphere evenly, and each divides into four around it.
#include <gtest/gtest.h>

#include <cmath>

#include "radiance_cascades/cascade_directions.h"

namespace brisance {
namespace {

constexpr float kPiFloat = 3.14159265f;

TEST(CascadeDirections, HalfOfTheSquareIsHalfOfTheSphere) {
    constexpr int kSide = 400;
    int above = 0, octant = 0;
    for (int k = 0; k < kSide * kSide; ++k) {
        const vec3 d =
            equal_area_direction((k / kSide + 0.5) * 2.0 / kSide - 1.0, (k % kSide + 0.5) * 2.0 / kSide - 1.0);
        ASSERT_NEAR(glm::length(d), 1.0f, 1e-5f);
        above += d.z > 0.5f;  // a quarter of the sphere
        octant += d.x > 0.0f && d.y > 0.0f && d.z > 0.0f;
    }
    EXPECT_NEAR(above / double(kSide * kSide), 0.25, 1e-3);
    EXPECT_NEAR(octant / double(kSide * kSide), 0.125, 1e-3);
}

TEST(CascadeDirections, FourDirectionsDivideEach) {
    const CascadeDirections directions(4, {true, true, false});
    EXPECT_EQ(directions.count(0), 16);
    EXPECT_EQ(directions.count(1), 64);
    EXPECT_EQ(directions.count(2), 256);
    EXPECT_EQ(directions.count(3), 256);
    EXPECT_EQ(directions.children(2), 1);
    for (int i = 0; i < 2; ++i)
        for (int d = 0; d < directions.count(i); ++d) {
            vec3 sum(0.0f);
            for (int k = 0; k < 4; ++k)
                sum += directions.of(i + 1)[4 * d + k];
            EXPECT_GT(glm::dot(glm::normalize(sum), directions.of(i)[d]), std::cos(0.2f / float(1 << i)));
        }
}

TEST(CascadeDirections, EvenLightHasNoMomentsAndTheOthersHaveOne) {
    for (const int side : {2, 4, 8}) {
        const CascadeDirections directions(side, {});
        const float solid_angle = 4.0f * kPiFloat / float(directions.count(0));
        for (int m = 0; m < kShMoments; ++m) {
            float even = 0.0f, own = 0.0f;
            for (int d = 0; d < directions.count(0); ++d) {
                even += solid_angle * directions.moment_basis(d)[m];
                own += solid_angle * directions.moment_basis(d)[m] * directions.mean_basis(d)[m];
            }
            EXPECT_NEAR(even, 0.0f, 2e-3f) << "side " << side << ", moment " << m;
            if (own != 0.0f) {
                EXPECT_NEAR(own, 1.0f, 1e-4f) << "side " << side << ", moment " << m;
            }
        }
    }
}

}  // namespace
}  // namespace brisance
