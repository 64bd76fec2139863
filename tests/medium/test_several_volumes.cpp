// Several volumes in one medium: their coefficients add, wherever their lattices lie.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "fixtures/media.h"
#include "lighting_grid/voxel_lights.h"
#include "volume/fog_box.h"
#include "volume/settings.h"

namespace brisance {
namespace {

using namespace testing;

struct Volume {
    MediumGrids grids;
    MediumSettings settings = black_smoke();
};

// A ball of smoke and fire of `radius` voxels of `spacing`, anywhere.
Volume ball_at(const dvec3& centre, double spacing = 0.1, double radius = 8.0) {
    Volume v;
    const dmat4 world_from_index = cubic(spacing, centre);
    const NodeBox box = cube(-12, 12);
    v.grids.density = scalar_grid("density", world_from_index, box,
                                  [=](const ivec3& n) { return ball(n, dvec3(0.0), radius) * (0.5f + noise(n, 1)); });
    v.grids.flame =
        scalar_grid("flame", world_from_index, box, [=](const ivec3& n) { return ball(n, dvec3(0.0), radius); });
    return v;
}

Medium sum_of(const std::vector<Volume>& volumes) {
    std::vector<MediumPart> parts;
    for (const Volume& v : volumes)
        parts.push_back({v.grids, v.settings, false});
    Progress silent;
    return build_medium(parts, silent);
}

double smoke_in(const Medium& medium) {
    double sum = 0.0;
    for (const float e : medium.extinction)
        sum += double(e) * medium.voxel_volume;
    return sum;
}

double light_of(const Medium& medium) {
    return total(voxel_lights(medium)).x;
}

TEST(SeveralVolumes, TheSameTwiceIsTwiceAsThick) {
    const Volume v = ball_at(dvec3(0.3));
    const Medium once = sum_of({v}), twice = sum_of({v, v});
    ASSERT_EQ(once.extinction.size(), twice.extinction.size());
    for (std::size_t i = 0; i < once.extinction.size(); ++i) {
        EXPECT_EQ(twice.extinction[i], 2.0f * once.extinction[i]);
        EXPECT_EQ(twice.source[i], once.source[i]);
    }
    EXPECT_TRUE(twice.albedo_nodes.empty()) << "equal albedos need no field";
}

TEST(SeveralVolumes, OneAloneIsItself) {
    Recipe recipe = glowing_ball(8, 2.0f);
    const Medium direct = make_medium(recipe);
    Volume v;
    v.grids.density = scalar_grid("density", recipe.world_from_index, recipe.box, recipe.density);
    v.grids.flame = scalar_grid("flame", recipe.world_from_index, recipe.box, recipe.flame);
    v.settings = recipe.settings;
    const Medium summed = sum_of({v});
    EXPECT_EQ(direct.extinction, summed.extinction);
    EXPECT_EQ(direct.source, summed.source);
}

// Far apart, one beside the other, through each other; on one lattice and on lattices that do not fit.
TEST(SeveralVolumes, SmokeAndLightAdd) {
    for (const dvec3& apart :
         {dvec3(5.0, 0.0, 0.0), dvec3(1.6, 0.0, 0.1), dvec3(0.5, 0.2, 0.0), dvec3(0.537, 0.211, 0.05)})
        for (const double spacing : {0.1, 0.131, 0.3}) {
            const Volume a = ball_at(dvec3(0.0)), b = ball_at(apart, spacing, 0.8 / spacing);
            const Medium both = sum_of({a, b});
            const double smoke = smoke_in(sum_of({a})) + smoke_in(sum_of({b}));
            EXPECT_NEAR(smoke_in(both) / smoke, 1.0, 0.003) << apart.x << " " << spacing;
            // Black smoke and source 1 inside of both: light is smoke, but for the skins.
            const double light = light_of(sum_of({a})) + light_of(sum_of({b}));
            EXPECT_NEAR(light_of(both) / light, 1.0, apart.x > 1.0 ? 0.02 : 0.06) << apart.x << " " << spacing;
        }
}

TEST(SeveralVolumes, AlbedosMixByExtinction) {
    Volume a = ball_at(dvec3(0.0)), b = ball_at(dvec3(0.4, 0.0, 0.0));
    a.settings.smoke.albedo = Rgb(0.9f);
    b.settings.smoke.albedo = Rgb(0.3f, 0.2f, 0.1f);
    b.settings.smoke.extinction_per_metre = 3.0f;
    const Medium both = sum_of({a, b}), of_a = sum_of({a}), of_b = sum_of({b});
    ASSERT_EQ(both.albedo_nodes.size(), both.extinction.size());
    double scattered[3] = {};
    const Medium* const media[3] = {&both, &of_a, &of_b};
    for (int k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < media[k]->extinction.size(); ++i)
            scattered[k] += double(media[k]->extinction[i]) * media[k]->albedo_at(i).y;
    EXPECT_NEAR(scattered[0] / (scattered[1] + scattered[2]), 1.0, 1e-5);
}

// Smoke without fire through fire: what glows is what absorbs there of its own.
TEST(SeveralVolumes, SmokeWithoutFireAddsNoLight) {
    const Volume fire = ball_at(dvec3(0.0));
    Volume smoke = ball_at(dvec3(0.3, 0.0, 0.0));
    smoke.settings.fire.model = FireModel::None;
    EXPECT_NEAR(light_of(sum_of({fire, smoke})) / light_of(sum_of({fire})), 1.0, 0.06);
    EXPECT_FALSE(sum_of({smoke}).emits());
}

TEST(SeveralVolumes, DirectFireBesideFireThatAbsorbs) {
    const Volume absorbing = ball_at(dvec3(0.0));
    Volume direct = ball_at(dvec3(0.4, 0.0, 0.0));
    direct.settings.fire.convention = EmissionConvention::Direct;
    const Medium both = sum_of({absorbing, direct});
    EXPECT_FALSE(both.source.empty());
    EXPECT_FALSE(both.emission.empty());
    EXPECT_NEAR(light_of(both) / (light_of(sum_of({absorbing})) + light_of(sum_of({direct}))), 1.0, 0.06);
}

TEST(SeveralVolumes, ATurnedVolumeKeepsSmokeAndLight) {
    Volume turned = ball_at(dvec3(0.0), 0.13);
    const double c = std::cos(0.5), s = std::sin(0.5);
    const dmat4 turn({c, s, 0, 0}, {-s, c, 0, 0}, {0, 0, 1, 0}, {0.7, 0.2, 0.1, 1});
    const double smoke = smoke_in(sum_of({turned}));
    for (auto* g : {&turned.grids.density, &turned.grids.flame})
        (*g)->info.world_from_index = turn * (*g)->info.world_from_index;
    const Volume fine = ball_at(dvec3(9.0, 0.0, 0.0));
    EXPECT_NEAR(smoke_in(sum_of({turned, fine})) / (smoke + smoke_in(sum_of({fine}))), 1.0, 0.003);
}

TEST(SeveralVolumes, LatticesTooDifferentAreRefusedBeforeMemoryIsTaken) {
    const Volume fog = ball_at(dvec3(0.0), 100.0), spark = ball_at(dvec3(0.0), 0.001);
    try {
        sum_of({fog, spark});
        FAIL() << "built";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::Temporary);
        EXPECT_NE(std::string(e.what()).find("similar size"), std::string::npos) << e.what();
    }
}

// Optical depth along each axis: the box itself, and half a voxel on either side where it fades.
TEST(FogBoxes, AreAsThickAsTheyAreLong) {
    const FogBox box{{-1.0, 2.0, 0.0}, {3.0, 2.5, 7.0}, 0.1};
    Volume fog;
    fog.grids.density = fog_grid(box, 1 << 30, "fog");
    fog.settings.smoke.extinction_per_metre = 0.25f;
    const Medium medium = sum_of({fog});
    const ExtinctionPyramid pyramid(medium, 1);
    const dvec3 middle = 0.5 * (box.low + box.high);
    for (int a = 0; a < 3; ++a) {
        dvec3 from = middle, to = middle;
        from[a] = box.low[a] - 1.0;
        to[a] = box.high[a] + 1.0;
        const double length = box.high[a] - box.low[a] + 0.1;
        EXPECT_NEAR(pyramid.optical_depth(medium.local_of_world(from), medium.local_of_world(to)), 0.25 * length,
                    0.002 * length);
    }
}

TEST(FogBoxes, TooFineOnesAreRefusedBeforeMemoryIsTaken) {
    const FogBox box{dvec3(0.0), dvec3(1000.0), 0.01};
    EXPECT_THROW(fog_grid(box, 1 << 30, "fog"), Error);
}

TEST(VolumePlacement, ZUpStandsAYUpFileUp) {
    VolumeSettings settings;
    EXPECT_EQ(placement(settings, "a.vdb"), dmat4(1.0));
    settings.up = 'z';
    const dmat4 m = placement(settings, "a.vdb");
    EXPECT_EQ(m * glm::dvec4(0, 1, 0, 1), glm::dvec4(0, 0, 1, 1)) << "up";
    EXPECT_EQ(m * glm::dvec4(1, 0, 0, 1), glm::dvec4(1, 0, 0, 1));
    EXPECT_EQ(glm::determinant(dmat3(m)), 1.0) << "turned, not mirrored";
}

TEST(VolumePlacement, FlatAndProjectiveMatricesAreRefused) {
    VolumeSettings settings;
    settings.world_from_file = dmat4(1.0);
    settings.world_from_file[2] = glm::dvec4(0.0);
    EXPECT_THROW(placement(settings, "a.vdb"), Error);
    settings.world_from_file = dmat4(1.0);
    settings.world_from_file[0][3] = 0.5;
    EXPECT_THROW(placement(settings, "a.vdb"), Error);
}

}  // namespace
}  // namespace brisance
