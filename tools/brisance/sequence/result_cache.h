// `--cache FOLDER`: what processes keep for each other (farm/cache_folder.h).
#pragma once

#include <optional>
#include <string>

#include "farm/cache_folder.h"
#include "farm/frame_stamp.h"
#include "render/input/kept_inputs.h"

namespace brisance {

struct CacheOptions {
    std::string folder;         // empty: none
    int most_mebibytes = 1024;  // of all results together
};

// Names results by this program's build, by what they are, and by the contents of the files that they are made of.
class ResultCache : public ResultStore {
public:
    // Keeps references. Throws Error CannotCreate. `stamps`: of the shot's frames.
    ResultCache(const CacheOptions& options, FrameStamps& stamps, Progress& progress);

    std::optional<std::string> find(const std::string& name, const FrameFile& of) override;
    void keep(const std::string& name, const FrameFile& of, const std::string& result) override;

    // Of the whole sequence: `made_of` is a text that names settings and contents.
    std::optional<std::string> find(const std::string& name, const std::string& made_of);
    void keep(const std::string& name, const std::string& made_of, const std::string& result);

    std::string summary() const;  // "2 results found, 1 kept"

private:
    std::string key(const std::string& name, const std::string& made_of) const;

    CacheFolder folder_;
    FrameStamps& stamps_;
    std::string build_;
};

}  // namespace brisance
