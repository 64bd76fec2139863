#include <gtest/gtest.h>

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

}  // namespace
}  // namespace brisance
