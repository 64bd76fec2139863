#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <tuple>

#include "make_vdb.h"
#include "temp_folder.h"
#include "volume/vdb_header.h"

namespace brisance {
namespace {

TEST(VdbHeader, ListsTheGridsInTheOrderOfTheFile) {
    const TempFolder folder;
    TestGrid temperature, density;
    temperature.name = "temperature";
    temperature.voxels = density.voxels = {{{0, 0, 0}, dvec3(1.0)}};
    write_vdb(folder / "two.vdb", {temperature, density});
    const VdbHeader header = read_vdb_header(folder / "two.vdb");
    EXPECT_EQ(header.grid_names, (std::vector<std::string>{"temperature", "density"}));
    EXPECT_GE(header.file_version, 222u);
    EXPECT_EQ(header.file_bytes, std::filesystem::file_size(folder / "two.vdb"));
}

TEST(VdbHeader, RefusesNamesOfAbsurdLength) {
    const TempFolder folder;
    std::string bytes(" BDV\0\0\0\0", 8);
    bytes += std::string("\xe0\0\0\0", 4) + std::string(8, '\0') + '\x01' + std::string(36, 'a');
    bytes += std::string("\x01\0\0\0\xff\xff\xff\x7f", 8) + std::string(100, 'x');
    write_bytes(folder / "long.vdb", bytes);
    const Failure failure = failure_of([&] { read_vdb_header(folder / "long.vdb"); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "2147483647")) << failure.message;
}

std::string content_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// What reading the skeleton says of a file whose byte `at` and those behind it are changed.
std::string answer_to(std::string bytes, std::size_t at, const std::string& changed) {
    const TempFolder folder;
    write_bytes(folder / "damaged.vdb", bytes.replace(at, changed.size(), changed));
    const Failure failure = failure_of([&] { read_vdb_header(folder / "damaged.vdb"); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_EQ(failure.message.find('\n'), std::string::npos);
    return failure.message;
}

TEST(VdbHeader, RefusesARootThatCannotFit) {
    const std::size_t behind_name = 4 + sizeof(float);  // count of buffers, background
    for (const auto& [scale, name, doubles] : {std::tuple{dmat4(dmat3(0.25)), "UniformScaleMap", 15},
                                               std::tuple{dmat4(dmat3(0.25, 0, 0, 0.1, 0.25, 0, 0, 0, 0.25)),  //
                                                          "AffineMap", 16}}) {
        const TempFolder folder;
        TestGrid grid;
        grid.voxels = {{{0, 0, 0}, dvec3(1.0)}};
        grid.world_from_index = scale;
        write_vdb(folder / "grid.vdb", {grid});
        EXPECT_EQ(read_vdb_header(folder / "grid.vdb").grid_names.size(), 1u);
        const std::string bytes = content_of(folder / "grid.vdb");
        const std::size_t transform = bytes.find(name);
        ASSERT_NE(transform, std::string::npos) << name;
        const std::size_t tiles = transform + std::string(name).size() + doubles * sizeof(double) + behind_name;
        EXPECT_TRUE(contains(answer_to(bytes, tiles, "\xff\xff\xff\x7f"), "claims 2147483647 tiles"));
        EXPECT_TRUE(contains(answer_to(bytes, tiles + 4, "\xff\xff\xff\xff"), "4294967295 children"));
        EXPECT_TRUE(contains(answer_to(bytes, tiles + 4, std::string("\xff\x01\0\0", 4)), "511 children"));
    }
}

TEST(VdbHeader, RefusesLengthsInMetadataThatReachBeyondTheFile) {
    const TempFolder folder;
    TestGrid grid;
    grid.voxels = {{{0, 0, 0}, dvec3(1.0)}};
    write_vdb(folder / "grid.vdb", {grid});
    const std::string bytes = content_of(folder / "grid.vdb"), huge("\xff\xff\xff\x7f");
    const std::size_t key = bytes.find("file_voxel_count");
    ASSERT_NE(key, std::string::npos);
    EXPECT_TRUE(contains(answer_to(bytes, key - 4, huge), "2147483647"));                       // of its name
    EXPECT_TRUE(contains(answer_to(bytes, key + 16, huge), "2147483647"));                      // of its type
    EXPECT_TRUE(contains(answer_to(bytes, key + 16 + 4 + 5, huge), "a number of 2147483647"));  // of its value
    const std::size_t text = bytes.find("class");
    ASSERT_NE(text, std::string::npos);
    ASSERT_EQ(bytes.substr(text + 5 + 4, 6), "string");
    EXPECT_TRUE(contains(answer_to(bytes, text + 5 + 4 + 6, huge), "truncated VDB"));
}

}  // namespace
}  // namespace brisance
