// One grid becomes a medium: same field, same position in the world.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
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
using testing::transform;

dvec3 random_point(Rng& rng, double low, double high) {
    const double x = rng.next(), y = rng.next(), z = rng.next();
    return dvec3(low) + (high - low) * dvec3(x, y, z);
}

float linear_density(const ivec3& n) {
    return 3.0f + 0.1f * n.x - 0.05f * n.y + 0.02f * n.z;
}

double linear_density(const dvec3& p) {
    return 3.0 + 0.1 * p.x - 0.05 * p.y + 0.02 * p.z;
}

Recipe linear_smoke(const dmat4& world_from_index) {
    Recipe r;
    r.box = cube(-9, 14);
    r.world_from_index = world_from_index;
    r.density = [](const ivec3& n) { return linear_density(n); };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = 2.0f;
    return r;
}

float extinction_at_world(const ExtinctionPyramid& pyramid, const dvec3& world) {
    return pyramid.extinction_at(pyramid.medium().local_of_world(world));
}

// A product that single precision cannot sum names the keys that may lower it.
TEST(BuildMedium, WhatWouldOverflowIsAnErrorThatNamesItsKey) {
    Recipe r = linear_smoke(cubic(1.0));
    r.density = [](const ivec3&) { return 1e10f; };
    r.settings.smoke.extinction_per_metre = 1e20f;
    try {
        make_medium(r);
        ADD_FAILURE() << "an extinction of 1e30 is rendered";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::BadData);
        EXPECT_NE(std::string(error.what()).find("smoke.extinction_per_metre"), std::string::npos) << error.what();
    }
}

TEST(BuildMedium, ALinearFieldIsKeptUnderAnyAffineTransform) {
    const dmat3 skew = testing::some_linear_map();
    for (const dmat4& world_from_index :
         {cubic(1.0), cubic(0.01, {3.003, -7.1, 0.5}), transform(skew, {1.0, 2.0, 3.0}),
          transform(dmat3(dvec3(-0.3, 0, 0), dvec3(0, 0, 0.3), dvec3(0, 0.3, 0)), {0.1, 0, 0})}) {
        const Medium medium = make_medium(linear_smoke(world_from_index));
        const ExtinctionPyramid pyramid(medium, 1);
        Rng rng(Stream::EscapeRay, 1);
        for (int i = 0; i < 200; ++i) {
            const dvec3 index = random_point(rng, -9.0, 14.0);
            const dvec3 world(world_from_index * glm::dvec4(index, 1.0));
            ASSERT_NEAR(extinction_at_world(pyramid, world), 2.0 * linear_density(index), 2e-4);
        }
        EXPECT_NEAR(medium.voxel_volume, std::abs(glm::determinant(dmat3(world_from_index))),
                    1e-6 * medium.voxel_volume);
    }
}

TEST(BuildMedium, PositionsAreRightAMillionMetresFromTheOrigin) {
    const dvec3 far(1e6, -1e6, 1e6);
    const dmat4 world_from_index = transform(testing::some_linear_map(), far);
    const Medium medium = make_medium(linear_smoke(world_from_index));
    const ExtinctionPyramid pyramid(medium, 1);
    Rng rng(Stream::EscapeRay, 2);
    for (int i = 0; i < 200; ++i) {
        const dvec3 index = random_point(rng, -9.0, 14.0);
        const dvec3 world(world_from_index * glm::dvec4(index, 1.0));
        ASSERT_NEAR(extinction_at_world(pyramid, world), 2.0 * linear_density(index), 2e-3);
        ASSERT_LT(glm::length(medium.world_of_local(medium.local_of_world(world)) - world), 1e-4);
    }
}

TEST(BuildMedium, NodeZeroIsTheLatticePointNearestTheWorldsOrigin) {
    for (const dvec3& origin : {dvec3(0.0), dvec3(0.31, -0.44, 0.17), dvec3(51.3, -20.7, 11.1)}) {
        const dmat4 world_from_index = transform(testing::some_linear_map(), origin);
        const Medium medium = make_medium(linear_smoke(world_from_index));
        const dvec3 zero = glm::inverse(dmat3(world_from_index)) * dvec3(medium.world_from_index[3]);
        for (int a = 0; a < 3; ++a)
            EXPECT_LE(std::abs(zero[a]), 0.5 + 1e-9);
    }
}

TEST(BuildMedium, AMovingDomainDoesNotMoveTheLattice) {
    Recipe still;
    still.box = cube(-9, 14);
    still.world_from_index = cubic(0.1);
    still.density = [](const ivec3& n) { return noise(n, 1); };
    Recipe moved = still;  // the same smoke in a domain whose corner lies elsewhere
    const ivec3 shift(5, -3, 16);
    moved.box = {still.box.low - shift, still.box.high - shift};
    moved.world_from_index = cubic(0.1, dvec3(shift) * 0.1);
    moved.density = [=](const ivec3& n) { return noise(n + shift, 1); };
    const Medium a = make_medium(still), b = make_medium(moved);
    ASSERT_EQ(a.lattice.brick_count(), b.lattice.brick_count());
    for (std::size_t i = 0; i < a.lattice.brick_count(); ++i)
        EXPECT_EQ(a.lattice.brick(i), b.lattice.brick(i));
    EXPECT_EQ(a.extinction, b.extinction);
    EXPECT_EQ(a.reference_node, b.reference_node);
    EXPECT_LT(glm::length(dvec3(a.world_from_index[3] - b.world_from_index[3])), 1e-12);
}

TEST(BuildMedium, TheSameSmokeWholeVoxelsAwayHasTheSameNodes) {
    Recipe here;
    here.box = cube(-9, 14);
    here.world_from_index = cubic(0.1);
    here.density = [](const ivec3& n) { return noise(n, 2); };
    Recipe there = here;
    const ivec3 away(11, -300, 100000);
    there.world_from_index = cubic(0.1, dvec3(away) * 0.1);
    const Medium a = make_medium(here), b = make_medium(there);
    for (int x = -9; x <= 14; ++x)
        for (int y = -9; y <= 14; ++y)
            for (int z = -9; z <= 14; ++z) {
                const std::int64_t i = a.lattice.find_node({x, y, z});
                const std::int64_t j = b.lattice.find_node(ivec3(x, y, z) + away);
                ASSERT_GE(i, 0);
                ASSERT_GE(j, 0);
                ASSERT_EQ(a.extinction[i], b.extinction[j]);
            }
}

TEST(BuildMedium, HalfAVoxelMovesTheFieldByHalfAVoxel) {
    Recipe plain = linear_smoke(transform(testing::some_linear_map(), {1.0, 2.0, 3.0}));
    Recipe shifted = plain;
    shifted.half_voxel_shift = true;
    const Medium a = make_medium(plain), b = make_medium(shifted);
    const ExtinctionPyramid pa(a, 1), pb(b, 1);
    const dvec3 half = dmat3(plain.world_from_index) * dvec3(0.5);
    Rng rng(Stream::EscapeRay, 3);
    for (int i = 0; i < 100; ++i) {
        const dvec3 world(plain.world_from_index * glm::dvec4(random_point(rng, -8.0, 12.0), 1.0));
        ASSERT_NEAR(extinction_at_world(pa, world), extinction_at_world(pb, world + half), 2e-4);
        ASSERT_NEAR(extinction_at_world(pa, world + half) - extinction_at_world(pb, world + half),
                    2.0 * 0.5 * (0.1 - 0.05 + 0.02), 2e-4);
    }
}

TEST(BuildMedium, NegativeDensityIsNoDensityAndIsMentioned) {
    MediumGrids grids;
    grids.density =
        testing::scalar_grid("density", cubic(1.0), cube(0, 15), [](const ivec3& n) { return n.x < 8 ? -1.0f : 1.0f; });
    testing::Listener listener;
    const Medium medium = build_medium(grids, black_smoke(), false, listener);
    for (float e : medium.extinction)
        ASSERT_TRUE(e == 0.0f || e == 1.0f);
    EXPECT_EQ(medium.lattice.find_node({0, 0, 0}) >= 0 ? medium.extinction[medium.lattice.find_node({0, 0, 0})] : 0.0f,
              0.0f);
    EXPECT_EQ(medium.extinction[medium.lattice.find_node({9, 1, 1})], 1.0f);
    ASSERT_EQ(listener.warnings.size(), 1u);
    EXPECT_EQ(listener.warnings[0].first, "negative");
    EXPECT_NE(listener.warnings[0].second.find("2048"), std::string::npos) << listener.warnings[0].second;
}

TEST(BuildMedium, NotANumberIsNoDensityAndIsMentioned) {
    MediumGrids grids;
    grids.density = testing::scalar_grid("density", cubic(1.0), cube(0, 7),
                                         [](const ivec3& n) { return n == ivec3(3) ? std::nanf("") : 1.0f; });
    testing::Listener listener;
    const Medium medium = build_medium(grids, black_smoke(), false, listener);
    EXPECT_EQ(medium.max_extinction, 1.0f);
    ASSERT_EQ(listener.warnings.size(), 1u);
    EXPECT_EQ(listener.warnings[0].first, "nan");
}

TEST(BuildMedium, CleanDataIsBuiltInSilence) {
    MediumGrids grids;
    grids.density = testing::scalar_grid("density", cubic(1.0), cube(0, 7), [](const ivec3&) { return 1.0f; });
    testing::Listener listener;
    build_medium(grids, black_smoke(), false, listener);
    EXPECT_TRUE(listener.warnings.empty());
}

TEST(BuildMedium, EmptySpaceIsNotStored) {
    Recipe r;
    r.box = cube(0, 63);
    r.density = [](const ivec3& n) { return n == ivec3(20) ? 1.0f : 0.0f; };
    r.settings = black_smoke();
    const Medium medium = make_medium(r);
    EXPECT_EQ(medium.lattice.brick_count(), 1u);  // node 20 is 4 nodes inside its brick
    Recipe edge = r;
    edge.density = [](const ivec3& n) { return n == ivec3(24) ? 1.0f : 0.0f; };
    EXPECT_EQ(make_medium(edge).lattice.brick_count(), 8u) << "its hat reaches into seven neighbours";
}

TEST(BuildMedium, SmokeWithoutDensityIsAMediumWithoutAnything) {
    Recipe r;
    r.box = cube(0, 15);
    r.density = [](const ivec3&) { return 0.0f; };
    r.settings = black_smoke();
    const Medium medium = make_medium(r);
    EXPECT_EQ(medium.lattice.brick_count(), 0u);
    EXPECT_FALSE(medium.emits());
    EXPECT_FALSE(medium.scatters());
    EXPECT_EQ(ExtinctionPyramid(medium, 5).extinction_at(vec3(0.0f)), 0.0f);
}

}  // namespace
}  // namespace brisance
