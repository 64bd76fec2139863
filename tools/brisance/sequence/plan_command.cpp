#include "plan_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/parallel.h"
#include "farm/input_files.h"
#include "forecast/machine_speed.h"
#include "inspect.h"
#include "outputs.h"
#include "render/choice/forecast_frame.h"
#include "render/render_frame.h"
#include "sequence/shared_choice.h"
#include "shot/write_shot.h"

namespace brisance {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void require_file(const fs::path& file) {
    std::error_code error;
    if (!fs::exists(file, error))
        throw Error(ExitCode::MissingInput,
                    fmt::format("{} is read and is not there; copy it to its place", file.string()));
}

void add_once(std::vector<fs::path>& files, const fs::path& file) {
    if (std::find(files.begin(), files.end(), file) == files.end())
        files.push_back(file);
}

// Beside a frame's own files: the shot, its look, and what decides for all frames.
std::vector<fs::path> shared_files(const LoadedShot& loaded, const RenderOptions& options) {
    std::vector<fs::path> files;
    if (std::error_code error; fs::path(options.input).extension() != ".vdb" && !fs::is_directory(options.input, error))
        add_once(files, options.input);
    if (!options.look.empty() && options.look != kDecideLook)
        add_once(files, options.look);
    for (const fs::path& file : loaded.looked_at)
        add_once(files, file);
    for (const fs::path& file : deciding_files(loaded.shot))
        add_once(files, file);
    return files;
}

Json file_list(const Shot& shot, const FrameFile& frame) {
    Json files = Json::array();
    for (const fs::path& file : input_files(shot, frame)) {
        require_file(file);
        files.push_back({{"path", file.string()}, {"bytes", fs::file_size(file)}});
    }
    return files;
}

Json frame_json(const Shot& shot, const FrameFile& frame, const FrameOutput& output, double speed, Progress& progress) {
    const FrameForecast forecast = forecast_frame(shot, frame.file, frame.frame, speed, progress);
    Json json = {{"frame", frame.frame}, {"image", output.exr.string()}, {"files", file_list(shot, frame)}};
    json["outputs"] = Json::array();
    for (const fs::path& file : files_of(output))
        json["outputs"].push_back(file.string());
    json["cells"] = forecast.cells;
    json["seconds"] = forecast.seconds ? Json(*forecast.seconds) : Json();
    if (!forecast.why_no_seconds.empty())
        json["why_no_seconds"] = forecast.why_no_seconds;
    json["memory_bytes"] = forecast.memory_bytes;
    return json;
}

void print_json(const Shot& shot, const RenderOptions& options, const std::vector<FrameFile>& frames,
                const std::vector<FrameOutput>& outputs, TextProgress& progress) {
    const double speed = machine_speed();
    Json json = {{"schema_version", 1},    {"brisance", BRISANCE_VERSION},
                 {"shot", options.input},  {"settings_hash", settings_hash(shot)},
                 {"machine_speed", speed}, {"frames", Json::array()}};
    double seconds = 0.0;
    bool all_known = true;
    std::uint64_t memory = 0;
    progress.begin_sequence(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        progress.begin_frame(frames[i].frame, frames[i].file.string(), i, frames.size());
        json["frames"].push_back(frame_json(shot, frames[i], outputs[i], speed, progress));
        const Json& frame = json["frames"].back();
        all_known = all_known && frame["seconds"].is_number();
        seconds += all_known ? frame["seconds"].get<double>() : 0.0;
        memory = std::max(memory, frame["memory_bytes"].get<std::uint64_t>());
        progress.end_frame(frames[i].frame, {});
    }
    progress.finish();
    json["seconds"] = all_known ? Json(seconds) : Json();
    json["memory_bytes"] = memory;
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

void print_text(const Shot& shot, const std::vector<FrameFile>& frames, const std::vector<FrameOutput>& outputs,
                TextProgress& progress) {
    const Statistics plan = plan_frame(shot, frames.front().file, frames.front().frame, progress);
    progress.finish();
    for (std::size_t i = 0; i < frames.size(); ++i)
        fmt::print("frame {}: {} -> {}\n", frames[i].frame, frames[i].file.string(), outputs[i].exr.string());
    fmt::print("{}{}", frames.size() > 1 ? fmt::format("plan of frame {}\n", frames.front().frame) : "",
               plan.explain());
}

}  // namespace

int list_inputs(const LoadedShot& loaded, const RenderOptions& options, TextProgress& progress) {
    Failures failures;
    const FrameJob job = usable_frames(loaded.shot, options, progress, failures);
    std::vector<fs::path> files = shared_files(loaded, options);
    for (const FrameFile& frame : job.frames)
        for (const fs::path& file : input_files(loaded.shot, frame))
            add_once(files, file);
    progress.finish();
    std::for_each(files.begin(), files.end(), require_file);
    for (const fs::path& file : files)
        fmt::print("{}\n", file.string());
    return static_cast<int>(failures.first);
}

int run_plan(const PlanOptions& options) {
    TextProgress progress(options.render.progress);
    const ThreadLimit limit(options.render.threads);
    const LoadedShot loaded = load_for(options.render, progress);
    if (options.render.list_inputs)
        return list_inputs(loaded, options.render, progress);
    Shot shot = loaded.shot;
    Failures failures;
    const FrameJob job = usable_frames(shot, options.render, progress, failures);
    const std::vector<FrameOutput> outputs = name_outputs(shot, options.render.output, job.frames, job.several);
    check_outputs(outputs, options.render.input, options.render.make_folders);
    if (!job.frames.empty())
        choose_for_all(shot, progress);
    if (options.as_json)
        print_json(shot, options.render, job.frames, outputs, progress);
    else if (!job.frames.empty())
        print_text(shot, job.frames, outputs, progress);
    return static_cast<int>(failures.first);
}

}  // namespace brisance
