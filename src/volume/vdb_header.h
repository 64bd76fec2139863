// The skeleton of a .vdb file, read without OpenVDB: is it one, is it whole, which grids should it hold.
// OpenVDB trusts sizes it finds in a file; checking them first turns a crash or garbage into a sentence.
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

// Throws Error MissingInput when there is no such file, BadData when it is no VDB (naming what it looks like), when it
// ends before the place its own table of grids gives as the end of one, or when that table makes no sense.
VdbHeader read_vdb_header(const std::filesystem::path& file);

// What the first bytes of a file that is no VDB look like: "a Git LFS pointer: ...". Ends with what would fix it.
std::string describe_foreign_file(const std::string& first_bytes);

}  // namespace brisance
