#include "volume/read_ahead.h"

#include <memory>

#include "core/error.h"
#include "core/stopwatch.h"

namespace brisance {

ReadAhead::Version ReadAhead::version_of(const std::filesystem::path& file) {
    std::error_code error;
    return {std::filesystem::file_size(file, error), std::filesystem::last_write_time(file, error)};
}

void ReadAhead::begin(const std::vector<FileToRead>& files, std::uint64_t memory_limit_bytes) {
    begun_.clear();  // waits
    for (const FileToRead& wanted : files)
        try {
            const Version version = version_of(wanted.file);
            const Stopwatch watch;
            auto reader = std::make_shared<VdbReader>(wanted.file);
            const auto read = [reader, grids = wanted.grids, memory_limit_bytes, watch] {
                File out;
                out.grids = reader->grids();
                for (const GridName& grid : grids)
                    out.voxels.emplace(grid, reader->read(grid.first, grid.second, memory_limit_bytes));
                out.seconds = watch.seconds();
                return out;
            };
            begun_[wanted.file] = {version, std::async(std::launch::async, read)};
        } catch (const Error&) {
            continue;
        }
}

std::optional<ReadAhead::File> ReadAhead::take(const std::filesystem::path& file) {
    const auto found = begun_.find(file);
    if (found == begun_.end())
        return std::nullopt;
    std::optional<File> out;
    try {
        out = found->second.result.get();
    } catch (const std::exception&) {
        out.reset();
    }
    if (!(found->second.version == version_of(file)))
        out.reset();
    begun_.erase(found);
    return out;
}

}  // namespace brisance
