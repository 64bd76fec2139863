#include "load_shot.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <set>
#include <system_error>

#include "core/error.h"
#include "core/printable.h"
#include "first_look/look_file.h"
#include "render/input/load_medium.h"
#include "render/input/volume_in_time.h"
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

void tell(const std::string& whence, const Look& look, Progress& progress) {
    progress.notice(whence);
    for (const std::string& line : describe_look(look))
        progress.notice("  " + line);
}

std::string one_line_json(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// A glTF file as it is: its own camera, its own lights.
Shot shot_of_scene(const std::string& input, const ShotOptions& options) {
    const Json shot = {{"name", fs::path(input).stem().string()}, {"scene", {{"files", {{{"file", input}}}}}}};
    return parse_shot(one_line_json(shot), "shot made for " + input, {}, options);
}

ShotOptions with_volume(const std::string& volumes, const ShotOptions& options) {
    ShotOptions out = options;
    out.overrides.insert(out.overrides.begin(), "volume.file=" + volumes);  // whatever bytes its name holds
    return out;
}

Stated stated_for(const std::string& volumes, const ShotOptions& options) {
    Stated stated;
    stated.shot = parse_shot("{}", "shot made for " + volumes, {}, with_volume(volumes, options), &stated.keys);
    return stated;
}

Look decide_for(const Stated& stated, Progress& progress) {
    return decide_look(survey_sequence(volume_pattern(stated.shot), stated.shot.volume, progress), stated);
}

// Files of a sequence on disk: a survey reads the headers of all, and the voxels of some.
std::vector<fs::path> surveyed_files(const std::string& pattern) {
    std::vector<fs::path> files;
    for (const FrameFile& frame : resolve_sequence(pattern, std::nullopt))
        files.push_back(frame.file.lexically_normal());
    return files;
}

Look look_named(const std::string& name, const Stated& stated, bool& decided, Progress& progress) {
    decided = name.empty() || name == kDecideLook;
    Look look = decided ? decide_for(stated, progress) : read_look(name);
    for (const std::string& line : look.warnings)
        progress.warning("first-look", line);
    return look;
}

std::string whence(const std::string& look) {
    return look.empty() || look == kDecideLook ? "first look" : look;
}

LoadedShot load_volume(const std::string& input, const ShotOptions& options, const std::string& look_name,
                       Progress& progress) {
    const std::string volumes = volume_input(input);
    const Stated stated = stated_for(volumes, options);
    bool decided = false;
    const Look look = look_named(look_name, stated, decided, progress);
    tell(fmt::format("no shot given: {} the look, and --set KEY=VALUE changes each part:",
                     decided ? fmt::format("frame {} of {} decided", describe_frames(look.looked_at), look.volume)
                             : look_name + " states"),
         look, progress);
    LoadedShot out;
    out.shot =
        parse_shot(one_line_json(shot_of_look(look, stated)), whence(look_name), {}, with_volume(volumes, options));
    if (out.shot.name.empty())
        out.shot.name = fs::path(volumes).stem().string();
    if (decided) {
        out.look = look;
        out.looked_at = surveyed_files(volume_pattern(stated.shot));
    } else if (look.volume != fs::path(volumes).filename().string()) {
        progress.notice(fmt::format("{} was made for {}", look_name, look.volume));
    }
    return out;
}

bool needs_camera(const Shot& shot) {
    return !shot.camera_given && !shot.volume.file.empty() && shot.volumes.empty() && shot.scene.files.empty() &&
           has_frame_token(volume_pattern(shot));
}

// A shot states what it wants. The look decides the rest where it is asked for, and a camera for all frames of a
// sequence where there is none.
LoadedShot load_file(const std::string& input, const ShotOptions& options, const std::string& look_name,
                     Progress& progress) {
    Stated stated;
    stated.shot = read_shot(input, options, &stated.keys);
    LoadedShot out;
    if (look_name.empty() && !needs_camera(stated.shot)) {
        out.shot = std::move(stated.shot);
        return out;
    }
    if (stated.shot.volume.file.empty())
        throw Error(ExitCode::Usage, fmt::format("{}: has no volume.file: there is nothing to have a look at", input));
    Look look;
    bool decided = look_name.empty();
    if (decided) {
        look = decide_camera(survey_sequence(volume_pattern(stated.shot), stated.shot.volume, progress), stated);
        tell("the shot has no camera: one is framed on the whole sequence:", look, progress);
    } else {
        look = look_named(look_name, stated, decided, progress);
        tell("what the shot leaves open comes from " + whence(look_name) + ":", look, progress);
        if (decided)
            out.look = look;
    }
    if (decided)
        out.looked_at = surveyed_files(volume_pattern(stated.shot));
    ShotOptions layers = options;
    layers.base = one_line_json(shot_of_look(look, stated));
    layers.base_source = whence(look_name);
    out.shot = read_shot(input, layers);
    return out;
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

std::string volume_input(const std::string& input) {
    std::error_code error;
    if (!fs::is_directory(input, error))
        return input;
    std::set<std::string> sequences;
    std::string single;
    for (const fs::directory_entry& entry : fs::directory_iterator(input, error)) {
        if (extension_of(entry.path().string()) != ".vdb")
            continue;
        single = entry.path().string();
        sequences.insert(pattern_of(single).value_or(single));
    }
    if (sequences.empty())
        throw Error(ExitCode::MissingInput, fmt::format("{}: the folder holds no .vdb file", input));
    if (sequences.size() > 1) {
        std::string names;
        for (const std::string& s : sequences)
            names += (names.empty() ? "" : ", ") + printable(fs::path(s).filename().string(), kLongestName);
        throw Error(ExitCode::Usage,
                    printable_line(fmt::format("{}: the folder holds {} sequences; name one of them: {}", input,
                                               sequences.size(), names)));
    }
    return frames_on_disk(*sequences.begin()).size() > 1 ? *sequences.begin() : single;
}

LoadedShot load_shot_and_look(const std::string& input, const ShotOptions& options, const std::string& look,
                              Progress& progress) {
    std::error_code error;
    if (extension_of(input) == ".vdb" || fs::is_directory(input, error))
        return load_volume(input, options, look, progress);
    if (!is_scene(input))
        return load_file(input, options, look, progress);
    if (!look.empty())
        throw Error(ExitCode::Usage, input + ": a look is for volumes; a glTF file has none");
    return {shot_of_scene(input, options), std::nullopt, {}};
}

Shot load_shot(const std::string& input, const ShotOptions& options, Progress& progress) {
    return load_shot_and_look(input, options, "", progress).shot;
}

Look first_look(const std::string& volumes, const ShotOptions& options, Progress& progress) {
    return decide_for(stated_for(volumes, options), progress);
}

std::string volume_pattern(const Shot& shot) {
    return shot.volume.file.empty() ? "" : (shot.folder / shot.volume.file).string();
}

std::vector<FrameFile> own_frames(const Shot& shot, const std::optional<std::vector<int>>& requested) {
    std::vector<FrameFile> frames;
    if (has_frame_token(volume_pattern(shot)) && (requested || !shot.time.identity()))
        frames = frames_in_time(shot, requested);
    else if (!shot.volume.file.empty())
        frames = resolve_sequence(volume_pattern(shot), requested);
    else
        for (const int frame : requested.value_or(std::vector<int>{1}))
            frames.push_back({frame, {}});
    return frames;
}

std::vector<FrameFile> resolve_frames(const Shot& shot, const std::optional<std::vector<int>>& requested) {
    std::vector<FrameFile> frames = own_frames(shot, requested);
    for (const FrameFile& frame : frames)
        for (const fs::path& file : further_files(shot, frame.frame))
            if (!file.empty())
                read_vdb_header(file);
    return frames;
}

}  // namespace brisance
