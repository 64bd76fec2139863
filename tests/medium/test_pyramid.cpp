// Coarser averages of the extinction hold as much smoke as the field itself.
#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"
#include "fixtures/media.h"

namespace brisance {
namespace {

using testing::black_smoke;
using testing::cube;
using testing::cubic;
using testing::make_medium;
using testing::noise;
using testing::Recipe;

Recipe speckle() {
    Recipe r;
    r.box = cube(-21, 33);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3& n) { return noise(n, 3) > 0.8f ? 5.0f * noise(n, 4) : 0.0f; };
    r.settings = black_smoke();
    return r;
}

double sum(const std::vector<float>& values) {
    double total = 0.0;
    for (const float v : values)
        total += v;
    return total;
}

TEST(Pyramid, EveryLevelHoldsTheSameSmoke) {
    const Medium medium = make_medium(speckle());
    const ExtinctionPyramid pyramid(medium, 6);
    ASSERT_GE(pyramid.level_count(), 4);
    for (int l = 1; l < pyramid.level_count(); ++l)
        EXPECT_NEAR(sum(pyramid.nodes(l)) * std::pow(8.0, l) / sum(pyramid.nodes(0)), 1.0, 1e-6) << "level " << l;
}

TEST(Pyramid, EveryLevelHasTheSmokeInTheSamePlace) {
    const Medium medium = make_medium(speckle());
    const ExtinctionPyramid pyramid(medium, 6);
    dvec3 centre[ExtinctionPyramid::kMaxLevels];
    for (int l = 0; l < pyramid.level_count(); ++l) {
        dvec3 moment(0.0);
        const BrickLattice& lattice = pyramid.lattice(l);
        for (std::size_t i = 0; i < lattice.node_count(); ++i)
            moment += double(pyramid.nodes(l)[i]) * double(1 << l) *
                      dvec3(lattice.first_node(i / 512) + BrickLattice::node_in_brick(int(i % 512)));
        centre[l] = moment / sum(pyramid.nodes(l));
        EXPECT_LT(glm::length(centre[l] - centre[0]), 1e-4) << "level " << l;
    }
}

TEST(Pyramid, AUniformBlockStaysUniformInside) {
    Recipe r = speckle();
    r.box = cube(0, 63);
    r.density = [](const ivec3&) { return 2.0f; };
    const Medium medium = make_medium(r);
    const ExtinctionPyramid pyramid(medium, 4);
    for (int l = 0; l < pyramid.level_count(); ++l) {
        const int size = 64 >> l;
        for (int k = 1; k + 1 < size; ++k)
            EXPECT_EQ(pyramid.nodes(l)[pyramid.lattice(l).find_node(ivec3(k))], 2.0f);
    }
}

TEST(Pyramid, OpticalDepthOfALinearRampIsItsIntegral) {
    Recipe r = speckle();
    r.box = cube(0, 31);
    r.density = [](const ivec3& n) { return static_cast<float>(n.x); };
    const Medium medium = make_medium(r);
    const ExtinctionPyramid pyramid(medium, 1);
    const vec3 from = medium.local_of_node({2, 3, 4}), to = medium.local_of_node({30, 20, 11});
    EXPECT_NEAR(pyramid.optical_depth(from, to), 16.0 * glm::length(to - from), 1e-3);
}

TEST(Pyramid, EmptySpaceHasNoExtinctionAnywhere) {
    const Medium medium = make_medium(speckle());
    const ExtinctionPyramid pyramid(medium, 3);
    for (const ivec3& n : {ivec3(100), ivec3(-5000, 0, 0), ivec3(0, 35, 0), ivec3(0, 0, -23)})
        EXPECT_EQ(pyramid.extinction_at(medium.local_of_node(n)), 0.0f);
}

TEST(Pyramid, TheNumberOfLevelsIsBoundedByTheExtent) {
    Recipe small;
    small.box = cube(1, 5);
    small.density = [](const ivec3&) { return 1.0f; };
    const Medium one_brick = make_medium(small);
    EXPECT_EQ(ExtinctionPyramid(one_brick, 6).level_count(), 1);
    const Medium medium = make_medium(speckle());
    EXPECT_EQ(ExtinctionPyramid(medium, 2).level_count(), 2);
    EXPECT_LE(ExtinctionPyramid(medium, 100).level_count(), ExtinctionPyramid::kMaxLevels);
}

}  // namespace
}  // namespace brisance
