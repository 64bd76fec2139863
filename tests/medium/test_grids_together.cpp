// Several grids, each on a lattice of its own, become one medium.
#include <gtest/gtest.h>

#include "core/error.h"
#include "fixtures/media.h"

namespace brisance {
namespace {

using testing::black_smoke;
using testing::colour_grid;
using testing::cube;
using testing::cubic;
using testing::make_medium;
using testing::Recipe;
using testing::scalar_grid;
using testing::transform;

double linear_in_world(const dvec3& p) {
    return 5.0 + 0.7 * p.x - 0.4 * p.y + 0.3 * p.z;
}

testing::NodeScalar sampled(const dmat4& world_from_index) {
    return [=](const ivec3& n) {
        return static_cast<float>(linear_in_world(dvec3(world_from_index * glm::dvec4(dvec3(n), 1.0))));
    };
}

Rgb source_of(const Medium& medium, const ivec3& node) {
    return medium.source.at(medium.lattice.find_node(node));
}

TEST(GridsTogether, AnotherLatticeIsResampledWithoutLossOfLinearFields) {
    const dmat4 coarse =
        transform(dmat3(dvec3(0.4, 0.1, 0.0), dvec3(-0.1, 0.4, 0.0), dvec3(0.0, 0.05, 0.5)), {.3, .1, -.2});
    const dmat4 fine = cubic(0.11, {0.02, 0.03, 0.04});
    for (const bool density_is_finer : {true, false}) {
        const dmat4& of_density = density_is_finer ? fine : coarse;
        const dmat4& of_flame = density_is_finer ? coarse : fine;
        MediumGrids grids;
        grids.density = scalar_grid("density", of_density, cube(-16, 16), sampled(of_density));
        grids.flame = scalar_grid("flame", of_flame, cube(-16, 16), sampled(of_flame));
        Progress silent;
        const Medium medium = build_medium(grids, black_smoke(), false, silent);
        EXPECT_NEAR(medium.spacing, 0.11, 1e-6) << "the finer lattice is the medium's";
        int checked = 0;
        for (int x = -12; x <= 12; x += 3)
            for (int y = -12; y <= 12; y += 3)
                for (int z = -12; z <= 12; z += 3) {
                    const std::int64_t i = medium.lattice.find_node({x, y, z});
                    ASSERT_GE(i, 0);
                    const double expected = linear_in_world(medium.world_of_local(medium.local_of_node({x, y, z})));
                    ASSERT_NEAR(medium.extinction[i], expected, 1e-4);
                    ASSERT_NEAR(medium.source[i].x, expected, 1e-4);
                    ++checked;
                }
        EXPECT_EQ(checked, 9 * 9 * 9);
    }
}

TEST(GridsTogether, LatticesThatDifferByWholeVoxelsAreNotSmoothed) {
    const auto speckle = [](const ivec3& n) { return (n.x + n.y + n.z) % 2 ? 1.0f : 0.0f; };
    MediumGrids grids;
    grids.density = scalar_grid("density", cubic(0.1), cube(0, 15), [](const ivec3&) { return 1.0f; });
    grids.flame = scalar_grid("flame", cubic(0.1, dvec3(-0.3, 0.5, 0.2)), cube(0, 23), speckle);
    Progress silent;
    const Medium medium = build_medium(grids, black_smoke(), false, silent);
    for (int x = 5; x <= 15; ++x)
        for (int y = 5; y <= 15; ++y)
            for (int z = 5; z <= 15; ++z) {
                const ivec3 stored = ivec3(x, y, z) - ivec3(-3, 5, 2);
                ASSERT_EQ(source_of(medium, {x, y, z}).x, speckle(stored));
            }
}

TEST(GridsTogether, ThresholdsActBeforeInterpolation) {
    Recipe r;
    r.box = cube(0, 7);
    r.density = [](const ivec3&) { return 1.0f; };
    r.flame = [](const ivec3& n) { return n.x < 4 ? 0.4f : 1.0f; };
    r.settings = black_smoke();
    r.settings.fire.threshold = 0.5f;
    const Medium medium = make_medium(r);
    EXPECT_EQ(source_of(medium, {3, 4, 4}).x, 0.0f);
    EXPECT_NEAR(source_of(medium, {4, 4, 4}).x, 0.5f, 1e-7f);
    // Half way the camera sees 0.25; the threshold of the interpolated flame 0.7 would give 0.2.
    EXPECT_NEAR(0.5f * (source_of(medium, {3, 4, 4}).x + source_of(medium, {4, 4, 4}).x), 0.25f, 1e-7f);
}

TEST(GridsTogether, WhatDoesNotAbsorbDoesNotGlowUnlessToldTo) {
    Recipe r;
    r.box = cube(0, 7);
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    EXPECT_FALSE(make_medium(r).emits());
    r.settings.fire.convention = EmissionConvention::Direct;
    const Medium direct = make_medium(r);
    EXPECT_TRUE(direct.emits());
    EXPECT_EQ(direct.emission.at(direct.lattice.find_node({3, 3, 3})), Rgb(1.0f));
    EXPECT_EQ(direct.max_extinction, 0.0f);
}

TEST(GridsTogether, KirchhoffAlbedoOneDoesNotGlow) {
    Recipe r;
    r.box = cube(0, 7);
    r.density = r.flame = [](const ivec3&) { return 1.0f; };
    r.settings.smoke.albedo = Rgb(1.0f, 0.75f, 0.0f);
    const Medium medium = make_medium(r);
    const Rgb source = source_of(medium, ivec3(3));
    EXPECT_EQ(source.x, 0.0f);
    EXPECT_NEAR(source.y, 0.25f, 1e-6f);
    EXPECT_EQ(source.z, 1.0f);
    r.settings.smoke.albedo = Rgb(1.0f);
    EXPECT_FALSE(make_medium(r).emits());
    EXPECT_TRUE(make_medium(r).scatters());
}

TEST(GridsTogether, AColourGridTintsTheAlbedoOrTheFire) {
    Recipe r;
    r.box = cube(0, 7);
    r.density = r.flame = [](const ivec3&) { return 1.0f; };
    r.colour = [](const ivec3&) { return Rgb(0.5f, 4.0f, -1.0f); };
    r.settings.smoke.albedo = Rgb(0.8f);
    const Medium smoke = make_medium(r);
    const std::int64_t i = smoke.lattice.find_node(ivec3(3));
    EXPECT_NEAR(smoke.albedo_at(i).x, 0.4f, 1e-6f);
    EXPECT_EQ(smoke.albedo_at(i).y, 1.0f) << "never above one";
    EXPECT_EQ(smoke.albedo_at(i).z, 0.0f);
    EXPECT_NEAR(smoke.source[i].x, 0.6f, 1e-6f);
    r.settings.colour_role = ColourRole::Emission;
    const Medium fire = make_medium(r);
    EXPECT_NEAR(fire.albedo_at(i).x, 0.8f, 1e-6f);
    EXPECT_NEAR(fire.source[i].x, 0.2f * 0.5f, 1e-6f);
    EXPECT_NEAR(fire.source[i].y, 0.2f * 4.0f, 1e-6f);
    EXPECT_EQ(fire.source[i].z, 0.0f);
}

TEST(GridsTogether, NoGridAtAllIsAnError) {
    Progress silent;
    try {
        build_medium({}, black_smoke(), false, silent);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::BadData);
    }
}

TEST(GridsTogether, AnEmptyGridIsMentioned) {
    MediumGrids grids;
    grids.density = scalar_grid("density", cubic(1.0), cube(0, 7), [](const ivec3&) { return 1.0f; });
    grids.flame = BlockGrid{};
    grids.flame->info.name = "flame";
    testing::Listener listener;
    const Medium medium = build_medium(grids, black_smoke(), false, listener);
    EXPECT_FALSE(medium.emits());
    EXPECT_EQ(listener.notices.size() + listener.warnings.size(), 1u);
}

}  // namespace
}  // namespace brisance
