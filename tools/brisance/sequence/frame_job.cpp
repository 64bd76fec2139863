#include "frame_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>

#include "farm/frame_chunk.h"
#include "load_shot.h"
#include "volume/vdb_header.h"

namespace brisance {

namespace fs = std::filesystem;

Shot load_for(const RenderOptions& options, Progress& progress) {
    ShotOptions layers{options.preset, options.overrides};
    if (!options.method.empty())
        layers.overrides.insert(layers.overrides.begin(), "method=" + options.method);
    if (options.seconds > 0.0)
        layers.overrides.insert(layers.overrides.begin(), fmt::format("seconds={}", options.seconds));
    if (options.certify)
        layers.overrides.emplace_back("certify.enabled=true");
    for (const std::string& pictures : options.debug)
        if (pictures == kDebugVirtualLights)
            layers.overrides.emplace_back("output.virtual_lights=true");
    return load_shot(options.input, layers, progress);
}

bool attempt(const std::string& what, const std::function<void()>& work, TextProgress& progress, Failures& failures) {
    const auto fail = [&](ExitCode code, const std::string& line) {
        progress.error(what + line);
        if (failures.count++ == 0)
            failures.first = code;
        return false;
    };
    try {
        work();
        return true;
    } catch (const Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::Temporary, "out of memory; render at a lower resolution or on a larger machine");
    } catch (const std::exception& error) {
        return fail(ExitCode::RenderFailed, error.what());
    }
}

namespace {

std::optional<std::vector<int>> requested_frames(const Shot& shot, const RenderOptions& options) {
    if (options.task_count == 0)
        return options.frames.empty() ? std::nullopt : std::optional(parse_frames(options.frames));
    return frame_chunk(frames_asked_for(shot, options), options.task_index, options.task_count);
}

// Those whose files are there.
std::vector<FrameFile> present_frames(const Shot& shot, const RenderOptions& options,
                                      const std::optional<std::vector<int>>& requested, TextProgress& progress,
                                      Failures& failures) {
    const std::string pattern = volume_pattern(shot);
    if (requested && requested->empty())
        return {};
    if (!options.keep_going || !requested || pattern.empty())
        return resolve_frames(shot, requested);
    std::vector<FrameFile> frames;
    for (const int frame : *requested)
        attempt(
            "",
            [&] {
                frames.push_back({frame, resolve_frame(pattern, frame)});
            },
            progress, failures);
    return frames;
}

}  // namespace

std::vector<int> frames_asked_for(const Shot& shot, const RenderOptions& options) {
    if (!options.frames.empty())
        return parse_frames(options.frames);
    std::vector<int> frames;
    for (const FrameFile& frame : resolve_frames(shot, std::nullopt))
        frames.push_back(frame.frame);
    return frames;
}

FrameJob usable_frames(const Shot& shot, const RenderOptions& options, TextProgress& progress, Failures& failures) {
    const std::optional<std::vector<int>> requested = requested_frames(shot, options);
    FrameJob job;
    job.frames = present_frames(shot, options, requested, progress, failures);
    job.several = options.task_count > 0 ? frames_asked_for(shot, options).size() > 1
                                         : std::max(job.frames.size(), requested ? requested->size() : 0) > 1;
    if (volume_pattern(shot).empty())
        return job;
    std::vector<FrameFile> usable;
    for (const FrameFile& frame : job.frames) {
        if (!options.keep_going)
            read_vdb_header(frame.file);
        if (!options.keep_going || attempt(
                                       "", [&] { read_vdb_header(frame.file); }, progress, failures))
            usable.push_back(frame);
    }
    job.frames = usable;
    return job;
}

namespace {

// All frames on disk; none where there are fewer than two, and a frame chooses for itself.
std::vector<FrameFile> largest_first(const Shot& shot) {
    if (volume_pattern(shot).empty())
        return {};
    std::vector<FrameFile> all = resolve_frames(shot, std::nullopt);
    if (all.size() < 2)
        return {};
    std::ranges::stable_sort(all, std::greater(), [](const FrameFile& f) { return fs::file_size(f.file); });
    return all;
}

// What all frames share, by the largest file on disk that can be read, whichever frames this call renders. `choose`
// takes a file. Nothing where there is one frame, which chooses for itself.
template <class Choose>
auto by_largest_file(const Shot& shot, const char* what, const Choose& choose, Progress& progress)
    -> std::optional<decltype(choose(FrameFile{}))> {
    const std::vector<FrameFile> all = largest_first(shot);
    if (all.empty())
        return std::nullopt;
    for (const FrameFile& frame : all)
        try {
            return choose(frame);
        } catch (const Error& error) {
            progress.warning(what, std::string("not chosen by this frame: ") + error.what());
        }
    return choose(FrameFile{});
}

// method=auto: one method for all frames.
std::optional<MethodForecast> one_method(const Shot& shot, Progress& progress) {
    if (shot.method != RenderMethod::Automatic)
        return std::nullopt;
    const auto choose = [&](const FrameFile& frame) {
        if (!frame.file.empty())
            return forecast_methods(shot, frame.file, frame.frame, progress);
        MethodForecast grid;
        grid.reason = "method: the lighting grid, since no frame can be read";
        return grid;
    };
    return by_largest_file(shot, "method", choose, progress);
}

// --seconds: one setting for all frames.
std::optional<TimedSettings> one_setting(const Shot& shot, Progress& progress) {
    if (!(shot.seconds > 0.0))
        return std::nullopt;
    const auto choose = [&](const FrameFile& frame) {
        if (!frame.file.empty())
            return settings_for_time(shot, frame.file, frame.frame, progress);
        TimedSettings as_it_is;
        as_it_is.shot = shot;
        as_it_is.shot.seconds = 0.0;
        return as_it_is;
    };
    return by_largest_file(shot, "seconds", choose, progress);
}

}  // namespace

void SharedChoice::note(bool first, RenderedFrame& frame) const {
    if (method)
        frame.metadata.text["brisance/method"] = method->name();
    if (!first)
        return;
    for (const StageCost* cost : {method ? &method->cost : nullptr, timed ? &timed->cost : nullptr})
        if (cost) {
            frame.statistics.stages.insert(frame.statistics.stages.begin(), *cost);
            frame.statistics.seconds += cost->seconds;
        }
}

SharedChoice choose_for_all(Shot& shot, Progress& progress) {
    SharedChoice out;
    out.timed = one_setting(shot, progress);
    if (out.timed)
        shot = out.timed->shot;
    else if (shot.seconds > 0.0)
        return out;  // its only frame chooses
    out.method = one_method(shot, progress);
    if (out.method)
        shot = with_method(shot, *out.method);
    return out;
}

std::vector<fs::path> deciding_files(const Shot& shot) {
    if (shot.method != RenderMethod::Automatic && !(shot.seconds > 0.0))
        return {};
    const std::vector<FrameFile> all = largest_first(shot);
    return all.empty() ? std::vector<fs::path>{} : std::vector<fs::path>{all.front().file.lexically_normal()};
}

}  // namespace brisance
