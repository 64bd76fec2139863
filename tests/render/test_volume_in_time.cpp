// A sequence of files at whole times, between them, beyond its ends and over its holes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "fixtures/media.h"
#include "make_vdb.h"
#include "render/input/frame_input.h"
#include "render/input/load_medium.h"
#include "render/input/volume_in_time.h"
#include "temp_folder.h"

namespace brisance::test_volume_in_time {
namespace {

constexpr double kSpeed = 1.5;  // voxels per frame, along x
constexpr double kUnit = 0.25;  // voxels per frame that a unit of velocity is

double ball_of_smoke(const dvec3& p, double time) {
    const dvec3 d = p - dvec3(kSpeed * time, 0.5, 0.0);
    const double v = std::exp(-0.125 * glm::dot(d, d));
    return v < 1e-3 ? 0.0 : v;
}

TestGrid density_at(double time) {
    TestGrid grid;
    const int middle = static_cast<int>(std::lround(kSpeed * time));
    grid.voxels = fill_box({middle - 9, -9, -9}, {middle + 9, 9, 9},
                           [&](const ivec3& node) { return ball_of_smoke(dvec3(node), time); });
    std::erase_if(grid.voxels, [](const TestVoxel& v) { return v.value.x == 0.0; });
    return grid;
}

TestGrid velocity_at(double time) {
    TestGrid grid = density_at(time);
    grid.name = "velocity";
    grid.type = TestType::Vec3f;
    grid.grid_class = TestClass::Unknown;
    for (TestVoxel& voxel : grid.voxels)
        voxel.value = dvec3(kSpeed / kUnit, 0.0, 0.0);
    return grid;
}

class VolumeInTime : public ::testing::Test {
protected:
    VolumeInTime() {
        for (const int frame : {1, 2, 3, 4, 7})
            write_vdb(folder_ / ("smoke_000" + std::to_string(frame) + ".vdb"),
                      {density_at(frame), velocity_at(frame)});
        shot_.folder = folder_.path();
        shot_.volume.file = "smoke_####.vdb";
        shot_.medium.fire.model = FireModel::None;
        shot_.medium.smoke.extinction_per_metre = 1.0f;
    }

    Medium medium(const Shot& shot, int frame, Progress& progress) const {
        Statistics unused;
        return load_medium(shot, own_files(shot, frame).nearest(), frame, unused, progress);
    }
    Medium medium(const Shot& shot, int frame) const {
        Progress silent;
        return medium(shot, frame, silent);
    }

    // Relative L2 error of the extinction against the smoke at that time.
    static double error_at(const Medium& medium, double time) {
        double squares = 0.0, norm = 0.0;
        for (std::size_t i = 0; i < medium.extinction.size(); ++i) {
            const double truth = ball_of_smoke(dvec3(medium.lattice.node(i)), time);
            squares += std::pow(medium.extinction[i] - truth, 2);
            norm += truth * truth;
        }
        return std::sqrt(squares / norm);
    }

    TempFolder folder_;
    Shot shot_;
};

TEST_F(VolumeInTime, AWholeTimeIsThatFileToTheBit) {
    const Medium file = medium(shot_, 3);
    Shot slow = shot_;
    slow.time.speed = 0.5;
    const Medium same = medium(slow, 5);
    EXPECT_EQ(file.extinction, same.extinction);
    EXPECT_EQ(file.lattice.brick_count(), same.lattice.brick_count());
    EXPECT_EQ(file.world_from_index, same.world_from_index);
    slow.time.speed = 0.0;
    slow.time.offset = 2.0;
    EXPECT_EQ(medium(slow, 40).extinction, file.extinction);
}

TEST_F(VolumeInTime, BetweenFramesSmokeHasMovedOn) {
    Shot slow = shot_;
    slow.time.speed = 0.5;
    testing::Listener listener;
    const Medium moved = medium(settle_time(slow, listener), 4, listener);
    EXPECT_LT(error_at(moved, 2.5), 0.01);
    slow.time.retime = Retime::Linear;
    EXPECT_GT(error_at(medium(slow, 4), 2.5), 0.05);
    ASSERT_GE(listener.notices.size(), 2u);
    EXPECT_NE(listener.notices[0].find("0.25"), std::string::npos) << listener.notices[0];
    EXPECT_NE(listener.notices[1].find("retime=advect"), std::string::npos) << listener.notices[1];
}

// [m per frame], where there is much smoke.
vec3 velocity_within(const Medium& medium) {
    vec3 sum(0.0f);
    float weight = 0.0f;
    for (std::size_t i = 0; i < medium.velocity.size(); ++i) {
        sum += medium.extinction[i] * medium.velocity[i];
        weight += medium.extinction[i];
    }
    return weight > 0.0f ? sum / weight : sum;
}

TEST_F(VolumeInTime, AnOpenShutterReadsTheVelocityInMetresPerFrame) {
    shot_.velocity.unit = VelocityUnit::Second;
    shot_.velocity.frames_per_second = 24.0;
    shot_.shutter.length = 0.5;
    const vec3 v = velocity_within(medium(shot_, 3));
    EXPECT_NEAR(v.x, kSpeed / kUnit / 24.0, 1e-5);
    EXPECT_NEAR(glm::length(v), v.x, 1e-6);
    shot_.volume.world_from_file = dmat4(dmat3(10.0));  // moves smoke and velocity alike
    EXPECT_NEAR(velocity_within(medium(shot_, 3)).x, 10.0 * kSpeed / kUnit / 24.0, 1e-4);
    shot_.shutter.length = 0.0;
    EXPECT_TRUE(medium(shot_, 3).velocity.empty());
}

TEST_F(VolumeInTime, TheUnitForBlurIsSettledForTheSequence) {
    shot_.shutter.length = 0.5;
    testing::Listener listener;
    const Shot settled = settle_time(shot_, listener);
    EXPECT_EQ(settled.velocity.unit, VelocityUnit::Frame);
    ASSERT_FALSE(listener.notices.empty());
    EXPECT_NEAR(velocity_within(medium(settled, 2)).x, kSpeed, 0.05 * kSpeed);
}

// At half the speed smoke moves half as far in a frame of the picture, also at times between files.
TEST_F(VolumeInTime, BlurFollowsTheSpeedOfTime) {
    shot_.shutter.length = 0.5;
    shot_.velocity.unit = VelocityUnit::Frame;
    shot_.velocity.scale = kUnit;
    shot_.time.speed = 0.5;
    shot_.time.retime = Retime::Advect;
    EXPECT_NEAR(velocity_within(medium(shot_, 5)).x, 0.5 * kSpeed, 1e-4);
    EXPECT_NEAR(velocity_within(medium(shot_, 4)).x, 0.5 * kSpeed, 0.03);
    shot_.time.speed = 0.0;
    EXPECT_EQ(velocity_within(medium(shot_, 5)), vec3(0.0f));
}

TEST_F(VolumeInTime, ASingleFileDoesNotTellTheUnit) {
    shot_.shutter.length = 0.5;
    shot_.volume.file = "smoke_0003.vdb";
    testing::Listener listener;
    EXPECT_TRUE(medium(shot_, 3, listener).velocity.empty());
    const auto said = [](const std::string& line) { return line.find("velocity.unit") != std::string::npos; };
    EXPECT_TRUE(std::any_of(listener.notices.begin(), listener.notices.end(), said));
}

TEST_F(VolumeInTime, WhatIsSettledDoesNotDependOnWhoSettlesIt) {
    Shot slow = shot_;
    slow.time.speed = 0.25;
    Progress silent;
    const Shot settled = settle_time(slow, silent);
    EXPECT_EQ(settled.time.retime, Retime::Advect);
    EXPECT_EQ(settled.velocity.unit, VelocityUnit::Frame);
    EXPECT_NEAR(settled.velocity.scale, kUnit, 0.03 * kUnit) << "voxels of one metre";
    EXPECT_EQ(medium(settled, 6).extinction, medium(slow, 6).extinction) << "the frame alone settles the same";
}

TEST_F(VolumeInTime, NothingIsReadThatNoFrameNeeds) {
    for (const double speed : {1.0, 2.0}) {
        Shot whole = shot_;
        whole.time.speed = speed;
        whole.shutter.length = 0.0;
        whole.volume.grids.velocity = {{"no such grid"}};
        testing::Listener listener;
        EXPECT_EQ(settle_time(whole, listener).time.retime, Retime::Automatic);
        EXPECT_TRUE(listener.notices.empty());
        EXPECT_NO_THROW(medium(whole, 2));
    }
    Shot linear = shot_;
    linear.shutter.length = 0.0;
    linear.time.speed = 0.5;
    linear.time.retime = Retime::Linear;
    linear.volume.grids.velocity = {{"no such grid"}};
    EXPECT_NO_THROW(medium(linear, 4));
    Shot advected = linear, blurred = linear;
    advected.time.retime = Retime::Advect;
    blurred.shutter.length = 0.5;
    for (Shot* needs_velocity : {&advected, &blurred}) {
        needs_velocity->velocity.unit = VelocityUnit::Frame;
        const Failure failure = failure_of([&] { medium(*needs_velocity, 4); });
        EXPECT_EQ(failure.code, ExitCode::BadData);
        EXPECT_TRUE(contains(failure.message, "volume.grids.velocity")) << failure.message;
    }
}

TEST_F(VolumeInTime, AVelocityOfAKindThatIsNoneIsRefused) {
    Shot shot = shot_;
    shot.time.speed = 0.5;
    shot.time.retime = Retime::Advect;
    shot.volume.grids.velocity = {{"density"}};
    Failure failure = failure_of([&] { medium(shot, 4); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "one value per voxel")) << failure.message;
    shot.volume.grids.velocity = std::vector<std::string>{};
    failure = failure_of([&] { medium(shot, 4); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "there is none")) << failure.message;
}

TEST_F(VolumeInTime, EndsAndHolesSayWhatWouldMendThem) {
    for (const int frame : {0, 5, 9}) {
        const Failure plain = failure_of([&] { medium(shot_, frame); });
        EXPECT_EQ(plain.code, ExitCode::MissingInput);
        EXPECT_TRUE(contains(plain.message, "time.")) << plain.message;
        Shot shot = shot_;
        shot.time.speed = 0.5;
        shot.time.offset = 0.5 * frame;  // the same time
        EXPECT_EQ(failure_of([&] { medium(shot, 1 + (frame > 0 ? frame - 1 : -2)); }).code, ExitCode::MissingInput);
    }
    Shot bridged = shot_;
    bridged.time.missing = MissingFrame::Interpolate;
    EXPECT_LT(error_at(medium(bridged, 5), 5.0), 0.02) << "across three frames";
    bridged.time.missing = MissingFrame::Hold;
    EXPECT_EQ(medium(bridged, 6).extinction, medium(shot_, 4).extinction);
    bridged.time.after = BeyondEnd::PingPong;
    EXPECT_EQ(medium(bridged, 11).extinction, medium(shot_, 3).extinction);
}

TEST_F(VolumeInTime, NothingBeforeTheFirstFrameIsAnEmptyFrame) {
    Shot shot = shot_;
    shot.time.before = BeyondEnd::Empty;
    const SourceFiles files = own_files(shot, -3);
    EXPECT_TRUE(files.nearest().empty());
    Statistics statistics;
    Progress silent;
    const FrameInput input = load_frame(shot, files.nearest(), -3, statistics, silent);
    EXPECT_TRUE(input.medium.lattice.empty());
    EXPECT_FALSE(medium(shot, 1).lattice.empty());
}

TEST_F(VolumeInTime, FurtherVolumesMayHaveTheirOwnTime) {
    Shot shot = shot_;
    shot.volumes.resize(1);
    shot.volumes[0].volume.file = "late_#.vdb";
    for (const int frame : {11, 12})
        write_vdb(folder_ / ("late_" + std::to_string(frame) + ".vdb"), {density_at(frame)});
    const Failure failure = failure_of([&] { medium(shot, 2); });
    EXPECT_EQ(failure.code, ExitCode::MissingInput);
    EXPECT_TRUE(contains(failure.message, "late_2.vdb")) << "which of the two: " << failure.message;
    shot.volumes[0].time = TimeSettings{};
    shot.volumes[0].time->offset = 10.0;
    const Medium both = medium(shot, 2);
    shot.volumes[0].time->before = BeyondEnd::Empty;
    shot.volumes[0].time->offset = 0.0;
    EXPECT_EQ(medium(shot, 2).extinction, medium(shot_, 2).extinction);
    EXPECT_GT(both.lattice.brick_count(), medium(shot_, 2).lattice.brick_count());
}

TEST_F(VolumeInTime, AStillVolumeHasNoTime) {
    Shot shot = shot_;
    shot.volume.file = "smoke_0001.vdb";
    shot.time.speed = 0.5;
    const Failure failure = failure_of([&] { own_files(shot, 1); });
    EXPECT_EQ(failure.code, ExitCode::Usage);
    EXPECT_TRUE(contains(failure.message, "name.####.vdb"));
}

}  // namespace
}  // namespace brisance::test_volume_in_time
