// Grids that are read ahead are those that are read when they are needed.
#include <gtest/gtest.h>

#include "make_vdb.h"
#include "temp_folder.h"
#include "volume/read_ahead.h"

namespace brisance {
namespace {

const std::vector<GridName> kBoth = {{"density", 0}, {"flame", 0}};

// A file of two grids that differ from file to file.
void write_pair(const std::filesystem::path& file, double value) {
    TestGrid density, flame;
    density.voxels = fill_box(ivec3(-9), ivec3(9), [&](const ivec3& i) { return value + i.x; });
    flame.name = "flame";
    flame.voxels = fill_box(ivec3(0), ivec3(5), [&](const ivec3& i) { return value - i.z; });
    write_vdb(file, {density, flame});
}

TEST(ReadAhead, GivesTheSameGrids) {
    const TempFolder folder;
    write_pair(folder / "a.vdb", 1.0);
    write_pair(folder / "b.vdb", 2.0);
    ReadAhead ahead;
    ahead.begin({{folder / "a.vdb", kBoth}, {folder / "b.vdb", {{"flame", 0}}}}, kPlentyOfMemory);
    for (const auto& [name, grids] : {std::pair("b.vdb", 1u), std::pair("a.vdb", 2u)}) {
        std::optional<ReadAhead::File> file = ahead.take(folder / name);
        ASSERT_TRUE(file) << name;
        EXPECT_EQ(file->grids.size(), 2u);
        EXPECT_EQ(file->voxels.size(), grids);
        for (const auto& [grid, voxels] : file->voxels) {
            const BlockGrid now = read_grid(folder / name, grid.first, grid.second, kPlentyOfMemory);
            EXPECT_EQ(voxels.block_origin, now.block_origin);
            EXPECT_EQ(voxels.values, now.values);
        }
        EXPECT_FALSE(ahead.take(folder / name)) << "it is given away once";
    }
}

TEST(ReadAhead, LeavesErrorsToTheFrameThatReads) {
    const TempFolder folder;
    write_pair(folder / "a.vdb", 1.0);
    write_bytes(folder / "damaged.vdb", "no volume");
    ReadAhead ahead;
    ahead.begin({{folder / "absent.vdb", kBoth}, {folder / "damaged.vdb", kBoth}, {folder / "a.vdb", {{"smoke", 0}}}},
                kPlentyOfMemory);
    for (const char* name : {"absent.vdb", "damaged.vdb", "a.vdb", "never_asked_for.vdb"})
        EXPECT_FALSE(ahead.take(folder / name)) << name;
}

TEST(ReadAhead, AFileThatChangedIsReadAgain) {
    const TempFolder folder;
    write_pair(folder / "a.vdb", 1.0);
    ReadAhead ahead;
    ahead.begin({{folder / "a.vdb", kBoth}}, kPlentyOfMemory);
    std::filesystem::last_write_time(folder / "a.vdb",
                                     std::filesystem::last_write_time(folder / "a.vdb") + std::chrono::seconds(5));
    EXPECT_FALSE(ahead.take(folder / "a.vdb"));
}

TEST(ReadAhead, MayBeLeftUnfinished) {
    const TempFolder folder;
    write_pair(folder / "a.vdb", 1.0);
    ReadAhead ahead;
    for (int i = 0; i < 3; ++i)
        ahead.begin({{folder / "a.vdb", kBoth}}, kPlentyOfMemory);
}

}  // namespace
}  // namespace brisance
