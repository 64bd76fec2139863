// A simulated explosion: frames made from their neighbours, against what was simulated. Needs BRISANCE_DATA.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "retiming/between_frames.h"
#include "retiming/choose_retiming.h"
#include "volume/frame_path.h"

namespace brisance::testing {
namespace {

SourceFrame read_simulated(const std::string& pattern, int frame) {
    constexpr std::uint64_t plenty = std::uint64_t{1} << 32;
    VdbReader reader(resolve_frame(pattern, frame));
    return {{reader.read("density", 0, plenty)}, centred_velocity({reader.read("velocity", 0, plenty)})};
}

TEST(RealSequence, AnExplosionFollowsItsVelocity) {
    const char* const data = std::getenv("BRISANCE_DATA");
    const std::string pattern = std::string(data == nullptr ? "" : data) + "/volumes/fireball/fireball_####.vdb";
    if (data == nullptr || frames_on_disk(pattern).empty())
        GTEST_SKIP() << "BRISANCE_DATA has no volumes/fireball";
    RetimingQuestion question;
    question.on_disk = frames_on_disk(pattern);
    question.role_name = "density";
    question.has_velocity = true;
    question.where = pattern;
    const RetimingChoice choice = choose_retiming(question, [&](int n) { return read_simulated(pattern, n); });
    EXPECT_EQ(choice.retime, Retime::Advect);
    EXPECT_GT(choice.fit->voxels_per_frame(), 0.06);
    EXPECT_LT(choice.fit->voxels_per_frame(), 0.105) << "0.083 to 0.090 by its centre of mass, 0.104 by its maker";
    const BlockGrid truth = *read_simulated(pattern, 15).fields[0];
    const BetweenFrames pair{read_simulated(pattern, 14), read_simulated(pattern, 16), 0.5, 2, pattern};
    EXPECT_NEAR(relative_error(*blended(pair)[0], truth), 0.413, 0.005);
    EXPECT_LT(relative_error(*advected(pair, choice.velocity)[0], truth), 0.32);
}

}  // namespace
}  // namespace brisance::testing
