// What is written is read back: values, positions, counts.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <tuple>

#include "core/parallel.h"
#include "make_vdb.h"
#include "temp_folder.h"
#include "volume/vdb_file.h"

namespace brisance {
namespace {

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 30;

BlockGrid round_trip(const TestGrid& grid) {
    const TempFolder folder;
    write_vdb(folder / "grid.vdb", {grid});
    return read_grid(folder / "grid.vdb", grid.name, 0, kPlenty);
}

// The value at an index, 0 outside of all blocks.
float value_at(const BlockGrid& grid, const ivec3& index, int channel = 0) {
    for (std::size_t b = 0; b < grid.block_origin.size(); ++b) {
        const ivec3 local = index - grid.block_origin[b];
        if (glm::all(glm::greaterThanEqual(local, ivec3(0))) && glm::all(glm::lessThan(local, ivec3(8)))) {
            const auto i = static_cast<std::size_t>((local.x * 8 + local.y) * 8 + local.z);
            return grid
                .values[(b * 512 + i) * static_cast<std::size_t>(grid.channels) + static_cast<std::size_t>(channel)];
        }
    }
    return 0.0f;
}

double linear(const ivec3& i) {
    return 100.0 + 1.0 * i.x - 2.0 * i.y + 0.5 * i.z;
}

TEST(Reading, ReproducesALinearFieldAcrossBlocksAndNegativeIndices) {
    TestGrid grid;
    grid.voxels = fill_box({-11, -3, 5}, {9, 12, 18}, linear);
    const BlockGrid read = round_trip(grid);
    for (const TestVoxel& voxel : grid.voxels)
        ASSERT_EQ(value_at(read, voxel.index), static_cast<float>(voxel.value.x));
    EXPECT_EQ(value_at(read, {-12, 0, 8}), 0.0f);
    EXPECT_EQ(read.info.active_min, ivec3(-11, -3, 5));
    EXPECT_EQ(read.info.active_max, ivec3(9, 12, 18));
    EXPECT_EQ(read.census.active_voxels, grid.voxels.size());
}

TEST(Reading, AcceptsEveryNumberType) {
    for (const TestType type : {TestType::Float, TestType::Double, TestType::Int32, TestType::Int64}) {
        TestGrid grid;
        grid.type = type;
        grid.voxels = {{{1, 2, 3}, dvec3(7.0)}, {{40, 2, 3}, dvec3(9.0)}};
        const BlockGrid read = round_trip(grid);
        EXPECT_EQ(read.channels, 1);
        EXPECT_EQ(value_at(read, {1, 2, 3}), 7.0f);
        EXPECT_EQ(value_at(read, {40, 2, 3}), 9.0f);
        EXPECT_DOUBLE_EQ(read.census.mean, 8.0);
    }
}

TEST(Reading, KeepsThreeChannelsInterleaved) {
    for (const TestType type : {TestType::Vec3f, TestType::Vec3d}) {
        TestGrid grid;
        grid.name = "Cd";
        grid.type = type;
        grid.voxels = {{{5, 6, 7}, {0.25, 0.5, 1.0}}};
        const BlockGrid read = round_trip(grid);
        EXPECT_EQ(read.channels, 3);
        EXPECT_EQ(value_at(read, {5, 6, 7}, 0), 0.25f);
        EXPECT_EQ(value_at(read, {5, 6, 7}, 1), 0.5f);
        EXPECT_EQ(value_at(read, {5, 6, 7}, 2), 1.0f);
        EXPECT_NEAR(read.census.maximum, std::sqrt(0.0625 + 0.25 + 1.0), 1e-6);
    }
}

TEST(Reading, HalfFloatsLoseNoMoreThanTheirPrecision) {
    TestGrid grid;
    grid.half = true;
    grid.voxels = fill_box({0, 0, 0}, {15, 15, 15}, linear);
    const BlockGrid read = round_trip(grid);
    EXPECT_EQ(read.info.value_type, "half");
    for (const TestVoxel& voxel : grid.voxels)
        ASSERT_NEAR(value_at(read, voxel.index), voxel.value.x, voxel.value.x / 2048.0);
}

TEST(Reading, ExpandsActiveTiles) {
    TestGrid grid;
    grid.tiles = {{{-16, 0, 8}, 1, dvec3(3.0)}, {{128, 128, 128}, 2, dvec3(2.0)}};
    grid.voxels = {{{0, 0, 0}, dvec3(1.0)}};
    const BlockGrid read = round_trip(grid);
    EXPECT_EQ(read.block_origin.size(), 1u + 1u + 16u * 16u * 16u);
    EXPECT_EQ(value_at(read, {-9, 7, 15}), 3.0f);
    EXPECT_EQ(value_at(read, {128, 255, 200}), 2.0f);
    EXPECT_EQ(value_at(read, {0, 0, 0}), 1.0f);
    EXPECT_EQ(read.census.active_tiles, 2u);
    EXPECT_EQ(read.census.active_voxels, 512u + 128u * 128u * 128u + 1u);
    EXPECT_EQ(read.info.active_max, ivec3(255));
}

TEST(Reading, BlocksAreAlignedSortedAndNeverAllZero) {
    TestGrid grid;
    grid.voxels = fill_box({-40, -40, -40}, {-30, -30, -30}, [](const ivec3&) { return 1.0; });
    grid.voxels.push_back({{200, 0, 0}, dvec3(0.0)});  // active, but nothing
    grid.voxels.push_back({{300, -9, 0}, dvec3(1.0)});
    grid.tiles = {{{4096, 0, 0}, 1, dvec3(0.0)}, {{64, 64, 64}, 1, dvec3(4.0)}};
    const BlockGrid read = round_trip(grid);
    const auto key = [](const ivec3& p) { return std::tuple(p.x, p.y, p.z); };
    for (std::size_t b = 0; b < read.block_origin.size(); ++b) {
        EXPECT_EQ(read.block_origin[b] % 8, ivec3(0));
        EXPECT_TRUE(b == 0 || key(read.block_origin[b - 1]) < key(read.block_origin[b]));
        float most = 0.0f;
        for (std::size_t i = 0; i < 512; ++i)
            most = std::max(most, read.values[b * 512 + i]);
        EXPECT_GT(most, 0.0f);
    }
    EXPECT_EQ(read.block_origin.size(), 8u + 2u);
    EXPECT_EQ(read.info.active_max, ivec3(4103, 71, 71)) << "bounds are those of all active voxels";
}

TEST(Reading, KeepsAnyAffineTransform) {
    const dmat4 rotated = glm::rotate(dmat4(0.25), 0.7, dvec3(1, 2, 3));
    dmat4 rotation_and_shift = rotated;
    rotation_and_shift[3] = glm::dvec4(10, -20, 30, 1);
    dmat4 sheared(1.0);
    sheared[1][0] = 0.5;
    dmat4 mirrored(1.0);
    mirrored[0][0] = -0.1;
    mirrored[2][2] = 3.0;
    const dmat4 tiny = glm::scale(dmat4(1.0), dvec3(1e-3));
    for (const dmat4& matrix : {rotation_and_shift, sheared, mirrored, tiny}) {
        TestGrid grid;
        grid.world_from_index = matrix;
        grid.voxels = {{{1, 1, 1}, dvec3(1.0)}};
        const BlockGrid read = round_trip(grid);
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                EXPECT_NEAR(read.info.world_from_index[i][j], matrix[i][j], 1e-9 + 1e-6 * std::abs(matrix[i][j]));
        EXPECT_NEAR(read.info.voxel_volume() / std::abs(glm::determinant(dmat3(matrix))), 1.0, 1e-6);
        EXPECT_TRUE(read.info.affine);
    }
}

TEST(Reading, TellsGridsOfOneNameApartByIndex) {
    const TempFolder folder;
    std::vector<TestGrid> grids(3);
    for (int i = 0; i < 3; ++i)
        grids[static_cast<std::size_t>(i)].voxels = {{{i, 0, 0}, dvec3(i + 1.0)}};
    write_vdb(folder / "three.vdb", grids);
    const std::vector<GridInfo> infos = list_grids(folder / "three.vdb");
    ASSERT_EQ(infos.size(), 3u);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(infos[static_cast<std::size_t>(i)].name, "density");
        EXPECT_EQ(infos[static_cast<std::size_t>(i)].index, i);
        const BlockGrid read = read_grid(folder / "three.vdb", "density", i, kPlenty);
        EXPECT_EQ(value_at(read, {i, 0, 0}), static_cast<float>(i + 1));
    }
    const Failure failure = failure_of([&] { read_grid(folder / "three.vdb", "density", 3, kPlenty); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "\"density[2]\"")) << failure.message;
}

TEST(Reading, FindsUnnamedGrids) {
    const TempFolder folder;
    TestGrid one, two;
    one.name = two.name = "";
    one.voxels = {{{0, 0, 0}, dvec3(1.0)}};
    two.voxels = {{{0, 0, 0}, dvec3(2.0)}};
    write_vdb(folder / "one.vdb", {one});
    write_vdb(folder / "two.vdb", {one, two});
    EXPECT_EQ(read_grid(folder / "one.vdb", "", 0, kPlenty).census.maximum, 1.0);
    EXPECT_EQ(read_grid(folder / "two.vdb", "", 1, kPlenty).census.maximum, 2.0);
}

TEST(Reading, AnEmptyGridIsValid) {
    const BlockGrid read = round_trip(TestGrid());
    EXPECT_TRUE(read.empty());
    EXPECT_TRUE(read.info.usable);
    EXPECT_EQ(read.census.active_voxels, 0u);
    EXPECT_EQ(read.census.maximum, 0.0);
    EXPECT_LT(read.info.active_max.x, read.info.active_min.x);
}

TEST(Reading, CountsAndClearsWhatIsNotFinite) {
    TestGrid grid;
    grid.type = TestType::Double;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    grid.voxels = {{{0, 0, 0}, dvec3(std::nan(""))}, {{1, 0, 0}, dvec3(infinity)}, {{2, 0, 0}, dvec3(-infinity)},
                   {{3, 0, 0}, dvec3(1e300)},        {{4, 0, 0}, dvec3(-2.0)},     {{5, 0, 0}, dvec3(4.0)}};
    const BlockGrid read = round_trip(grid);
    EXPECT_EQ(read.census.nan_voxels, 4u) << "too large for a float counts as infinite";
    EXPECT_EQ(read.census.negative_voxels, 1u);
    for (int x = 0; x < 4; ++x)
        EXPECT_EQ(value_at(read, {x, 0, 0}), 0.0f);
    EXPECT_EQ(value_at(read, {4, 0, 0}), -2.0f) << "negative values are kept";
    EXPECT_EQ(read.census.minimum, -2.0);
    EXPECT_EQ(read.census.maximum, 4.0);
    EXPECT_EQ(read.census.mean, 1.0);
}

TEST(Reading, NaNTilesAreCountedVoxelByVoxelAndDropped) {
    TestGrid grid;
    grid.tiles = {{{0, 0, 0}, 2, dvec3(std::nan(""))}};
    const BlockGrid read = round_trip(grid);
    EXPECT_TRUE(read.empty());
    EXPECT_EQ(read.census.nan_voxels, 128u * 128u * 128u);
}

TEST(Reading, TheNumberOfThreadsChangesNothing) {
    const TempFolder folder;
    TestGrid grid;
    grid.voxels =
        fill_box({-30, -30, -30}, {30, 30, 30}, [](const ivec3& i) { return std::sin(i.x * 12.9 + i.y * 78.2 + i.z); });
    write_vdb(folder / "noise.vdb", {grid});
    const auto read_with = [&](int threads) {
        const ThreadLimit limit(threads);
        return read_grid(folder / "noise.vdb", "density", 0, kPlenty);
    };
    const BlockGrid one = read_with(1), seven = read_with(7);
    EXPECT_EQ(one.values, seven.values);
    EXPECT_EQ(one.block_origin, seven.block_origin);
    EXPECT_EQ(one.census.mean, seven.census.mean);
}

TEST(Reading, FilesWithoutStatisticsStillGiveTheirBounds) {
    const TempFolder folder;
    TestGrid grid;
    grid.voxels = {{{-3, 4, 5}, dvec3(1.0)}, {{10, 11, 12}, dvec3(1.0)}};
    write_vdb(folder / "bare.vdb", {grid}, false);
    const GridInfo info = list_grids(folder / "bare.vdb").front();
    EXPECT_EQ(info.active_min, ivec3(-3, 4, 5));
    EXPECT_EQ(info.active_max, ivec3(10, 11, 12));
}

TEST(Reading, StreamedFilesWithoutOffsetsAreRead) {
    const TempFolder folder;
    TestGrid density, flame;
    density.voxels = {{{0, 0, 0}, dvec3(1.0)}};
    flame.name = "flame";
    flame.voxels = {{{0, 0, 0}, dvec3(2.0)}};
    write_vdb_stream(folder / "stream.vdb", {density, flame});
    EXPECT_EQ(list_grids(folder / "stream.vdb").size(), 2u);
    EXPECT_EQ(read_grid(folder / "stream.vdb", "flame", 0, kPlenty).census.maximum, 2.0);
}

TEST(Census, AgreesWithReadingAndItsHistogramCountsEveryFiniteVoxel) {
    const TempFolder folder;
    TestGrid grid;
    grid.voxels = fill_box({0, 0, 0}, {20, 20, 20}, linear);
    grid.voxels.push_back({{50, 50, 50}, dvec3(std::nan(""))});
    grid.tiles = {{{128, 0, 0}, 2, dvec3(100.0)}};
    write_vdb(folder / "grid.vdb", {grid});
    const GridCensus census = census_of_grid(folder / "grid.vdb", "density", 0, 10);
    const GridCensus read = read_grid(folder / "grid.vdb", "density", 0, kPlenty).census;
    EXPECT_EQ(census.active_voxels, read.active_voxels);
    EXPECT_EQ(census.mean, read.mean);
    EXPECT_EQ(census.maximum, read.maximum);
    ASSERT_EQ(census.histogram.size(), 10u);
    std::uint64_t sum = 0;
    for (const std::uint64_t count : census.histogram)
        sum += count;
    EXPECT_EQ(sum, census.active_voxels - census.nan_voxels);
    EXPECT_TRUE(read.histogram.empty());
}

TEST(Census, AConstantGridFillsOneBin) {
    const TempFolder folder;
    TestGrid grid;
    grid.voxels = fill_box({0, 0, 0}, {3, 3, 3}, [](const ivec3&) { return 5.0; });
    write_vdb(folder / "grid.vdb", {grid});
    EXPECT_EQ(census_of_grid(folder / "grid.vdb", "density", 0, 4).histogram,
              (std::vector<std::uint64_t>{64, 0, 0, 0}));
}

}  // namespace
}  // namespace brisance
