// The bound and the energy that it removes.
#include <gtest/gtest.h>

#include <cmath>

#include "point_fixture.h"

namespace brisance {
namespace {

using namespace testing;

TEST(Bound, AndWhatItLeavesOutAreTheInverseSquare) {
    const Bound bound(4.0);
    EXPECT_DOUBLE_EQ(bound.radius(), 0.5);
    for (const double w : {1e-6, 0.1, 0.4999, 0.5, 0.7, 30.0}) {
        const double whole = 1.0 / (w * w);
        EXPECT_NEAR(bound.of(whole) + bound.part_left_out(w) * whole, whole, 1e-12 * whole);
    }
    const Bound none(0.0);
    EXPECT_FALSE(none.limits());
    EXPECT_EQ(none.of(1e30), 1e30);
    EXPECT_EQ(none.part_left_out(1e-30), 0.0);
}

TEST(Bound, ShareLeftOutIsItsIntegral) {
    const Bound bound(4.0);
    for (const double extinction : {1e-9, 1e-3, 0.0199, 0.0201, 1.0, 20.0, 1e4}) {
        constexpr int kParts = 400'000;
        double sum = 0.0;
        for (int i = 0; i < kParts; ++i) {
            const double w = (i + 0.5) / kParts * bound.radius();
            sum += extinction * std::exp(-extinction * w) * bound.part_left_out(w) * bound.radius() / kParts;
        }
        EXPECT_NEAR(bound.share_left_out(extinction), sum, 1e-5 * sum) << extinction;
    }
    EXPECT_EQ(Bound(0.0).share_left_out(3.0), 0.0);
}

TEST(Bound, AutomaticFollowsTheScene) {
    VolumetricVplSettings settings;
    ASSERT_EQ(settings.bound, kAutomaticBound);
    settings.paths = 1000;
    const auto radius = [&](double metres, int paths) {
        Recipe r = coloured_ball(8, 2.0f, 0.0f);
        settings.paths = paths;
        r.world_from_index = dmat4(dmat3(metres)) * r.world_from_index;
        const Medium medium = make_medium(r);
        return bound_of(settings, TrackingField(medium)).radius();
    };
    EXPECT_GT(radius(1.0, 1000), 0.0);
    EXPECT_NEAR(radius(1.0, 1000) / radius(1.0, 8000), 2.0, 1e-6);
    EXPECT_NEAR(radius(3.0, 1000) / radius(1.0, 1000), 3.0, 1e-4);
}

TEST(Bound, NoSmokeIsNoTrouble) {
    const Medium nothing;
    const DirectLight scene(nothing, {}, nullptr);
    const VolumetricVpls lights(scene, VolumetricVplSettings{}, -1, {});
    EXPECT_TRUE(lights.lights().empty());
    RayMedium seen;
    seen.look(scene.field(), {dvec3(0.0), dvec3(0.0, 0.0, 1.0)}, 10.0);
    Rng rng(Stream::Points, 4);
    EXPECT_EQ(lights.along_ray(seen, rng), Rgb(0.0f));
}

}  // namespace
}  // namespace brisance
