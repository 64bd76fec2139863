// Reads the skeleton of a .vdb file without OpenVDB: whether it is one, whether it is whole, and which grids it should
// hold. OpenVDB trusts the sizes in a file. Checking them first turns a crash or garbage into an error message.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace brisance {

struct VdbHeader {
    std::uint32_t file_version = 0;       // 222, 223, 224...
    std::vector<std::string> grid_names;  // as stored, in file order; empty for streamed files without offsets
    std::uint64_t file_bytes = 0;
};

// Throws Error MissingInput when there is no such file, and BadData when it is no VDB (naming what it looks like), when
// it ends before the end of a grid in its own table, or when that table makes no sense or a tree's root claims more
// than fits into the file. Streamed files without a table are looked at up to their first grid.
VdbHeader read_vdb_header(const std::filesystem::path& file);

// Describes the first bytes of a file that is no VDB: "a Git LFS pointer: ...". Ends with the remedy.
std::string describe_foreign_file(const std::string& first_bytes);

}  // namespace brisance
