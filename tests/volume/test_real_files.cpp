// Files from several tools, where they are at hand: BRISANCE_DATA names a folder with volumes/ in it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "make_vdb.h"
#include "temp_folder.h"
#include "volume/frame_path.h"
#include "volume/mapping.h"
#include "volume/vdb_file.h"

namespace brisance {
namespace {

class RealFiles : public testing::Test {
protected:
    void SetUp() override {
        const char* const folder = std::getenv("BRISANCE_DATA");
        if (folder == nullptr || !std::filesystem::is_directory(std::filesystem::path(folder) / "volumes"))
            GTEST_SKIP() << "set BRISANCE_DATA to a folder with volumes/ in it";
        volumes = std::filesystem::path(folder) / "volumes";
    }
    std::filesystem::path volumes;
};

BlockGrid read_density(const std::filesystem::path& file) {
    const GridMapping mapping = map_grids(list_grids(file), {}, file.string());
    return read_grid(file, mapping.density->name, mapping.density->index, kPlentyOfMemory);
}

TEST_F(RealFiles, OddOnesAreReadOrRefusedInOneLine) {
    for (const auto& entry : std::filesystem::directory_iterator(volumes / "odd")) {
        const Failure failure = failure_of([&] {
            const std::vector<GridInfo> grids = list_grids(entry.path());
            for (const GridInfo& grid : grids) {
                census_of_grid(entry.path(), grid.name, grid.index, 8);
                if (!grid.usable)
                    continue;
                const BlockGrid read = read_grid(entry.path(), grid.name, grid.index, kPlentyOfMemory);
                for (const float value : read.values)
                    ASSERT_TRUE(std::isfinite(value));
            }
        });
        const std::string name = entry.path().filename().string();
        const bool bad = name.starts_with("bad_") || name == "zero_grids.vdb";
        EXPECT_EQ(failure.code, bad ? ExitCode::BadData : ExitCode::Success) << name << ": " << failure.message;
    }
}

TEST_F(RealFiles, CountsAreThoseOfTheirMakers) {
    EXPECT_EQ(read_density(volumes / "smoke/smoke1_openvdb_sample.vdb").census.active_voxels, 1049275u);
    EXPECT_EQ(read_density(volumes / "explosion/ground_explosion_0015.vdb").census.active_voxels, 383152u);
    const BlockGrid tiles =
        read_grid(volumes / "odd/constant_temperature_tiles.vdb", "temperature", 0, kPlentyOfMemory);
    EXPECT_EQ(tiles.census.active_voxels, 1000000u);
    EXPECT_GT(tiles.census.active_tiles, 0u);
}

TEST_F(RealFiles, SequencesAreFoundWithTheirHoles) {
    const std::string blender = (volumes / "fire_blender/fluid_data_####.vdb").string();
    EXPECT_EQ(describe_frames(frames_on_disk(blender)), "88-90, 92-102");
    EXPECT_EQ(failure_of([&] { resolve_frame(blender, 91); }).code, ExitCode::MissingInput);
    const std::string houdini = (volumes / "houdini_unpadded/HoudiniSimulation.filecache1.$F.vdb").string();
    EXPECT_EQ(describe_frames(frames_on_disk(houdini)), "1-10");
    EXPECT_TRUE(read_density(resolve_frame(houdini, 1)).empty());
    EXPECT_FALSE(read_density(resolve_frame(houdini, 10)).empty());
}

}  // namespace
}  // namespace brisance
