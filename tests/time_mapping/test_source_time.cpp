// Which frames of a sequence a frame of the picture shows: offsets, speeds, curves, ends and holes.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "time_mapping/source_time.h"

namespace brisance {
namespace {

const std::vector<int> kFour = {10, 11, 12, 13};
const std::vector<int> kHole = {10, 11, 14, 15};

// "10" for a frame as it is, "10-11 0.25" for a quarter of the way, "empty", or "error".
std::string shown(const TimeSettings& settings, double frame, const std::vector<int>& on_disk = kFour) {
    try {
        const SourceTime time = source_time(settings, frame, on_disk, "x.####.vdb");
        if (time.empty)
            return "empty";
        if (time.single())
            return std::to_string(time.first);
        std::string weight = std::to_string(std::round(1000.0 * time.weight) / 1000.0);
        weight.erase(weight.find_last_not_of('0') + 1);
        return std::to_string(time.first) + "-" + std::to_string(time.second) + " " + weight;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::MissingInput);
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos);
        EXPECT_NE(message.find("x.####.vdb"), std::string::npos);
        EXPECT_NE(message.find("set time."), std::string::npos) << "what would mend it";
        return "error";
    }
}

TimeSettings with_ends(BeyondEnd mode) {
    TimeSettings settings;
    settings.before = settings.after = mode;
    return settings;
}

// What is shown of times 6 to 18, in steps of a half.
std::vector<std::string> row(BeyondEnd mode, double from, double to) {
    std::vector<std::string> out;
    TimeSettings settings = with_ends(mode);
    for (double frame = from; frame <= to; frame += 0.5)
        out.push_back(shown(settings, frame));
    return out;
}

using Row = std::vector<std::string>;

TEST(SourceTime, IsTheFrameItselfWithoutSettings) {
    for (const int frame : kFour)
        EXPECT_EQ(shown({}, frame), std::to_string(frame));
    EXPECT_TRUE(TimeSettings{}.identity());
    EXPECT_EQ(shown({}, 10.25), "10-11 0.25");
}

TEST(SourceTime, EndsByTheirTable) {
    EXPECT_EQ(row(BeyondEnd::Error, 9.0, 10.0), (Row{"error", "error", "10"}));
    EXPECT_EQ(row(BeyondEnd::Error, 13.0, 14.0), (Row{"13", "error", "error"}));
    EXPECT_EQ(row(BeyondEnd::Hold, 9.0, 10.5), (Row{"10", "10", "10", "10-11 0.5"}));
    EXPECT_EQ(row(BeyondEnd::Hold, 12.5, 14.0), (Row{"12-13 0.5", "13", "13", "13"}));
    EXPECT_EQ(row(BeyondEnd::Empty, 9.0, 10.0), (Row{"empty", "empty", "10"}));
    EXPECT_EQ(row(BeyondEnd::Empty, 13.0, 14.0), (Row{"13", "empty", "empty"}));
    EXPECT_EQ(row(BeyondEnd::Repeat, 13.0, 18.0),
              (Row{"13", "10", "10", "10-11 0.5", "11", "11-12 0.5", "12", "12-13 0.5", "13", "10", "10"}))
        << "from the last frame to the first is a cut";
    EXPECT_EQ(row(BeyondEnd::Repeat, 6.0, 9.0), (Row{"10", "10-11 0.5", "11", "11-12 0.5", "12", "12-13 0.5", "13"}));
    EXPECT_EQ(row(BeyondEnd::PingPong, 13.0, 17.0),
              (Row{"13", "12-13 0.5", "12", "11-12 0.5", "11", "10-11 0.5", "10", "10-11 0.5", "11"}));
    EXPECT_EQ(row(BeyondEnd::PingPong, 7.0, 10.0),
              (Row{"13", "12-13 0.5", "12", "11-12 0.5", "11", "10-11 0.5", "10"}));
}

TEST(SourceTime, EachEndHasItsOwnSetting) {
    TimeSettings settings;
    settings.before = BeyondEnd::Empty;
    settings.after = BeyondEnd::Hold;
    EXPECT_EQ(shown(settings, 9), "empty");
    EXPECT_EQ(shown(settings, 99), "13");
}

TEST(SourceTime, HolesByTheirTable) {
    const auto hole = [](MissingFrame mode, double frame) {
        TimeSettings settings;
        settings.missing = mode;
        return shown(settings, frame, kHole);
    };
    for (const double frame : {11.5, 12.0, 13.0, 13.75}) {
        EXPECT_EQ(hole(MissingFrame::Error, frame), "error");
        EXPECT_EQ(hole(MissingFrame::Hold, frame), "11");
    }
    EXPECT_EQ(hole(MissingFrame::Interpolate, 12.0), "11-14 0.333");
    EXPECT_EQ(hole(MissingFrame::Interpolate, 13.25), "11-14 0.75");
    for (const MissingFrame mode : {MissingFrame::Error, MissingFrame::Hold, MissingFrame::Interpolate}) {
        EXPECT_EQ(hole(mode, 11.0), "11");
        EXPECT_EQ(hole(mode, 14.0), "14");
        EXPECT_EQ(hole(mode, 10.5), "10-11 0.5") << "no hole there";
    }
}

TEST(SourceTime, SpeedRunsFromTheFirstFrameAndTheOffsetIsAdded) {
    TimeSettings slow;
    slow.speed = 0.25;
    EXPECT_EQ(shown(slow, 10), "10");
    EXPECT_EQ(shown(slow, 11), "10-11 0.25");
    EXPECT_EQ(shown(slow, 14), "11") << "a whole frame is that frame alone";
    slow.offset = 1.5;
    EXPECT_EQ(shown(slow, 12), "12");
    EXPECT_DOUBLE_EQ(source_time(slow, 11, kFour, "").rate, 0.25);
}

TEST(SourceTime, ATenthOfAFrameTenTimesIsAWholeFrame) {
    TimeSettings slow;
    slow.speed = 0.1;
    EXPECT_EQ(shown(slow, 20), "11");
    EXPECT_EQ(shown(slow, 40), "13");
}

TEST(SourceTime, ACurveIsLinearBetweenItsPointsAndHeldBeyond) {
    TimeSettings settings;
    settings.curve = {{1, 10}, {5, 12}, {6, 12}, {8, 13}};
    EXPECT_EQ(shown(settings, -3), "10");
    EXPECT_EQ(shown(settings, 2), "10-11 0.5");
    EXPECT_EQ(shown(settings, 5), "12");
    EXPECT_EQ(shown(settings, 5.5), "12");
    EXPECT_EQ(shown(settings, 7), "12-13 0.5");
    EXPECT_EQ(shown(settings, 99), "13");
    EXPECT_DOUBLE_EQ(source_time(settings, 2, kFour, "").rate, 0.5);
    EXPECT_DOUBLE_EQ(source_time(settings, 5.5, kFour, "").rate, 0.0);
}

TEST(SourceTime, PingPongRunsBackward) {
    const TimeSettings settings = with_ends(BeyondEnd::PingPong);
    EXPECT_DOUBLE_EQ(source_time(settings, 12.0, kFour, "").rate, 1.0);
    EXPECT_DOUBLE_EQ(source_time(settings, 14.5, kFour, "").rate, -1.0);
    EXPECT_DOUBLE_EQ(source_time(settings, 16.5, kFour, "").rate, 1.0);
}

TEST(SourceTime, NearestNeverNeedsTwoFrames) {
    TimeSettings settings;
    settings.retime = Retime::Nearest;
    EXPECT_EQ(shown(settings, 10.4), "10");
    EXPECT_EQ(shown(settings, 10.5), "11");
    EXPECT_FALSE(may_interpolate(settings, kFour));
}

TEST(SourceTime, OneFrameIsAllFrames) {
    for (const BeyondEnd mode : {BeyondEnd::Hold, BeyondEnd::PingPong, BeyondEnd::Repeat})
        for (const double frame : {3.0, 7.0, 8.0, 30.0})
            EXPECT_EQ(shown(with_ends(mode), frame, {7}), "7");
}

TEST(SourceTime, WhetherTwoFramesMayBeNeededDependsOnNoFrame) {
    TimeSettings settings = with_ends(BeyondEnd::PingPong);
    settings.offset = 3.0;
    settings.speed = 2.0;
    EXPECT_FALSE(may_interpolate(settings, kFour));
    settings.missing = MissingFrame::Interpolate;
    EXPECT_FALSE(may_interpolate(settings, kFour));
    EXPECT_TRUE(may_interpolate(settings, kHole));
    settings.missing = MissingFrame::Hold;
    settings.offset = 0.5;
    EXPECT_TRUE(may_interpolate(settings, kFour));
}

TEST(SourceTime, FramesOfThePictureCoverTheSequence) {
    TimeSettings settings;
    settings.speed = 0.5;
    EXPECT_EQ(covering_frames(settings, kFour, ""), (std::vector<int>{10, 11, 12, 13, 14, 15, 16}));
    settings.speed = 1.0;
    settings.offset = 8.0;
    EXPECT_EQ(covering_frames(settings, kFour, ""), (std::vector<int>{2, 3, 4, 5}));
    EXPECT_EQ(covering_frames(settings, kHole, ""), (std::vector<int>{2, 3, 6, 7})) << "as all that are there";
    settings.offset = 0.0;
    settings.curve = {{1, 10}, {3, 13}};
    EXPECT_EQ(covering_frames(settings, kFour, ""), (std::vector<int>{1, 2, 3}));
    settings.curve.clear();
    settings.speed = 1e-6;
    EXPECT_THROW(covering_frames(settings, {1, 1000}, "x"), Error) << "a thousand million frames";
}

}  // namespace
}  // namespace brisance
