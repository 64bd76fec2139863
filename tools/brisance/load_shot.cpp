#include "load_shot.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <system_error>

#include "core/error.h"
#include "inspect.h"
#include "render/load_medium.h"
#include "render/volume_in_time.h"
#include "volume/vdb_header.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

std::string extension_of(const std::string& input) {
    std::string extension = fs::path(input).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

bool is_scene(const std::string& input) {
    const std::string extension = extension_of(input);
    return extension == ".glb" || extension == ".gltf";
}

// A glTF file as it is: its own camera, its own lights.
Shot shot_of_scene(const std::string& input, const ShotOptions& options) {
    const nlohmann::json shot = {{"name", fs::path(input).stem().string()},
                                 {"scene", {{"files", {{{"file", input}}}}}}};
    const std::string text = shot.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return parse_shot(text, "shot made for " + input, {}, options);
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

// Each frame with the nearer one of its files; both are looked at.
std::vector<FrameFile> frames_in_time(const Shot& shot, const std::optional<std::vector<int>>& requested) {
    std::vector<FrameFile> frames;
    for (const int frame : requested ? *requested : covering_frames(shot)) {
        const SourceFiles files = own_files(shot, frame);
        if (!files.single())
            read_vdb_header(files.nearest() == files.first ? files.second : files.first);
        frames.push_back({frame, files.nearest()});
    }
    return frames;
}

}  // namespace

Shot load_shot(const std::string& input, const ShotOptions& options, Progress& progress) {
    if (is_scene(input))
        return shot_of_scene(input, options);
    return extension_of(input) == ".vdb" ? suggested(input, options, progress) : read_shot(input, options);
}

std::string volume_pattern(const Shot& shot) {
    return shot.volume.file.empty() ? "" : (shot.folder / shot.volume.file).string();
}

std::vector<FrameFile> resolve_frames(const Shot& shot, const std::optional<std::vector<int>>& requested) {
    std::vector<FrameFile> frames;
    if (has_frame_token(volume_pattern(shot)) && (requested || !shot.time.identity()))
        frames = frames_in_time(shot, requested);
    else if (!shot.volume.file.empty())
        frames = resolve_sequence(volume_pattern(shot), requested);
    else
        for (const int frame : requested.value_or(std::vector<int>{1}))
            frames.push_back({frame, {}});
    for (const FrameFile& frame : frames)
        for (const fs::path& file : further_files(shot, frame.frame))
            if (!file.empty())
                read_vdb_header(file);
    return frames;
}

}  // namespace brisance
