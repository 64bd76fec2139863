// What shots say of time and velocity, and what they may not say.
#include <gtest/gtest.h>

#include "shot/write_shot.h"
#include "shot_errors.h"

namespace brisance::testing {
namespace {

bool mentions(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(TimeKeys, AreReadAndWrittenBack) {
    const Shot shot = parsed(R"({"volume": {"file": "a.####.vdb", "grids": {"velocity": ["u", "v", "w"]}},
        "time": {"curve": [[1001, 1], [1010.5, 5.25]], "offset": 0.5, "before": "hold", "after": "ping_pong",
                 "missing": "interpolate", "retime": "advect"},
        "velocity": {"unit": "voxel_second", "scale": 2, "frames_per_second": 30}})");
    const Shot again = parsed(to_json(shot));
    for (const Shot* s : {&shot, &again}) {
        ASSERT_EQ(s->time.curve.size(), 2u);
        EXPECT_EQ(s->time.curve[1].frame, 1010.5);
        EXPECT_EQ(s->time.curve[1].source, 5.25);
        EXPECT_EQ(s->time.offset, 0.5);
        EXPECT_EQ(s->time.before, BeyondEnd::Hold);
        EXPECT_EQ(s->time.after, BeyondEnd::PingPong);
        EXPECT_EQ(s->time.missing, MissingFrame::Interpolate);
        EXPECT_EQ(s->time.retime, Retime::Advect);
        EXPECT_EQ(s->velocity.unit, VelocityUnit::VoxelSecond);
        EXPECT_EQ(s->velocity.scale, 2.0);
        EXPECT_EQ(s->velocity.frames_per_second, 30.0);
        EXPECT_EQ(s->volume.grids.velocity, (std::vector<std::string>{"u", "v", "w"}));
    }
}

TEST(TimeKeys, AFurtherVolumeHasItsOwnOrTheShots) {
    const Shot shot = parsed(R"({"volume": {"file": "a.####.vdb"}, "time": {"speed": 0.5}, "volumes": [
        {"file": "b.####.vdb"}, {"file": "c.####.vdb", "time": {"offset": 3}, "velocity": {"unit": "frame"}}]})");
    EXPECT_FALSE(shot.volumes[0].time.has_value());
    EXPECT_EQ(shot.volumes[1].time->offset, 3.0);
    EXPECT_EQ(shot.volumes[1].velocity->unit, VelocityUnit::Frame);
    EXPECT_EQ(parsed(to_json(shot)).volumes[1].time->offset, 3.0);
}

TEST(TimeKeys, ACurveMayNotGoBackward) {
    for (const char* curve : {"[[1, 5], [2, 4]]", "[[2, 4], [1, 5]]", "[[1, 4], [1, 5]]"}) {
        const std::string message = message_of_overrides({std::string("time.curve=") + curve});
        EXPECT_TRUE(mentions(message, "time.curve[1]")) << message;
        EXPECT_TRUE(mentions(message, "go backward")) << message;
        EXPECT_FALSE(mentions(message, "\n")) << message;
    }
    EXPECT_EQ(message_of_overrides({"time.curve=[[1, 4], [2, 4]]"}), "") << "time may stand still";
    EXPECT_TRUE(mentions(message_of_overrides({"time.curve=[[1, 4], [2]]"}), "a pair"));
}

TEST(TimeKeys, OtherMistakesAreOneLineEach) {
    for (const char* wrong : {"time.speed=-1", "time.before=loop", "time.missing=repeat", "time.retime=optical_flow",
                              "velocity.unit=knots", "velocity.frames_per_second=0", "time.curve=5"}) {
        const std::string message = message_of_overrides({wrong});
        EXPECT_TRUE(mentions(message, std::string(wrong).substr(0, std::string(wrong).find('=')))) << message;
        EXPECT_TRUE(mentions(message, "expected")) << message;
    }
    EXPECT_TRUE(mentions(message_of_overrides({"time.speed=2", "time.curve=[[1, 1], [2, 5]]"}), "remove one"));
    EXPECT_TRUE(
        mentions(error_message(R"({"volume": {"file": "a.vdb", "grids": {"velocity": ["u", "v"]}}})"), "three of them"))
        << "two are no velocity";
    EXPECT_TRUE(mentions(error_message(R"({"volumes": [{"box": {"low": [0, 0, 0], "high": [1, 1, 1]},
                                           "time": {"offset": 1}}]})"),
                         "has no time"));
}

}  // namespace
}  // namespace brisance::testing
