#include "load_shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <system_error>

#include "core/error.h"
#include "inspect.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

bool is_volume(const std::string& input) {
    std::string extension = fs::path(input).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".vdb";
}

// The first frame of an explosion is often empty: the largest file says most about the sequence.
fs::path telling_file(const std::string& pattern) {
    if (!has_frame_token(pattern))
        return pattern;
    fs::path largest;
    std::uintmax_t most = 0;
    for (const FrameFile& frame : resolve_sequence(pattern, std::nullopt)) {
        std::error_code error;
        const std::uintmax_t size = fs::file_size(frame.file, error);
        if (!error && (largest.empty() || size > most)) {
            largest = frame.file;
            most = size;
        }
    }
    return largest;
}

Shot suggested(const std::string& input, const ShotOptions& options, Progress& progress) {
    const fs::path file = telling_file(input);
    progress.stage("looking at " + file.filename().string());
    const Inspection inspection = inspect_file(file);
    if (!inspection.mapping)
        throw Error(ExitCode::BadData, inspection.why_no_mapping);
    progress.notice(fmt::format("no shot given: the look is guessed from {}; `brisance inspect` prints it as a shot",
                                file.filename().string()));
    ShotOptions with_file = options;
    with_file.overrides.insert(with_file.overrides.begin(), "volume.file=" + input);
    Shot shot = parse_shot(suggested_shot(inspection), "shot suggested for " + input, {}, with_file);
    if (shot.name.empty())
        shot.name = fs::path(input).stem().string();
    return shot;
}

}  // namespace

Shot load_shot(const std::string& input, const ShotOptions& options, Progress& progress) {
    return is_volume(input) ? suggested(input, options, progress) : read_shot(input, options);
}

std::string volume_pattern(const Shot& shot) {
    return (shot.folder / shot.volume.file).string();
}

}  // namespace brisance
