// Reads the grids of later files while something else runs.
#pragma once

#include <filesystem>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "volume/vdb_file.h"

namespace brisance {

using GridName = std::pair<std::string, int>;  // name and index

struct FileToRead {
    std::filesystem::path file;
    std::vector<GridName> grids;
};

// Errors stay within: what could not be read ahead is read again when it is needed, and fails then.
class ReadAhead {
public:
    struct File {
        std::vector<GridInfo> grids;           // all that are in it
        std::map<GridName, BlockGrid> voxels;  // those that were asked for
        double seconds = 0.0;                  // that reading took
    };

    // Begins to read, and leaves whatever else was begun. Starts the files' child processes on this thread, which must
    // outlive them, and while no parallel loop runs.
    void begin(const std::vector<FileToRead>& files, std::uint64_t memory_limit_bytes);

    // Waits for a file. Nothing where it was not begun, failed, or has changed on disk since.
    std::optional<File> take(const std::filesystem::path& file);

private:
    struct Version {
        std::uintmax_t bytes = 0;
        std::filesystem::file_time_type written;
        bool operator==(const Version&) const = default;
    };
    struct Begun {
        Version version;
        std::future<File> result;
    };

    static Version version_of(const std::filesystem::path& file);

    std::map<std::filesystem::path, Begun> begun_;
};

}  // namespace brisance
