// What decides a frame's bits, and what does not.
#include <gtest/gtest.h>

#include "farm/frame_stamp.h"
#include "shot/read_shot.h"
#include "volume/temp_folder.h"

namespace brisance {
namespace {

// A shot of two files whose contents the test chooses: stamps look at bytes alone.
class Stamped {
public:
    Stamped() {
        write("smoke_0003.vdb", "smoke");
        write("haze.vdb", "haze");
    }
    void write(const std::string& name, const std::string& bytes) { write_bytes(folder_ / name, bytes); }

    std::string stamp(const std::vector<std::string>& overrides = {}, const std::string& version = "1.0",
                      int frame = 3) const {
        const Shot shot = parse_shot(R"({"volume": {"file": "smoke_####.vdb"}, "volumes": [{"file": "haze.vdb"}]})",
                                     "a.json", folder_.path(), {"", overrides});
        return FrameStamps(shot, version).of({frame, folder_ / "smoke_0003.vdb"});
    }

private:
    TempFolder folder_;
};

TEST(FrameStamp, EqualInputsGiveEqualStamps) {
    const Stamped shot;
    EXPECT_EQ(shot.stamp(), shot.stamp());
    EXPECT_EQ(stamp_difference(shot.stamp(), shot.stamp()), std::nullopt);
    EXPECT_EQ(shot.stamp({"output.path=elsewhere.exr"}), shot.stamp()) << "where it is written decides nothing";
}

TEST(FrameStamp, NamesWhatDiffers) {
    Stamped shot;
    const std::string before = shot.stamp();
    const auto why = [&](const std::string& stamp) { return stamp_difference(before, stamp).value_or("nothing"); };
    EXPECT_TRUE(contains(why(shot.stamp({"smoke.albedo=0.1"})), "settings"));
    EXPECT_TRUE(contains(why(shot.stamp({}, "1.1")), "version 1.0"));
    EXPECT_TRUE(contains(why(shot.stamp({}, "1.0", 4)), "frame 3"));
    shot.write("haze.vdb", "HAZE");
    EXPECT_EQ(why(shot.stamp()), "haze.vdb has other contents now") << "the same size";
    shot.write("haze.vdb", "haze");
    EXPECT_EQ(why(shot.stamp()), "nothing") << "written again with the same contents";
}

TEST(FrameStamp, DamageIsADifference) {
    const Stamped shot;
    for (const char* damaged : {"", "{", "[]", "{}", R"({"version": 3})", "null"})
        EXPECT_TRUE(stamp_difference(damaged, shot.stamp())) << damaged;
}

}  // namespace
}  // namespace brisance
