// Ray lights have the mean of the path tracer: MM and SM, in media of all kinds, with light of all kinds.
#include <gtest/gtest.h>

#include "fixtures/ray_fixture.h"

namespace brisance {
namespace {

using namespace testing;

RayLightSettings few(RayLength length = RayLength::Short) {
    RayLightSettings s;
    s.paths = 600;
    s.count = 100'000;
    s.samples = 4;
    s.length = length;
    return s;
}

LightSettings lamp() {
    LightSettings l;
    l.kind = LightKind::Point;
    l.position = dvec3(1.5, 0.7, 1.1);
    l.power = Rgb(30.0f);
    return l;
}

TEST(AgainstPaths, Ball) {
    const Stage stage(coloured_ball(8, 1.5f, 0.0f), {});
    expect_same_light(stage, few(), "ball, short");
    expect_same_light(stage, few(RayLength::Long), "ball, long");
}

TEST(AgainstPaths, LumpyBallOverAFloor) {
    const Stage stage(lumpy_ball(8, 3.0f, 0.0f), floor_below(0.7f));
    expect_same_light(stage, few(), "lumps, short");
    expect_same_light(stage, few(RayLength::Long), "lumps, long");
}

TEST(AgainstPaths, ForwardScatteringOverAFloor) {
    const Stage stage(lumpy_ball(8, 3.0f, 0.6f), floor_below(0.7f));
    expect_same_light(stage, few(), "lumps, g 0.6, short");
    expect_same_light(stage, few(RayLength::Long), "lumps, g 0.6, long");
}

TEST(AgainstPaths, BackwardScattering) {
    const Stage stage(coloured_ball(8, 2.0f, -0.7f), {});
    expect_same_light(stage, few(), "ball, g -0.7", 400, 3);
}

TEST(AgainstPaths, ALampOutsideOverAFloor) {
    Recipe dark = lumpy_ball(8, 3.0f, 0.3f);
    dark.flame = {};
    const Stage stage(dark, floor_below(0.7f), {lamp()});
    expect_same_light(stage, few(), "lamp");
    RayLightSettings thinned = few();
    thinned.count = 1000;
    expect_same_light(stage, thinned, "lamp, most lights left out");
}

TEST(AgainstPaths, BouncesEndWhereTheyAreAskedTo) {
    for (const int bounces : {2, 3}) {
        const Stage stage(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f), {lamp()}, bounces);
        expect_same_light(stage, few(), bounces == 2 ? "two bounces" : "three bounces");
    }
    const Stage once(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f), {lamp()}, 1);
    EXPECT_TRUE(once.lights(few(), 4, 1).lights().empty());
}

}  // namespace
}  // namespace brisance
