// Deep inside uniform smoke every point sees its own temperature, however thick a voxel is.
#include <gtest/gtest.h>

#include "gather_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// A cube of (2 half)^3 nodes, source function 1.
Lit uniform_fire(double depth_of_voxel, int half) {
    Recipe r;
    r.box = cube(-half, half - 1);
    r.world_from_index = cubic(0.1);
    r.density = r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = static_cast<float>(depth_of_voxel / 0.1);
    return Lit(make_medium(r));
}

float at_node(const Lit& lit, const Gathered& g, const ivec3& node) {
    return g.fluence[lit.medium.lattice.find_node(node)];
}

TEST(UniformFire, AbsorbsWhatItEmitsAtAnyThickness) {
    for (const double tau : {0.5, 1.0, 2.0, 5.0, 10.0, 1e2, 1e4, 1e6}) {
        // At least eight mean free paths from the walls.
        const Lit lit = uniform_fire(tau, tau < 1.0 ? 20 : 12);
        const Gathered g = at_all_nodes(lit, lighting(ShadowMethod::Maps));
        for (const ivec3& node : {ivec3(0), ivec3(3, -4, 1), ivec3(-3, 2, 3)})
            EXPECT_NEAR(at_node(lit, g, node) / (4.0 * kPiExact), 1.0, 0.03) << "optical thickness " << tau;
    }
}

TEST(UniformFire, ThinFireIsTransparentToItself) {
    for (const double tau : {1e-6, 1e-4}) {
        const Lit lit = uniform_fire(tau, 12);
        const Gathered clear = at_all_nodes(lit, lighting(ShadowMethod::None));
        std::vector<vec3> points;
        for (const ivec3& node : {ivec3(0), ivec3(3, -4, 1), ivec3(-12, 11, 0)})
            points.push_back(lit.medium.local_of_node(node));
        const std::vector<float> through_smoke = at_points(lit, lighting(ShadowMethod::Maps), points),
                                 through_nothing = at_points(lit, lighting(ShadowMethod::None), points);
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_NEAR(through_smoke[i] / through_nothing[i], 1.0, 30.0 * tau + 2e-4);
        // A cube of side a shines on its centre with 7.674134 j a.
        const double j = tau / 0.1, side = 2.4;
        EXPECT_NEAR(at_node(lit, clear, ivec3(0)) / (7.674134 * j * side), 1.0, 0.03);
    }
}

TEST(UniformFire, TheFaceSeesHalfOfIt) {
    const Lit lit = uniform_fire(1.0, 12);
    const Gathered g = at_all_nodes(lit, lighting(ShadowMethod::Maps));
    // The field ends one node outside: at the last full node a little more than half a sphere is filled.
    const double face = at_node(lit, g, {0, 0, 11}) / (4.0 * kPiExact);
    EXPECT_GT(face, 0.5);
    EXPECT_LT(face, 0.85);
    EXPECT_LT(at_node(lit, g, {0, 0, 12}) / (4.0 * kPiExact), 0.5);
}

TEST(UniformFire, NowhereSeesMoreThanItsTemperature) {
    for (const double tau : {0.1, 1.0}) {
        const Lit lit = uniform_fire(tau, 12);
        const Gathered g = at_all_nodes(lit, lighting(ShadowMethod::Maps));
        for (std::size_t i = 0; i < g.fluence.size() / 3; ++i)
            if (lit.medium.extinction[i] > 0.0f) {
                ASSERT_LT(g.fluence[i] / (4.0 * kPiExact), 1.05) << "optical thickness " << tau;
            }
    }
}

}  // namespace
}  // namespace brisance
