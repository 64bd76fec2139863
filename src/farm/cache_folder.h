// Results that processes hand on to each other through a folder: pure functions of their key, so that finding one
// changes no bit of any frame, only the time that it takes.
//
// Each result is a file of its own, named by the hash of its key, that holds key, value and a checksum of both. Files
// appear whole or not at all (film/whole_file.h): any number of processes may read and write the same folder. A file
// that is damaged counts as absent, is removed, and is told of. Where the folder takes no more, results are made anew.
// Above its limit the folder loses the results that were not used for longest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/progress.h"

namespace brisance {

class CacheFolder {
public:
    // Makes the folder. `most_bytes`: of all results together. Keeps a reference to `progress` for warnings. Throws
    // Error CannotCreate where there can be no such folder, or none may be written to.
    CacheFolder(std::filesystem::path folder, std::uint64_t most_bytes, Progress& progress);

    // What was kept under a key. The key names what the value is, and everything that it depends on.
    std::optional<std::string> find(std::string_view key);
    void keep(std::string_view key, std::string_view value);

    std::uint64_t found() const { return found_; }
    std::uint64_t kept() const { return kept_; }

private:
    std::filesystem::path file_of(std::string_view key) const;
    void make_room();

    std::filesystem::path folder_;
    std::uint64_t most_bytes_;
    Progress& progress_;
    bool full_ = false;
    std::uint64_t found_ = 0, kept_ = 0;
};

}  // namespace brisance
