// What the picture shows of the nodes of coarser lattices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures/media.h"
#include "medium_lighting/lit_lattice.h"

namespace brisance {
namespace {

using namespace testing;

// A homogeneous cube whose source function is the same everywhere.
Medium cube_of_smoke(float extinction) {
    Recipe r;
    r.box = {ivec3(-24), ivec3(24)};
    r.world_from_index = cubic(0.05);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = Rgb(0.5f);
    return make_medium(r);
}

// Of a source function S, a line of optical depth d through the cube shows S (1 - e^-d), whichever node it is that the
// line goes through.
TEST(LitLevels, LinesThroughNodesSeeTheSourceFunction) {
    constexpr float kSource = 3.0f;
    const Medium medium = cube_of_smoke(1.5f);
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const vec3 eye(0.0f, -50.0f, 0.0f);
    const std::vector<LitLevel> levels = make_lit_levels(pyramid, nodes_beside_extinction(medium), {}, {eye, 1e-3f}, 1);
    ASSERT_EQ(levels.size(), 1u);
    const LitLevel& level = levels.front();
    const std::vector<float> radiance =
        radiance_through_nodes(level, std::vector<float>(level.needed.size(), kSource), eye);
    const float expected = kSource * -std::expm1(-1.5f * 49.0f * 0.05f);
    int inside = 0;
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        const ivec3 node = level.medium.lattice.node(i);
        if (!level.needed[i] || std::abs(node.x) > 8 || std::abs(node.z) > 8)
            continue;
        EXPECT_NEAR(radiance[i] / expected, 1.0f, 0.03f) << node.x << " " << node.y << " " << node.z;
        ++inside;
    }
    EXPECT_GT(inside, 1000);
}

// Emission shows as scattered light does: a cube that emits j has the source function j over extinction.
TEST(LitLevels, LinesSeeTheMediumsEmission) {
    Medium medium = cube_of_smoke(1.5f);
    medium.emission.assign(medium.extinction.size(), Rgb(0.0f));
    for (std::size_t i = 0; i < medium.emission.size(); ++i)
        medium.emission[i] = Rgb(2.0f * medium.extinction[i]);
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const vec3 eye(0.0f, 0.0f, 30.0f);
    const LitLevel level =
        std::move(make_lit_levels(pyramid, nodes_beside_extinction(medium), {}, {eye, 1e-3f}, 1).front());
    const std::vector<float> radiance =
        radiance_through_nodes(level, std::vector<float>(level.needed.size(), 0.0f), eye);
    const std::int64_t middle = level.medium.lattice.find_node(level.medium.reference_node);
    ASSERT_GE(middle, 0);
    EXPECT_NEAR(radiance[std::size_t(middle)] / (2.0f * -std::expm1(-1.5f * 49.0f * 0.05f)), 1.0f, 0.03f);
}

// Where other light replaces all of it, light at the nodes does not change the picture; where it leaves some at one
// node, the coarser nodes around count in full.
TEST(LitLevels, NodesWhoseLightIsReplacedDoNotCount) {
    const Medium medium = cube_of_smoke(1.5f);
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const vec3 eye(0.0f, -50.0f, 0.0f);
    const std::vector<std::uint8_t> needed = nodes_beside_extinction(medium);
    std::vector<float> kept(needed.size(), 0.0f);
    const ivec3 one = medium.reference_node + ivec3(4, -20, 6);
    kept[std::size_t(medium.lattice.find_node(one))] = 1.0f;
    const auto all = make_lit_levels(pyramid, needed, {}, {eye, 1e-3f}, 3);
    const auto some = make_lit_levels(pyramid, needed, kept, {eye, 1e-3f}, 3);
    for (std::size_t l = 0; l < all.size(); ++l) {
        const int counted = int(std::count_if(some[l].importance.begin(), some[l].importance.end(),
                                              [](float importance) { return importance > 0.0f; }));
        EXPECT_GE(counted, 1) << l;
        EXPECT_LE(counted, 8) << l;
        for (std::size_t i = 0; i < some[l].importance.size(); ++i)
            if (some[l].importance[i] > 0.0f) {
                EXPECT_EQ(some[l].importance[i], all[l].importance[i]) << l;
            }
    }
}

}  // namespace
}  // namespace brisance
