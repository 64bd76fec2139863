// The files that frames are made of.
#include <gtest/gtest.h>

#include <algorithm>

#include "farm/input_files.h"
#include "shot/read_shot.h"
#include "volume/temp_folder.h"

namespace brisance {
namespace {

constexpr const char* kGltf = R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "set%20one.bin", "byteLength": 4}],
    "images": [{"uri": "wall.png"}, {"uri": "data:image/png;base64,AAAA"}]})";

TEST(InputFiles, AreThoseOfTheShotAndOfWhatItNames) {
    const TempFolder folder;
    write_bytes(folder / "set.gltf", kGltf);
    write_bytes(folder / "set one.bin", "1234");
    for (const char* name : {"smoke_0003.vdb", "haze.vdb", "wall.png", "sky.exr"})
        write_bytes(folder / name, "x");
    const Shot shot = parse_shot(
        R"({"volume": {"file": "smoke_####.vdb"}, "volumes": [{"file": "haze.vdb"}],
            "scene": {"files": [{"file": "set.gltf"}, {"file": "set.gltf"}],
                      "lights": [{"kind": "environment", "file": "sky.exr"}]}})",
        "a.json", folder.path(), {});
    std::vector<std::filesystem::path> expected;
    for (const char* name : {"smoke_0003.vdb", "haze.vdb", "set.gltf", "set one.bin", "wall.png", "sky.exr"})
        expected.push_back((folder / name).lexically_normal());
    EXPECT_EQ(input_files(shot, {3, folder / "smoke_0003.vdb"}), expected);
    EXPECT_EQ(volume_files(shot, {3, folder / "smoke_0003.vdb"}).size(), 2u);
}

TEST(InputFiles, AMissingVolumeIsMissingInput) {
    const TempFolder folder;
    const Shot shot = parse_shot(R"({"volume": {"file": "a.vdb"}, "volumes": [{"file": "haze_####.vdb"}]})", "a.json",
                                 folder.path(), {});
    EXPECT_EQ(failure_of([&] { input_files(shot, {3, folder / "a.vdb"}); }).code, ExitCode::MissingInput);
}

}  // namespace
}  // namespace brisance
