// Optical depths from one point to sixteen others, against the sum along each segment.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "fixtures/media.h"
#include "optical_depths/point_depths.h"

namespace brisance {
namespace {

using namespace testing;

Medium ball_of_smoke(float extinction) {
    Recipe recipe;
    recipe.box = cube(-20, 20);
    recipe.world_from_index = cubic(0.1);
    recipe.density = [](const ivec3& n) { return float(std::exp(-glm::dot(dvec3(n), dvec3(n)) / 100.0)); };
    recipe.settings = black_smoke();
    recipe.settings.smoke.extinction_per_metre = extinction;
    return make_medium(recipe);
}

std::array<vec3, PointDepths::kRays> around(const vec3& from, float distance) {
    std::array<vec3, PointDepths::kRays> to;
    for (int k = 0; k < PointDepths::kRays; ++k) {
        const float z = 1.0f - (2.0f * float(k) + 1.0f) / PointDepths::kRays, r = std::sqrt(1.0f - z * z);
        to[k] = from + distance * vec3(r * std::cos(2.4f * float(k)), r * std::sin(2.4f * float(k)), z);
    }
    return to;
}

// Points inside and outside; segments that end inside, just outside, and far away.
TEST(PointDepths, AreThoseOfTheSegments) {
    const Medium medium = ball_of_smoke(3.0f);
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const PointDepths depths(pyramid, 0);
    for (const vec3 from : {vec3(0.0f), vec3(0.7f, -0.4f, 0.2f), vec3(4.0f, 1.0f, 0.0f)})
        for (const float distance : {0.5f, 3.0f, 100.0f}) {
            const auto to = around(from, distance);
            std::array<float, PointDepths::kRays> depth;
            depths.between(from, to.data(), depth.data());
            for (int k = 0; k < PointDepths::kRays; ++k)
                EXPECT_NEAR(depth[k], pyramid.optical_depth(from, to[k]), 0.03f) << distance << " " << k;
        }
}

TEST(PointDepths, OfOpaqueSmokeStopNothingShort) {
    const Medium medium = ball_of_smoke(300.0f);
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const PointDepths depths(pyramid, 0);
    const vec3 from(0.1f, 0.2f, 0.0f);
    const auto to = around(from, 50.0f);
    std::array<float, PointDepths::kRays> depth;
    depths.between(from, to.data(), depth.data());
    for (const float d : depth)
        EXPECT_GE(d, PointDepths::kOpaque);
}

}  // namespace
}  // namespace brisance
