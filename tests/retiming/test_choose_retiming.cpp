// Blending or advecting is decided by frames that are known, once for a sequence.
#include <gtest/gtest.h>

#include "core/error.h"
#include "media/node_media.h"
#include "moving_smoke.h"

namespace brisance::testing {
namespace {

RetimingQuestion question(int frames) {
    RetimingQuestion q;
    for (int n = 1; n <= frames; ++n)
        q.on_disk.push_back(n);
    q.role_name = "density";
    q.has_velocity = true;
    q.where = "test";
    return q;
}

TEST(ChooseRetiming, AdvectsSmokeThatFollowsItsVelocity) {
    const MovingSmoke smoke = turning_smoke(0.2);
    const RetimingChoice choice = choose_retiming(question(9), [&](int n) { return smoke.frame(n); });
    EXPECT_EQ(choice.retime, Retime::Advect);
    EXPECT_LT(choice.advect_error, 0.1 * choice.linear_error);
    EXPECT_EQ(choice.held_out.size(), 5u);
    EXPECT_EQ(choice.velocity.unit, VelocityUnit::Frame);
    EXPECT_NEAR(choice.velocity.scale, kVoxel, 0.03 * kVoxel);
    ASSERT_EQ(choice.lines.size(), 2u) << "the unit, and the errors";
    EXPECT_NE(choice.lines[1].find("retime=advect"), std::string::npos);
}

// A flame that stands still while gas flows through it.
SourceFrame steady_flame(int n) {
    MovingSmoke smoke;
    smoke.blobs[0].amount = 1.0 + 0.05 * n;
    SourceFrame frame = smoke.frame(0);
    smoke.motion.velocity = {0.0, 0.0, 3.0};
    frame.velocity = centred_velocity({smoke.velocity(0)});
    return frame;
}

TEST(ChooseRetiming, BlendsAFlameThatStandsInTheFlow) {
    RetimingQuestion q = question(9);
    q.velocity = kVoxelsPerFrame;
    const RetimingChoice known = choose_retiming(q, steady_flame);
    EXPECT_EQ(known.retime, Retime::Linear);
    EXPECT_LT(known.linear_error, 0.2 * known.advect_error);
    q.velocity.unit = VelocityUnit::Automatic;
    const RetimingChoice open = choose_retiming(q, steady_flame);
    EXPECT_EQ(open.retime, Retime::Linear);
    EXPECT_NE(open.lines.back().find("cannot be told"), std::string::npos) << "and says why";
}

TEST(ChooseRetiming, RefusesToAdvectByAUnitThatCannotBeTold) {
    RetimingQuestion q = question(9);
    q.retime = Retime::Advect;
    try {
        choose_retiming(q, steady_flame);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::BadData);
        EXPECT_NE(std::string(error.what()).find("set velocity.unit and velocity.scale"), std::string::npos);
    }
    q.velocity = kVoxelsPerFrame;
    EXPECT_EQ(choose_retiming(q, steady_flame).retime, Retime::Advect) << "what is asked for is done";
    q.has_velocity = false;
    q.why_no_velocity = "no grid has the name of a velocity";
    EXPECT_THROW(choose_retiming(q, steady_flame), Error);
}

TEST(ChooseRetiming, BlendsWhereThereIsNothingToCompare) {
    const MovingSmoke smoke = turning_smoke(0.2);
    const RetimingChoice choice = choose_retiming(question(2), [&](int n) { return smoke.frame(n); });
    EXPECT_EQ(choice.retime, Retime::Linear);
    EXPECT_TRUE(choice.held_out.empty());
}

TEST(ChooseRetiming, UsesScalesThatAreGiven) {
    const MovingSmoke smoke = turning_smoke(0.2);
    RetimingQuestion q = question(5);
    q.velocity.scale = 2.0;
    const RetimingChoice twice = choose_retiming(q, [&](int n) { return smoke.frame(n); });
    EXPECT_NEAR(twice.velocity.scale, 2.0 * kVoxel, 0.06 * kVoxel) << "it multiplies what is fitted, too";
}

}  // namespace
}  // namespace brisance::testing
