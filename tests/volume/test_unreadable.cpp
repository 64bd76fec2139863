// Files that cannot be read are rejected with one line that names a remedy.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>

#include "make_vdb.h"
#include "temp_folder.h"
#include "volume/vdb_file.h"

namespace brisance {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// Writes one grid and expects list_grids to call it unusable and read_grid to refuse it, both for the same reason.
void expect_unusable(const TestGrid& grid, const std::string& reason) {
    const TempFolder folder;
    write_vdb(folder / "grid.vdb", {grid});
    const GridInfo info = list_grids(folder / "grid.vdb").front();
    EXPECT_FALSE(info.usable);
    EXPECT_TRUE(contains(info.why_unusable, reason)) << info.why_unusable;
    const Failure failure = failure_of([&] { read_grid(folder / "grid.vdb", grid.name, 0, kPlentyOfMemory); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, reason)) << failure.message;
    EXPECT_TRUE(contains(failure.message, "grid.vdb")) << failure.message;
}

TestGrid small_grid() {
    TestGrid grid;
    grid.voxels =
        fill_box({0, 0, 0}, {20, 20, 20}, [](const ivec3& i) { return 1.0 + i.x * 0.37 + i.y * i.z * 0.011; });
    return grid;
}

TEST(Unreadable, AMissingFileIsMissingInput) {
    const TempFolder folder;
    const Failure failure = failure_of([&] { list_grids(folder / "none.vdb"); });
    EXPECT_EQ(failure.code, ExitCode::MissingInput);
    EXPECT_TRUE(contains(failure.message, "none.vdb"));
    EXPECT_TRUE(contains(failure_of([&] { list_grids(folder / "no/none.vdb"); }).message, "does not exist either"));
}

TEST(Unreadable, AFolderIsNoFile) {
    const TempFolder folder;
    EXPECT_EQ(failure_of([&] { list_grids(folder.path()); }).code, ExitCode::BadData);
}

TEST(Unreadable, FilesOfOtherKindsAreNamed) {
    const TempFolder folder;
    const std::pair<std::string, std::string> kinds[] = {
        {"", "empty"},
        {"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 84066196\n", "git lfs pull"},
        {"hello, I am a text\n", "text"},
        {"<!DOCTYPE html><html></html>", "download"},
        {"\x1f\x8b\x08 something", "unpack"},
        {std::string(300, '\0'), "unfinished copy"},
        {"\x01\x02\x03\x04\x05", "01 02 03 04 05"},
        {" BD", "ends within"},
    };
    for (const auto& [bytes, words] : kinds) {
        write_bytes(folder / "file.vdb", bytes);
        const Failure failure = failure_of([&] { list_grids(folder / "file.vdb"); });
        EXPECT_EQ(failure.code, ExitCode::BadData);
        EXPECT_TRUE(contains(failure.message, words)) << failure.message;
    }
}

TEST(Unreadable, ATruncatedFileIsNeverReadAtAnyLength) {
    const TempFolder folder;
    TestGrid flame = small_grid();
    flame.name = "flame";
    write_vdb(folder / "whole.vdb", {small_grid(), flame});
    const std::string bytes = bytes_of(folder / "whole.vdb");
    for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 200) {
        write_bytes(folder / "cut.vdb", bytes.substr(0, length));
        const Failure listed = failure_of([&] { list_grids(folder / "cut.vdb"); });
        EXPECT_EQ(listed.code, ExitCode::BadData) << length;
        EXPECT_EQ(failure_of([&] { read_grid(folder / "cut.vdb", "density", 0, kPlentyOfMemory); }).code,
                  ExitCode::BadData);
    }
    write_bytes(folder / "cut.vdb", bytes.substr(0, bytes.size() - 1));
    EXPECT_TRUE(contains(failure_of([&] { list_grids(folder / "cut.vdb"); }).message, "truncated"));
}

TEST(Unreadable, DamagedBytesGiveAnErrorOrAGridButNeverACrash) {
    const TempFolder folder;
    write_vdb(folder / "whole.vdb", {small_grid()});
    const std::string bytes = bytes_of(folder / "whole.vdb");
    for (std::size_t at = 8; at < std::min<std::size_t>(bytes.size(), 120); ++at) {
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ 0xff);
        write_bytes(folder / "damaged.vdb", damaged);
        const Failure failure = failure_of([&] { list_grids(folder / "damaged.vdb"); });
        EXPECT_TRUE(failure.code == ExitCode::Success || failure.code == ExitCode::BadData) << at;
    }
}

// Bytes of the candle that comes with the program, one place of them changed.
std::string candle_with(std::size_t at, const std::string& bytes) {
    return bytes_of(BRISANCE_VOLUMES "/candle.vdb").replace(at, bytes.size(), bytes);
}

// OpenVDB reads a block before it looks at its size: here a negative one, and the rest of the file overflows the heap.
// What lies there decides whether that ends the child or OpenVDB throws, with a heap that cannot be trusted.
TEST(Unreadable, ABlockThatOverflowsTheHeapOfOpenVdbIsOneLineAndSparesTheOtherGrid) {
    const TempFolder folder;
    write_bytes(folder / "damaged.vdb", candle_with(41465, "\xff"));
    VdbReader reader(folder / "damaged.vdb");
    const Failure failure = failure_of([&] { reader.read("density", 0, kPlentyOfMemory); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "damaged.vdb: ")) << failure.message;
    const BlockGrid temperature = reader.read("temperature", 0, kPlentyOfMemory);
    EXPECT_EQ(temperature.values, read_grid(BRISANCE_VOLUMES "/candle.vdb", "temperature", 0, kPlentyOfMemory).values);
}

// The root's number of tiles, 2^31 - 1: OpenVDB would read on and on at the end of the file.
TEST(Unreadable, ARootOfMoreTilesThanFitIsOneLine) {
    const TempFolder folder;
    write_bytes(folder / "damaged.vdb", candle_with(862, "\xff\xff\xff\x7f"));
    const Failure failure = failure_of([&] { list_grids(folder / "damaged.vdb"); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "2147483647 tiles")) << failure.message;
}

// The same in a streamed file, whose trees cannot be found without OpenVDB.
TEST(Unreadable, AFileThatIsReadForEverRunsOutOfTime) {
    const TempFolder folder;
    write_vdb_stream(folder / "stream.vdb", {small_grid()});
    std::string bytes = bytes_of(folder / "stream.vdb");
    const std::string transform = "UniformScaleMap";
    const std::size_t found = bytes.find(transform);
    ASSERT_NE(found, std::string::npos);
    const std::size_t tiles = found + transform.size() + 15 * sizeof(double) + 4 + sizeof(float);
    write_bytes(folder / "damaged.vdb", bytes.replace(tiles, 4, "\xff\xff\xff\x7f"));
    const Failure failure = failure_of([&] { list_grids(folder / "damaged.vdb"); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "more than 5 s")) << failure.message;
}

// Streamed files have no table to check a length against.
TEST(Unreadable, ALengthOfGigabytesIsRefused) {
    const TempFolder folder;
    write_vdb_stream(folder / "stream.vdb", {small_grid()});
    std::string bytes = bytes_of(folder / "stream.vdb");
    const std::size_t name = bytes.find("density");
    ASSERT_NE(name, std::string::npos);
    write_bytes(folder / "damaged.vdb", bytes.replace(name - 4, 4, "\xff\xff\xff\x7f"));
    const Failure failure = failure_of([&] { list_grids(folder / "damaged.vdb"); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their allocators end the process
    EXPECT_TRUE(contains(failure.message, "memory")) << failure.message;
#endif
}

TEST(Unreadable, AFileWithoutGridsSaysSo) {
    const TempFolder folder;
    write_vdb(folder / "none.vdb", {});
    const Failure failure = failure_of([&] { list_grids(folder / "none.vdb"); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "no grid at all"));
}

TEST(Unreadable, LevelSetsAndPointsTellHowToConvert) {
    TestGrid level_set = small_grid();
    level_set.grid_class = TestClass::LevelSet;
    expect_unusable(level_set, "SDF to Fog");
    TestGrid points = small_grid();
    points.type = TestType::Points;
    expect_unusable(points, "rasterize");
}

TEST(Unreadable, FlagsAndIntegerVectorsAreNoAmounts) {
    TestGrid grid = small_grid();
    for (const TestType type : {TestType::Bool, TestType::Mask}) {
        grid.type = type;
        expect_unusable(grid, "on/off");
    }
    grid.type = TestType::Vec3i;
    expect_unusable(grid, "vec3i");
}

TEST(Unreadable, AFrustumIsNoAffineTransform) {
    TestGrid grid = small_grid();
    grid.frustum = true;
    expect_unusable(grid, "frustum");
}

TEST(Unreadable, SingularAndNonFiniteTransformsAreRefused) {
    constexpr double voxel = 0.123456789, infinity = std::numeric_limits<double>::infinity();
    const dmat4 uniform{dmat3(voxel)};
    dmat4 general = uniform;
    general[1][0] = 0.5;
    for (const dmat4& matrix : {uniform, general}) {
        for (const double bad : {0.0, std::numeric_limits<double>::quiet_NaN(), infinity}) {
            const TempFolder folder;
            TestGrid grid = small_grid();
            grid.world_from_index = matrix;
            write_vdb(folder / "grid.vdb", {grid});
            ASSERT_GT(patch_doubles(folder / "grid.vdb", voxel, bad), 0);
            const GridInfo info = list_grids(folder / "grid.vdb").front();
            EXPECT_FALSE(info.usable) << bad;
            EXPECT_FALSE(info.why_unusable.empty());
            const Failure failure = failure_of([&] { read_grid(folder / "grid.vdb", "density", 0, kPlentyOfMemory); });
            EXPECT_EQ(failure.code, ExitCode::BadData) << bad;
        }
    }
}

TEST(Unreadable, OneBadGridDoesNotHideTheGoodOnes) {
    const TempFolder folder;
    TestGrid bad = small_grid(), good = small_grid();
    bad.name = "flat";
    bad.world_from_index = dmat4(dmat3(0.123456789));
    write_vdb(folder / "grid.vdb", {bad, good});
    patch_doubles(folder / "grid.vdb", 0.123456789, 0.0);
    const std::vector<GridInfo> infos = list_grids(folder / "grid.vdb");
    ASSERT_EQ(infos.size(), 2u);
    EXPECT_FALSE(infos[0].usable);
    EXPECT_TRUE(infos[1].usable);
    EXPECT_FALSE(read_grid(folder / "grid.vdb", "density", 0, kPlentyOfMemory).empty());
}

TEST(Unreadable, StrayVoxelsFarAwayAreRefusedWithTheirNumbers) {
    const TempFolder folder;
    TestGrid grid;
    grid.voxels = {{{0, 0, 0}, dvec3(1.0)}, {{0, 2000000000, 0}, dvec3(1.0)}};
    write_vdb(folder / "far.vdb", {grid});
    const Failure failure = failure_of([&] { read_grid(folder / "far.vdb", "density", 0, kPlentyOfMemory); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "2000000001 voxels")) << failure.message;
}

TEST(Unreadable, NothingIsExpandedBeyondTheMemoryLimit) {
    const TempFolder folder;
    TestGrid grid;
    grid.tiles = {{{0, 0, 0}, 3, dvec3(1.0)}};  // 4096^3 voxels in a file of a few hundred bytes
    write_vdb(folder / "huge.vdb", {grid});
    const Failure failure = failure_of([&] { read_grid(folder / "huge.vdb", "density", 0, kPlentyOfMemory); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "1024.0 MiB")) << failure.message;
    EXPECT_TRUE(contains(failure.message, "134217728")) << failure.message;

    write_vdb(folder / "small.vdb", {small_grid()});
    EXPECT_EQ(failure_of([&] { read_grid(folder / "small.vdb", "density", 0, 1000); }).code, ExitCode::BadData);
    EXPECT_EQ(failure_of([&] { read_grid(folder / "small.vdb", "density", 0, 200000); }).code, ExitCode::Success);
}

}  // namespace
}  // namespace brisance
