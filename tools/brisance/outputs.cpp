#include "outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>

#include "core/error.h"
#include "film/whole_file.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

std::string default_name(const Shot& shot, bool several) {
    std::string name = shot.name.empty() ? "brisance" : shot.name;
    std::replace(name.begin(), name.end(), '/', '_');
    return name + (several && !has_frame_token(name) ? ".####.exr" : ".exr");
}

std::string output_pattern(const Shot& shot, const std::string& asked, bool several) {
    std::error_code error;
    if (asked.empty() && shot.output.path.empty())
        return default_name(shot, several);
    const fs::path path = asked.empty() ? shot.folder / shot.output.path : fs::path(asked);
    if (!path.has_filename() || fs::is_directory(path, error))
        return (path / default_name(shot, several)).string();
    const std::string origin = asked.empty() ? "output.path" : "-o";
    if (path.extension() != ".exr")
        throw Error(ExitCode::Usage, fmt::format("{} names the EXR and must end in .exr: {}", origin, path.string()));
    if (several && !has_frame_token(path.string()))
        throw Error(ExitCode::Usage,
                    fmt::format("{}: several frames would be written to {}; put #### where the frame number goes",
                                origin, path.string()));
    return path.string();
}

void refuse_overwriting(const FrameOutput& output, const fs::path& input) {
    for (const fs::path& file : {output.exr, output.png, output.statistics}) {
        std::error_code error;
        if (!file.empty() && fs::equivalent(file, input, error))
            throw Error(ExitCode::Usage,
                        fmt::format("{} is read and would be overwritten; choose another -o", file.string()));
    }
}

}  // namespace

std::vector<FrameOutput> plan_outputs(const Shot& shot, const std::string& asked, const std::vector<FrameFile>& frames,
                                      const fs::path& input) {
    const std::string pattern = output_pattern(shot, asked, frames.size() > 1);
    std::vector<FrameOutput> outputs;
    std::map<fs::path, int> frame_of;
    for (const FrameFile& frame : frames) {
        FrameOutput output;
        output.exr = expand(pattern, frame.frame);
        if (shot.output.png)
            output.png = fs::path(output.exr).replace_extension(".png");
        if (shot.output.statistics)
            output.statistics = fs::path(output.exr).replace_extension(".stats.json");
        const auto [other, first] = frame_of.emplace(output.exr, frame.frame);
        if (!first)
            throw Error(ExitCode::Usage, fmt::format("frames {} and {} would both be written to {}", other->second,
                                                     frame.frame, output.exr.string()));
        refuse_overwriting(output, input);
        for (const fs::path& file : {output.exr, output.png, output.statistics})
            if (!file.empty())
                check_writable(file);
        outputs.push_back(output);
    }
    return outputs;
}

}  // namespace brisance
