#include "frame_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "farm/frame_chunk.h"
#include "volume/vdb_header.h"

namespace brisance {

LoadedShot load_for(const RenderOptions& options, Progress& progress) {
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
    return load_shot_and_look(options.input, layers, options.look, progress);
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
            "", [&] { frames.push_back(resolve_frames(shot, std::vector<int>{frame}).front()); }, progress, failures);
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
        const auto look = [&] {
            if (!frame.file.empty())  // else nothing is at this time
                read_vdb_header(frame.file);
        };
        if (!options.keep_going)
            look();
        if (!options.keep_going || attempt("", look, progress, failures))
            usable.push_back(frame);
    }
    job.frames = usable;
    return job;
}

}  // namespace brisance
