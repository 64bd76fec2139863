// The lights of homogeneous haze represent all its nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures/media.h"
#include "lighting_grid/voxel_lights.h"
#include "thin_media/thin_medium_lights.h"

namespace brisance {
namespace {

using namespace testing;

Medium haze(float extinction) {
    Recipe recipe;
    recipe.box = cube(-32, 32);
    recipe.world_from_index = cubic(0.05);
    recipe.density = [](const ivec3&) { return 1.0f; };
    recipe.settings = black_smoke();
    recipe.settings.smoke.extinction_per_metre = extinction;
    return make_medium(recipe);
}

// Brighter to one side, and in a beam.
HierarchyLights lit_haze(const Medium& medium) {
    std::vector<Rgb> source(medium.lattice.node_count());
    for (std::size_t i = 0; i < source.size(); ++i) {
        const vec3 p = medium.local_of_node(medium.lattice.first_node(i / BrickLattice::kNodes) +
                                            BrickLattice::node_in_brick(int(i % BrickLattice::kNodes)));
        source[i] = Rgb(1.0f + 0.3f * p.x + (std::hypot(p.y, p.z) < 0.4f ? 3.0f : 0.0f));
    }
    return build_hierarchy(medium, {project_extinction_times(medium, source), {}}, 0);
}

std::vector<std::uint32_t> all_bricks(const Medium& medium) {
    std::vector<std::uint32_t> bricks(medium.lattice.brick_count());
    for (std::size_t b = 0; b < bricks.size(); ++b)
        bricks[b] = std::uint32_t(b);
    return bricks;
}

Receivers points() {
    Receivers receivers;
    for (int k = 0; k < 64; ++k) {
        const auto at = [&](int salt) { return 2.6f * (noise(ivec3(k, 0, 0), salt) - 0.5f); };
        receivers.add_block({vec3(at(1), at(2), at(3))}, {});
    }
    return receivers;
}

std::vector<float> fluence(const LightField& field, const GridLevel& bottom) {
    std::vector<LevelCost> costs;
    Progress silent;
    const Receivers receivers = points();
    const Gathered g = gather_at_points(field, bottom, receivers, 0.0f, costs, silent);
    std::vector<float> out;
    for (std::size_t i = 0; i < receivers.size(); i += Receivers::kGroup)
        out.push_back(g.fluence[i]);
    return out;
}

TEST(ThinMediumLights, StandForAllNodes) {
    const Medium medium = haze(0.1f);
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const LightingSettings settings;
    HierarchyLights lights = lit_haze(medium);
    const LightField of_all = lights.field(pyramid, 1.5f, settings, nullptr);
    const std::vector<float> truth = fluence(of_all, bottom_level(of_all));

    const auto taken = take_thin_medium_lights(medium, all_bricks(medium), lights);
    ASSERT_TRUE(taken);
    EXPECT_EQ(luminance(Rgb(total(lights.light.intensity))), 0.0f);
    LightField field = taken->lights.field(pyramid, 1.5f, settings, nullptr);
    field.bottom = kFinestThinLights;
    const std::vector<float> few = fluence(field, {});
    double error = 0.0, sum = 0.0, square = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        error += (few[i] - truth[i]) * (few[i] - truth[i]);
        square += truth[i] * truth[i];
        sum += (few[i] - truth[i]) / truth[i] / double(truth.size());
    }
    std::printf("error %.2f %%, mean %+.2f %%\n", 100.0 * std::sqrt(error / square), 100.0 * sum);
    EXPECT_LT(std::sqrt(error / square), 0.02);
    EXPECT_LT(std::abs(sum), 0.005);
}

TEST(ThinMediumLights, AreGivenBack) {
    const Medium medium = haze(0.1f);
    HierarchyLights lights = lit_haze(medium);
    const std::vector<Rgb> before = lights.light.intensity;
    std::vector<std::uint32_t> bricks = all_bricks(medium);
    bricks.resize(bricks.size() / 2);
    const auto taken = take_thin_medium_lights(medium, bricks, lights);
    ASSERT_TRUE(taken);
    EXPECT_NE(lights.light.intensity, before);
    give_back(*taken, lights.light);
    EXPECT_EQ(lights.light.intensity, before);
}

TEST(ThinMediumLights, AreNoneOfDenseSmoke) {
    const Medium medium = haze(10.0f);
    HierarchyLights lights = lit_haze(medium);
    const std::vector<Rgb> before = lights.light.intensity;
    std::vector<std::uint32_t> dense = all_bricks(medium);
    std::erase_if(dense,
                  [&](std::uint32_t b) { return medium.extinction[b * std::size_t(BrickLattice::kNodes)] == 0.0f; });
    ASSERT_FALSE(dense.empty());
    EXPECT_FALSE(take_thin_medium_lights(medium, dense, lights));
    EXPECT_EQ(lights.light.intensity, before);
}

// One dense brick does not keep the others' light from having lights of its own.
TEST(ThinMediumLights, AreOfTheThinBricksAlone) {
    Recipe recipe;
    recipe.box = cube(-32, 32);
    recipe.world_from_index = cubic(0.05);
    recipe.density = [](const ivec3& n) { return glm::all(glm::lessThan(glm::abs(n - 12), ivec3(3))) ? 100.0f : 1.0f; };
    recipe.settings = black_smoke();
    recipe.settings.smoke.extinction_per_metre = 0.1f;
    const Medium medium = make_medium(recipe);
    HierarchyLights lights = lit_haze(medium);
    const auto taken = take_thin_medium_lights(medium, all_bricks(medium), lights);
    ASSERT_TRUE(taken);
    EXPECT_EQ(taken->bricks.size() + 1, medium.lattice.brick_count());
    for (std::size_t i = 0; i < lights.light.intensity.size(); ++i)
        if (medium.lattice.first_node(i / BrickLattice::kNodes) != medium.reference_node + 8) {
            ASSERT_EQ(lights.light.intensity[i], Rgb(0.0f)) << i;
        }
}

}  // namespace
}  // namespace brisance
