// Numbered files: tokens, lists, holes.
#include <gtest/gtest.h>

#include "temp_folder.h"
#include "volume/frame_path.h"

namespace brisance {
namespace {

TEST(FramePath, EveryTokenExpands) {
    EXPECT_EQ(expand("a.####.vdb", 7), "a.0007.vdb");
    EXPECT_EQ(expand("a.@@@.vdb", 7), "a.007.vdb");
    EXPECT_EQ(expand("a.%04d.vdb", 7), "a.0007.vdb");
    EXPECT_EQ(expand("a.%d.vdb", 7), "a.7.vdb");
    EXPECT_EQ(expand("a.$F4.vdb", 7), "a.0007.vdb");
    EXPECT_EQ(expand("a.$F.vdb", 7), "a.7.vdb");
    EXPECT_EQ(expand("a.<frame04>.vdb", 7), "a.0007.vdb");
    EXPECT_EQ(expand("a.<frame>.vdb", 7), "a.7.vdb");
    EXPECT_EQ(expand("####/a.#.exr", 7), "0007/a.7.exr");
    EXPECT_EQ(expand("a.vdb", 7), "a.vdb");
}

TEST(FramePath, WidthIsAMinimum) {
    EXPECT_EQ(expand("a.###.vdb", 1000), "a.1000.vdb");
    EXPECT_EQ(expand("a.$F4.vdb", 12345), "a.12345.vdb");
    EXPECT_EQ(expand("a.%04d.vdb", -5), "a.-005.vdb");
}

TEST(FramePath, WhatStaysUnexpandedIsAnError) {
    for (const char* pattern : {"$HIP/a.vdb", "a.$FF.vdb", "a.%4d.vdb", "a.<udim>.vdb", "${JOB}/a.####.vdb"})
        EXPECT_EQ(failure_of([&] { expand(pattern, 1); }).code, ExitCode::Usage) << pattern;
    EXPECT_EQ(expand("me@home/50% off/a#1/x.####.vdb", 2), "me@home/50% off/a#1/x.0002.vdb")
        << "single signs in folders mean themselves";
}

TEST(FrameList, ReadsRangesStepsAndSingles) {
    EXPECT_EQ(parse_frames("1001-1010x4,1200"), (std::vector<int>{1001, 1005, 1009, 1200}));
    EXPECT_EQ(parse_frames("1..4"), (std::vector<int>{1, 2, 3, 4}));
    EXPECT_EQ(parse_frames(" 5 "), (std::vector<int>{5}));
    EXPECT_EQ(parse_frames("-2-1"), (std::vector<int>{-2, -1, 0, 1}));
    EXPECT_EQ(parse_frames("10,1-3,2"), (std::vector<int>{10, 1, 2, 3})) << "each once, in the order written";
}

TEST(FrameList, RefusesWhatIsAmbiguousOrSenseless) {
    EXPECT_TRUE(contains(failure_of([] { parse_frames("1-10:2"); }).message, "interleaving"));
    for (const char* list : {"", "a", "1-", "1,,2", "10-1", "1-5x0", "1001.5", "1-99999999999", "0-2000000000"})
        EXPECT_EQ(failure_of([&] { parse_frames(list); }).code, ExitCode::Usage) << list;
}

TEST(FrameList, DescribesRunsShortly) {
    EXPECT_EQ(describe_frames({88, 89, 90, 92, 94, 95}), "88-90, 92, 94-95");
    EXPECT_EQ(describe_frames({}), "");
}

TEST(Sequence, AMissingFrameNamesThePathAndTheFramesThatExist) {
    const TempFolder folder;
    for (int frame = 88; frame <= 102; ++frame)
        if (frame != 91)
            write_bytes(expand((folder / "data_####.vdb").string(), frame), "x");
    const std::string pattern = (folder / "data_####.vdb").string();
    const Failure failure = failure_of([&] { resolve_frame(pattern, 91); });
    EXPECT_EQ(failure.code, ExitCode::MissingInput);
    EXPECT_TRUE(contains(failure.message, "frame 91 is missing")) << failure.message;
    EXPECT_TRUE(contains(failure.message, "data_0091.vdb; frames 88-90, 92-102 exist")) << failure.message;
    EXPECT_EQ(resolve_frame(pattern, 92), folder / "data_0092.vdb");
    EXPECT_EQ(failure_of([&] { resolve_sequence(pattern, std::vector<int>{90, 91}); }).code, ExitCode::MissingInput);
    EXPECT_EQ(resolve_sequence(pattern, std::nullopt).size(), 14u) << "all there are, holes included";
}

TEST(Sequence, UnpaddedNumbersSortAsNumbers) {
    const TempFolder folder;
    for (int frame = 1; frame <= 10; ++frame)
        write_bytes(folder / ("sim1." + std::to_string(frame) + ".vdb"), "x");
    for (const char* token : {"$F", "#", "%d"}) {
        const std::string pattern = (folder / (std::string("sim1.") + token + ".vdb")).string();
        EXPECT_EQ(describe_frames(frames_on_disk(pattern)), "1-10");
        EXPECT_EQ(resolve_sequence(pattern, std::nullopt).back().file, folder / "sim1.10.vdb");
    }
}

TEST(Sequence, WrongPaddingIsExplained) {
    const TempFolder folder;
    write_bytes(folder / "a.0007.vdb", "x");
    const Failure failure = failure_of([&] { resolve_frame((folder / "a.##.vdb").string(), 7); });
    EXPECT_TRUE(contains(failure.message, "other padding exists: a.0007.vdb; write a.####.vdb")) << failure.message;
    EXPECT_TRUE(
        contains(failure_of([&] { resolve_frame((folder / "no/a.##.vdb").string(), 7); }).message, "does not exist"));
}

TEST(Sequence, TokensInFoldersMustAgreeWithTheFile) {
    const TempFolder folder;
    for (const char* name : {"0001/a.1.vdb", "0002/a.3.vdb", "0004/a.4.vdb"}) {
        std::filesystem::create_directories((folder / name).parent_path());
        write_bytes(folder / name, "x");
    }
    EXPECT_EQ(frames_on_disk((folder / "####/a.#.vdb").string()), (std::vector<int>{1, 4}));
}

TEST(Sequence, ANumberedFileIsOneFileForOneFrame) {
    const TempFolder folder;
    write_bytes(folder / "fireball_0015.vdb", "x");
    write_bytes(folder / "cloud.vdb", "x");
    const std::string numbered = (folder / "fireball_0015.vdb").string(), plain = (folder / "cloud.vdb").string();
    EXPECT_EQ(resolve_sequence(numbered, std::nullopt).front().frame, 15);
    EXPECT_EQ(resolve_sequence(numbered, std::vector<int>{3}).front().frame, 3);
    const Failure failure = failure_of([&] { resolve_sequence(numbered, std::vector<int>{1, 2}); });
    EXPECT_EQ(failure.code, ExitCode::Usage);
    EXPECT_TRUE(contains(failure.message, "fireball_####.vdb")) << failure.message;
    EXPECT_EQ(resolve_sequence(plain, std::vector<int>{1, 2}).size(), 2u) << "a still volume, a moving camera";
}

TEST(Sequence, PatternsAreFoundFromFiles) {
    EXPECT_EQ(pattern_of("x/fireball_0015.vdb"), "x/fireball_####.vdb");
    EXPECT_EQ(pattern_of("Sim.filecache1.5.vdb"), "Sim.filecache1.#.vdb");
    EXPECT_EQ(pattern_of("take2/cloud.vdb"), std::nullopt);
    EXPECT_EQ(frame_number_of("a.1001.vdb"), 1001);
    EXPECT_EQ(frame_number_of("cloud.vdb"), std::nullopt);
}

}  // namespace
}  // namespace brisance
