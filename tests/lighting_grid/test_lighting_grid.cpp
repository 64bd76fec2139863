// Every level of the hierarchy is the same fire, seen from farther away.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures/media.h"

namespace brisance {
namespace {

using testing::black_smoke;
using testing::cube;
using testing::Lit;
using testing::make_medium;
using testing::noise;
using testing::Recipe;
using testing::transform;

Recipe sparks(const ivec3& away = ivec3(0)) {
    Recipe r;
    r.box = {ivec3(-20) + away, ivec3(31) + away};
    r.world_from_index = transform(testing::some_linear_map(), {0.0, 0.0, 0.0});
    r.density = [=](const ivec3& n) { return noise(n - away, 1); };
    r.flame = [=](const ivec3& n) { return noise(n - away, 2) > 0.9f ? noise(n - away, 3) : 0.0f; };
    r.settings = black_smoke();
    return r;
}

dvec3 first_moment(const GridLevel& level) {
    dvec3 sum(0.0);
    for (std::size_t i = 0; i < level.size(); ++i)
        sum += double(level.intensity[i].x) * dvec3(level.position[i]);
    return sum;
}

TEST(LightingGrid, EveryLevelCarriesAllLightAndItsFirstMoment) {
    const Lit lit(make_medium(sparks()));
    ASSERT_GE(lit.grid.levels.size(), 3u);
    const double all = total(lit.intensity).x;
    dvec3 moment(0.0);
    for (std::size_t i = 0; i < lit.intensity.size(); ++i)
        moment +=
            double(lit.intensity[i].x) * dvec3(lit.medium.local_of_node(lit.medium.lattice.first_node(i / 512) +
                                                                        BrickLattice::node_in_brick(int(i % 512))));
    for (const GridLevel& level : lit.grid.levels) {
        EXPECT_NEAR(total(level.intensity).x / all, 1.0, 1e-6) << "level " << level.level;
        EXPECT_LT(glm::length(first_moment(level) - moment) / all, 1e-5 * level.spacing) << "level " << level.level;
    }
}

TEST(LightingGrid, EveryLevelCarriesEveryColour) {
    Recipe r = sparks();
    r.colour = [](const ivec3& n) { return Rgb(noise(n, 5), n.x > 3 ? 1.0f : 0.0f, 0.01f); };
    r.settings.colour_role = ColourRole::Emission;
    const Lit lit(make_medium(r));
    const dvec3 all = total(lit.intensity);
    for (const GridLevel& level : lit.grid.levels)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(total(level.intensity)[c] / all[c], 1.0, 1e-6) << "level " << level.level;
}

TEST(LightingGrid, LightsLieWithinTheirVertexsHatAndGrowSparser) {
    const Lit lit(make_medium(sparks()));
    std::size_t before = lit.intensity.size();
    for (const GridLevel& level : lit.grid.levels) {
        EXPECT_LT(level.size(), before);
        before = level.size();
        const float nodes = static_cast<float>(1 << level.level);
        EXPECT_NEAR(level.spacing, lit.medium.spacing * nodes, 1e-6f);
        for (std::size_t i = 0; i < level.size(); ++i) {
            const vec3 at = lit.medium.index_from_local * level.position[i] + vec3(lit.medium.reference_node);
            const vec3 away = glm::abs(at - vec3(level.vertex[i]) * nodes);
            ASSERT_LE(std::max({away.x, away.y, away.z}), nodes * 1.0001f);
        }
    }
}

TEST(LightingGrid, ALightMovesWithTheSmokeExactlyWhenItMovesByTheCoarsestSpacing) {
    const int levels = 4;
    const ivec3 away(16, -32, 48);
    Lit here(make_medium(sparks())), there(make_medium(sparks(away)));
    here.build_grid(levels);
    there.build_grid(levels);
    ASSERT_EQ(here.medium.reference_node, there.medium.reference_node);
    for (int l = 0; l < levels; ++l) {
        const GridLevel &a = here.grid.levels[l], &b = there.grid.levels[l];
        ASSERT_EQ(a.size(), b.size());
        const vec3 moved = here.medium.local_from_index * vec3(away);
        for (std::size_t i = 0; i < a.size(); ++i) {
            ASSERT_EQ(a.vertex[i] + away / (1 << a.level), b.vertex[i]);
            ASSERT_EQ(a.intensity[i], b.intensity[i]);
            ASSERT_LT(glm::length(a.position[i] + moved - b.position[i]), 1e-5f);
        }
    }
}

TEST(LightingGrid, AFramesBoundsPlayNoPart) {
    Recipe wide = sparks();
    wide.box = cube(-16, 56);
    const auto dust = wide.density;
    wide.density = [=](const ivec3& n) {
        return glm::all(glm::lessThan(glm::abs(n), ivec3(16))) ? dust(n) : (n == ivec3(52) ? 1e-3f : 0.0f);
    };
    Recipe tight = wide;
    tight.density = [=](const ivec3& n) { return glm::all(glm::lessThan(glm::abs(n), ivec3(16))) ? dust(n) : 0.0f; };
    wide.flame =
        tight.flame = [](const ivec3& n) { return glm::all(glm::lessThan(glm::abs(n), ivec3(12))) ? 1.0f : 0.0f; };
    Lit a(make_medium(wide)), b(make_medium(tight));
    ASSERT_NE(a.medium.lattice.brick_count(), b.medium.lattice.brick_count());
    a.build_grid(5);
    b.build_grid(5);
    for (int l = 0; l < 5; ++l) {
        ASSERT_EQ(a.grid.levels[l].size(), b.grid.levels[l].size());
        for (std::size_t i = 0; i < a.grid.levels[l].size(); ++i) {
            ASSERT_EQ(a.grid.levels[l].vertex[i], b.grid.levels[l].vertex[i]);
            ASSERT_EQ(a.grid.levels[l].intensity[i], b.grid.levels[l].intensity[i]);
            ASSERT_EQ(a.grid.levels[l].position[i], b.grid.levels[l].position[i]);
        }
    }
}

TEST(LightingGrid, OneLitVoxelIsWhereEveryLevelPutsItsLights) {
    Recipe r = sparks();
    r.density = [](const ivec3&) { return 1.0f; };
    for (const ivec3& node : {ivec3(0), ivec3(5, -3, 7), ivec3(16)}) {
        const auto lit = testing::single_light(make_medium(r), node);
        for (const GridLevel& level : lit->grid.levels) {
            EXPECT_NEAR(total(level.intensity).x, 1.0, 1e-6);
            for (std::size_t i = 0; i < level.size(); ++i) {
                ASSERT_LT(glm::length(level.position[i] - lit->medium.local_of_node(node)), 2e-6f * level.spacing);
            }
        }
    }
}

TEST(LightingGrid, WithWeightsOfItsOwnPositionsIgnoreIntensities) {
    Lit lit(make_medium(sparks()));
    std::vector<float> weight(lit.intensity.size());
    for (std::size_t i = 0; i < weight.size(); ++i)
        weight[i] = luminance(lit.intensity[i]) > 0.0f ? 1.0f : 0.0f;
    std::vector<Rgb> other = lit.intensity;
    for (std::size_t i = 0; i < other.size(); ++i)
        other[i] *= float(i % 7);
    const LightingGrid a = build_lighting_grid(lit.medium, lit.intensity, &weight, 3);
    const LightingGrid b = build_lighting_grid(lit.medium, other, &weight, 3);
    for (int l = 0; l < 3; ++l) {
        EXPECT_EQ(a.levels[l].position, b.levels[l].position);
        EXPECT_NE(a.levels[l].intensity, b.levels[l].intensity);
        EXPECT_NEAR(total(b.levels[l].intensity).x / total(other).x, 1.0, 1e-6);
    }
}

}  // namespace
}  // namespace brisance
