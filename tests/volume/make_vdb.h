// Small VDB files for tests, described with plain types.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/vec.h"

namespace brisance {

// More memory than any file of a test takes.
constexpr std::uint64_t kPlentyOfMemory = std::uint64_t{1} << 30;

struct TestVoxel {
    ivec3 index{0};
    dvec3 value{0.0};  // scalars use x
};

struct TestTile {
    ivec3 index{0};  // any voxel of the tile
    int level = 1;   // 1: 8^3 voxels, 2: 128^3, 3: 4096^3
    dvec3 value{0.0};
};

enum class TestType { Float, Double, Int32, Int64, Bool, Mask, Vec3f, Vec3d, Vec3i, Points };
enum class TestClass { Unknown, Fog, LevelSet, Staggered };

struct TestGrid {
    std::string name = "density";
    TestType type = TestType::Float;
    TestClass grid_class = TestClass::Fog;
    dmat4 world_from_index{1.0};
    bool frustum = false;  // replaces the transform
    bool half = false;     // values stored as half floats
    std::vector<TestVoxel> voxels;
    std::vector<TestTile> tiles;  // set before the voxels
};

// Every voxel of the box [low, high] with the value of a function of its index.
template <class Function>
std::vector<TestVoxel> fill_box(const ivec3& low, const ivec3& high, const Function& value) {
    std::vector<TestVoxel> voxels;
    for (int x = low.x; x <= high.x; ++x)
        for (int y = low.y; y <= high.y; ++y)
            for (int z = low.z; z <= high.z; ++z)
                voxels.push_back({{x, y, z}, dvec3(value(ivec3(x, y, z)))});
    return voxels;
}

// `statistics` false leaves out the bounds and counts that most writers note in the file.
void write_vdb(const std::filesystem::path& file, const std::vector<TestGrid>& grids, bool statistics = true);

// Writes the grids one after the other as into a pipe: without a table of where each begins.
void write_vdb_stream(const std::filesystem::path& file, const std::vector<TestGrid>& grids);

// Replaces every occurrence of one stored double by another: damages transforms as no library would write them.
// Returns how many were replaced.
int patch_doubles(const std::filesystem::path& file, double from, double to);

}  // namespace brisance
