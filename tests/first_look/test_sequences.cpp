// A sequence gets one look, whichever of its frames are rendered, from the files on disk alone.
#include <gtest/gtest.h>

#include "ball.h"
#include "first_look/look_file.h"
#include "make_vdb.h"
#include "temp_folder.h"

namespace brisance {
namespace {

// A ball that grows from nothing, with a flame in frame `burning` only.
void write_frames(const TempFolder& folder, int count, int burning) {
    for (int frame = 1; frame <= count; ++frame) {
        TestGrid density, flame;
        flame.name = "flame";
        const double radius = 0.8 * (frame - 1);
        density.voxels =
            fill_box(ivec3(-10), ivec3(10), [&](const ivec3& i) { return glm::length(dvec3(i)) < radius ? 1.0 : 0.0; });
        std::erase_if(density.voxels, [](const TestVoxel& v) { return v.value.x == 0.0; });
        if (frame == burning)
            flame.voxels = density.voxels;
        char name[32];
        std::snprintf(name, sizeof(name), "ball_%04d.vdb", frame);
        write_vdb(folder / name, {density, flame});
    }
}

std::string look_text(const TempFolder& folder) {
    Progress silent;
    return look_to_json(decide_look(survey_sequence((folder / "ball_####.vdb").string(), {}, silent), {}));
}

TEST(FirstLookSequence, FirstLastAndQuartersAndTheLargestAreLookedAt) {
    const TempFolder folder;
    std::vector<FrameFile> all;
    for (int frame = 1; frame <= 21; ++frame) {
        all.push_back({frame, folder / std::to_string(frame)});
        write_bytes(all.back().file, std::string(frame == 8 ? 100 : 10, 'x'));
    }
    std::vector<int> frames;
    for (const FrameFile& frame : telling_frames(all))
        frames.push_back(frame.frame);
    EXPECT_EQ(frames, (std::vector<int>{1, 6, 8, 11, 16, 21}));
    EXPECT_EQ(telling_frames({all[0]}).size(), 1u);
    EXPECT_TRUE(telling_frames({}).empty());
}

TEST(FirstLookSequence, AFlameThatBurnsInOneFrameOnlyIsFound) {
    const TempFolder folder;
    write_frames(folder, 11, 4);
    Progress silent;
    const Look look = decide_look(survey_sequence((folder / "ball_####.vdb").string(), {}, silent), {});
    EXPECT_EQ(value_of(look, "fire.model"), "flame");
    EXPECT_EQ(look.frames.size(), 11u);
    EXPECT_TRUE(std::ranges::find(look.looked_at, 4) != look.looked_at.end());
    EXPECT_EQ(look_text(folder), look_to_json(look)) << "twice the same";
}

TEST(FirstLookSequence, AnEmptyFirstFrameDoesNotDecide) {
    const TempFolder folder;
    write_frames(folder, 6, 3);
    Progress silent;
    const Look look = decide_look(survey_sequence((folder / "ball_####.vdb").string(), {}, silent), {});
    EXPECT_NE(look.find("camera.eye"), nullptr);
    EXPECT_LT(value_of(look, "smoke.extinction_per_metre").get<double>(), 10.0);
}

TEST(FirstLookSequence, ADamagedFrameDoesNotKeepTheOthersFromALook) {
    const TempFolder folder;
    write_frames(folder, 6, 3);
    write_bytes(folder / "ball_0001.vdb", "damaged");
    EXPECT_TRUE(contains(look_text(folder), "fire.model"));
    for (int frame = 1; frame <= 6; ++frame)
        write_bytes(folder / ("ball_000" + std::to_string(frame) + ".vdb"), "damaged");
    EXPECT_EQ(failure_of([&] { look_text(folder); }).code, ExitCode::BadData);
}

}  // namespace
}  // namespace brisance
