#include "outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>

#include "core/error.h"
#include "film/whole_file.h"
#include "first_look/look_file.h"
#include "volume/frame_token.h"

namespace brisance {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const FrameOutput& output) {
    std::vector<fs::path> files;
    for (const fs::path& file : {output.exr, output.png, output.statistics, output.halves[0], output.halves[1]})
        if (!file.empty())
            files.push_back(file);
    const std::vector<fs::path> lights = output.lights.all();
    files.insert(files.end(), lights.begin(), lights.end());
    return files;
}

namespace {

std::string default_name(const Shot& shot, bool several) {
    std::string name = shot.name.empty() ? "brisance" : shot.name;
    std::replace(name.begin(), name.end(), '/', '_');
    return name + (several && !has_frame_token(name) ? ".####.exr" : ".exr");
}

std::string output_pattern(const Shot& shot, const std::string& requested, bool several) {
    std::error_code error;
    if (requested.empty() && shot.output.path.empty())
        return default_name(shot, several);
    const fs::path path = requested.empty() ? shot.folder / shot.output.path : fs::path(requested);
    if (!path.has_filename() || fs::is_directory(path, error))
        return (path / default_name(shot, several)).string();
    const std::string origin = requested.empty() ? "output.path" : "-o";
    if (path.extension() != ".exr")
        throw Error(ExitCode::Usage, fmt::format("{} names the EXR and must end in .exr: {}", origin, path.string()));
    if (several && !has_frame_token(path.string()))
        throw Error(ExitCode::Usage,
                    fmt::format("{}: several frames would be written to {}; put #### where the frame number goes",
                                origin, path.string()));
    return path.string();
}

void refuse_overwriting(const FrameOutput& output, const fs::path& input) {
    for (const fs::path& file : files_of(output)) {
        std::error_code error;
        if (fs::equivalent(file, input, error))
            throw Error(ExitCode::Usage,
                        fmt::format("{} is read and would be overwritten; choose another -o", file.string()));
    }
}

void make_folder_of(const fs::path& file) {
    std::error_code error;
    if (file.has_parent_path())
        fs::create_directories(file.parent_path(), error);
    if (error)
        throw Error(ExitCode::CannotCreate, fmt::format("cannot make the folder {}: {}; choose another -o",
                                                        file.parent_path().string(), error.message()));
}

}  // namespace

std::vector<FrameOutput> name_outputs(const Shot& shot, const std::string& requested,
                                      const std::vector<FrameFile>& frames, bool several) {
    const std::string pattern = output_pattern(shot, requested, several);
    std::vector<FrameOutput> outputs;
    std::map<fs::path, int> frame_of;
    for (const FrameFile& frame : frames) {
        FrameOutput output;
        output.exr = expand(pattern, frame.frame);
        if (shot.output.png)
            output.png = fs::path(output.exr).replace_extension(".png");
        if (shot.output.statistics)
            output.statistics = fs::path(output.exr).replace_extension(".stats.json");
        if (shot.output.halves)
            output.halves = {fs::path(output.exr).replace_extension(".A.exr"),
                             fs::path(output.exr).replace_extension(".B.exr")};
        if (shot.output.virtual_lights)
            output.lights = light_picture_files(output.exr, shot.output.png);
        const auto [other, first] = frame_of.emplace(output.exr, frame.frame);
        if (!first)
            throw Error(ExitCode::Usage, fmt::format("frames {} and {} would both be written to {}", other->second,
                                                     frame.frame, output.exr.string()));
        outputs.push_back(output);
    }
    return outputs;
}

fs::path plan_look(const Shot& shot, const std::string& requested, bool several, const fs::path& input) {
    const fs::path pattern = output_pattern(shot, requested, several);
    std::string stem = pattern.stem().string();
    while (const std::optional<FrameToken> token = find_frame_token(stem, 0, true))
        stem.erase(token->begin, token->end - token->begin);
    while (!stem.empty() && std::string("._- ").find(stem.back()) != std::string::npos)
        stem.pop_back();
    const fs::path file = pattern.parent_path() / ((stem.empty() ? "first" : stem) + kLookSuffix);
    std::error_code error;
    if (fs::equivalent(file, input, error))
        throw Error(ExitCode::Usage,
                    fmt::format("{} is read and would be overwritten; choose another -o", file.string()));
    check_writable(file);
    return file;
}

void check_outputs(const std::vector<FrameOutput>& outputs, const fs::path& input, bool make_folders) {
    for (const FrameOutput& output : outputs) {
        refuse_overwriting(output, input);
        if (make_folders)
            make_folder_of(output.exr);
        for (const fs::path& file : files_of(output))
            check_writable(file);
    }
}

std::vector<fs::path> plan_checkpoints(const Shot& shot, const std::string& requested,
                                       const std::vector<FrameFile>& frames, const std::vector<FrameOutput>& outputs,
                                       const fs::path& input, bool several) {
    std::vector<fs::path> checkpoints(frames.size());
    if (requested.empty())
        return checkpoints;
    if (shot.method != RenderMethod::Path)
        throw Error(ExitCode::Usage, "--checkpoint keeps the state of the path tracer; give --method path with it");
    if (several && !has_frame_token(requested))
        throw Error(ExitCode::Usage, fmt::format("--checkpoint: several frames would be kept in {}; put #### where the "
                                                 "frame number goes",
                                                 requested));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        checkpoints[i] = expand(requested, frames[i].frame);
        std::vector<fs::path> taken = files_of(outputs[i]);
        taken.insert(taken.end(), {input, frames[i].file});
        for (const fs::path& file : taken) {
            std::error_code error;
            if (file.lexically_normal() == checkpoints[i].lexically_normal() ||
                fs::equivalent(file, checkpoints[i], error))
                throw Error(ExitCode::Usage, fmt::format("--checkpoint: {} is something else; choose another file",
                                                         checkpoints[i].string()));
        }
        check_writable(checkpoints[i]);
    }
    return checkpoints;
}

}  // namespace brisance
