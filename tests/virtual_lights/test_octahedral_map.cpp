// The octahedral map from the square to the hemisphere.
#include "virtual_lights/octahedral_map.h"

#include <gtest/gtest.h>

#include "room.h"

namespace brisance {
namespace {

using namespace testing;

TEST(HemisphereMap, ThereAndBack) {
    Rng rng(Stream::Path, 2);
    for (int i = 0; i < 10000; ++i) {
        const double u = rng.next_double(), v = rng.next_double();
        const dvec3 d = hemisphere_of_square(u, v);
        EXPECT_NEAR(glm::length(d), 1.0, 1e-12);
        EXPECT_GE(d.z, 0.0);
        const glm::dvec2 back = square_of_hemisphere(d);
        EXPECT_NEAR(back.x, u, 1e-7);
        EXPECT_NEAR(back.y, v, 1e-7);
    }
}

// Texels are equal solid angles: the cosine's mean over the hemisphere is 1/2, that of its square 1/3.
TEST(HemisphereMap, KeepsAreas) {
    double first = 0.0, second = 0.0;
    constexpr int kSide = 256;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double z = hemisphere_of_square((x + 0.5) / kSide, (y + 0.5) / kSide).z;
            first += z / (kSide * kSide);
            second += z * z / (kSide * kSide);
        }
    EXPECT_NEAR(first, 0.5, 1e-4);
    EXPECT_NEAR(second, 1.0 / 3.0, 1e-4);
}

TEST(HemisphereMap, TexelsCoverTheEdge) {
    for (const dvec3& d : {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 1, 0), dvec3(0, -1, 0), dvec3(0, 0, 1),
                           dvec3(0, 0, -1), glm::normalize(dvec3(1, 1, -0.1))})
        EXPECT_LT(texel_of(d, 16), 256u);
}

}  // namespace
}  // namespace brisance
