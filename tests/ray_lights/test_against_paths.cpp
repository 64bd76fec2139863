// Ray lights have the mean of the path tracer: MM and SM, in media of all kinds, with light of all kinds.
#include <gtest/gtest.h>

#include <string>

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

// Both lengths of rays against the same paths.
void expect_same_by_both(const Stage& stage, const std::string& what, std::uint64_t path_samples) {
    const Estimate paths = mean_by_paths(stage, path_samples);
    expect_same_light(stage, few(), (what + ", short").c_str(), paths);
    expect_same_light(stage, few(RayLength::Long), (what + ", long").c_str(), paths);
}

TEST(AgainstPaths, Ball) {
    expect_same_by_both(Stage(coloured_ball(8, 1.5f, 0.0f), {}), "ball", kPathsInSmoke);
}

TEST(AgainstPaths, LumpyBallOverAFloor) {
    expect_same_by_both(Stage(lumpy_ball(8, 3.0f, 0.0f), floor_below(0.7f)), "lumps", kPathsOverFloor);
}

// Points drawn in closed form and by tables, in smoke and at a floor. Long rays that scatter forward have rare bright
// samples: two sets, so that their error stays below its bound.
TEST(AgainstPaths, ForwardScatteringOverAFloorByEverySampling) {
    const Stage stage(lumpy_ball(8, 3.0f, 0.6f), floor_below(0.7f));
    const Estimate paths = mean_by_paths(stage, kPathsOverFloor);  // one truth for all
    for (const RaySampling sampling : {RaySampling::ClosedForm, RaySampling::Tabulated}) {
        const std::string what = sampling == RaySampling::Tabulated ? "lumps, g 0.6, tables" : "lumps, g 0.6";
        for (const RayLength length : {RayLength::Short, RayLength::Long}) {
            RayLightSettings settings = few(length);
            settings.sampling = sampling;
            const bool is_long = length == RayLength::Long;
            expect_same_light(stage, settings, (what + (is_long ? ", long" : ", short")).c_str(), paths,
                              is_long ? 2 : 1);
        }
    }
}

TEST(AgainstPaths, BackwardScattering) {
    const Stage stage(coloured_ball(8, 2.0f, -0.7f), {});
    expect_same_light(stage, few(), "ball, g -0.7", mean_by_paths(stage, kPathsInSmoke), 2);
}

TEST(AgainstPaths, ALampOutsideOverAFloor) {
    Recipe dark = lumpy_ball(8, 3.0f, 0.3f);
    dark.flame = {};
    const Stage stage(dark, floor_below(0.7f), {lamp()});
    const Estimate paths = mean_by_paths(stage, kPathsOverFloor);
    expect_same_light(stage, few(), "lamp", paths);
    RayLightSettings thinned = few();
    thinned.count = 1000;
    expect_same_light(stage, thinned, "lamp, most lights left out", paths);
}

TEST(AgainstPaths, BouncesEndWhereTheyAreAskedTo) {
    for (const int bounces : {2, 3}) {
        const Stage stage(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f), {lamp()}, bounces);
        expect_same_light(stage, few(), bounces == 2 ? "two bounces" : "three bounces",
                          mean_by_paths(stage, kPathsOverFloor));
    }
    const Stage once(coloured_ball(8, 2.0f, 0.0f), floor_below(0.7f), {lamp()}, 1);
    EXPECT_TRUE(once.lights(few(), 4, 1).lights().empty());
}

}  // namespace
}  // namespace brisance
