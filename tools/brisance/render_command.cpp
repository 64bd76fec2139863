#include "render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "film/write_image.h"
#include "load_shot.h"
#include "outputs.h"
#include "render/choose_method.h"
#include "render/render_frame.h"
#include "render/sequence_levels.h"
#include "render/time_budget.h"
#include "shot/write_shot.h"
#include "volume/vdb_header.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

struct Failures {
    std::size_t count = 0;
    ExitCode first = ExitCode::Success;
};

Shot load(const RenderOptions& options, Progress& progress) {
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

// Runs `work`; what it throws becomes a line and is counted. Returns whether it came to its end.
bool attempt(const std::string& what, const std::function<void()>& work, TextProgress& progress, Failures& failures) {
    const auto fail = [&](ExitCode code, const std::string& line) {
        progress.say(fmt::format("error: {}{}", what, line));
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

std::optional<std::vector<int>> requested_frames(const RenderOptions& options) {
    return options.frames.empty() ? std::nullopt : std::optional(parse_frames(options.frames));
}

// Files of all frames, each of them there and recognisably whole, before the first is rendered: a mistake in frame 90
// should not cost the time of 89 frames. With --keep-going the others remain.
std::vector<FrameFile> usable_frames(const Shot& shot, const RenderOptions& options, TextProgress& progress,
                                     Failures& failures) {
    const std::string pattern = volume_pattern(shot);
    const std::optional<std::vector<int>> requested = requested_frames(options);
    std::vector<FrameFile> frames;
    if (!options.keep_going || !requested || pattern.empty()) {
        frames = resolve_frames(shot, requested);
    } else {
        for (const int frame : *requested)
            attempt(
                "",
                [&] {
                    frames.push_back({frame, resolve_frame(pattern, frame)});
                },
                progress, failures);
    }
    if (pattern.empty())
        return frames;
    std::vector<FrameFile> usable;
    for (const FrameFile& frame : frames) {
        if (!options.keep_going)
            read_vdb_header(frame.file);
        if (!options.keep_going || attempt(
                                       "", [&] { read_vdb_header(frame.file); }, progress, failures))
            usable.push_back(frame);
    }
    return usable;
}

// For `say`, which ends the line itself.
std::string without_last_newline(std::string text) {
    if (text.ends_with('\n'))
        text.pop_back();
    return text;
}

// Exposure of the PNGs. An automatic one is kept from the first frame that is not black, so that a sequence does not
// pump.
class PngExposure {
public:
    explicit PngExposure(const Shot& shot) {
        if (shot.exposure_given)
            stops_ = shot.output.exposure_stops;
    }
    float of(const Image& image, TextProgress& progress) {
        if (stops_)
            return *stops_;
        const float stops = automatic_exposure(image);
        if (stops != 0.0f) {
            stops_ = std::round(100.0f * stops) / 100.0f;
            progress.notice(
                fmt::format("exposure of the PNG: {:+.2f} stops, chosen from the picture; keep it with --set "
                            "output.exposure_stops={:.2f}",
                            *stops_, *stops_));
        }
        return stops_.value_or(0.0f);
    }

private:
    std::optional<float> stops_;
};

void add_metadata(RenderedFrame& frame, const Shot& shot, const fs::path& volume) {
    auto& text = frame.metadata.text;
    text.try_emplace("brisance/version", BRISANCE_VERSION);
    text.try_emplace("brisance/shot", to_json(shot));
    text.try_emplace("brisance/settings_hash", settings_hash(shot));
    text.try_emplace("brisance/volume", volume.filename().string());
    if (frame.metadata.frames_per_second == 0.0)
        frame.metadata.frames_per_second = shot.output.frames_per_second;
}

std::string statistics_json(const RenderedFrame& frame, const fs::path& volume, const FrameOutput& output,
                            std::optional<float> exposure) {
    nlohmann::ordered_json json = {
        {"schema_version", 1},           {"brisance", BRISANCE_VERSION},
        {"frame", frame.metadata.frame}, {"volume", volume.string()},
        {"image", output.exr.string()},  {"settings_hash", frame.metadata.text.at("brisance/settings_hash")}};
    if (exposure)
        json["png_exposure_stops"] = *exposure;
    json.update(frame.statistics.to_json());
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void announce(const fs::path& file) {
    std::puts(file.string().c_str());
    std::fflush(stdout);
}

// The halves' mean is the picture, and their difference shows its noise. The certificate is about the picture.
void write_halves(const RenderedFrame& frame, const FrameOutput& output, Progress& progress) {
    if (output.halves[0].empty())
        return;
    if (frame.halves.size() != output.halves.size()) {
        progress.warning("halves", "output.halves: only method path has halves; none are written");
        return;
    }
    for (std::size_t half = 0; half < output.halves.size(); ++half) {
        ImageMetadata metadata = frame.metadata;
        metadata.samples_per_pixel /= 2.0;
        metadata.text.erase("brisance/certificate");
        metadata.text.erase("brisance/believed_error");
        metadata.text.insert_or_assign("brisance/half", std::string(1, half == 0 ? 'A' : 'B'));
        write_exr(output.halves[half], frame.halves[half], metadata);
        announce(output.halves[half]);
    }
}

void write_frame(RenderedFrame& frame, const Shot& shot, const fs::path& volume, const FrameOutput& output,
                 PngExposure& png_exposure, TextProgress& progress) {
    progress.stage("writing");
    add_metadata(frame, shot, volume);
    const std::string trouble = write_exr(output.exr, frame.image, frame.metadata).describe();
    announce(output.exr);
    if (!trouble.empty()) {
        progress.warning("exr-range", trouble);
        frame.statistics.warnings.push_back("exr-range: " + trouble);
    }
    write_halves(frame, output, progress);
    std::optional<float> exposure;
    if (!output.png.empty() || frame.light_pictures)
        exposure = png_exposure.of(frame.image, progress);
    if (!output.png.empty()) {
        write_png(output.png, frame.image, *exposure, shot.output.view);
        announce(output.png);
    }
    if (frame.light_pictures)
        write_light_pictures(*frame.light_pictures, output.lights, frame.metadata, *exposure, shot.output.view,
                             announce);
    if (!output.statistics.empty()) {
        write_text(output.statistics, statistics_json(frame, volume, output, exposure));
        announce(output.statistics);
    }
}

// What all frames share, by the largest file on disk that can be read, whichever frames this call renders. `choose`
// takes a file. Nothing where there is one frame, which chooses for itself.
template <class Choose>
auto by_largest_file(const Shot& shot, const char* what, const Choose& choose, Progress& progress)
    -> std::optional<decltype(choose(FrameFile{}))> {
    if (volume_pattern(shot).empty())
        return std::nullopt;
    std::vector<FrameFile> all = resolve_frames(shot, std::nullopt);
    if (all.size() < 2)
        return std::nullopt;
    std::ranges::stable_sort(all, std::greater(), [](const FrameFile& f) { return fs::file_size(f.file); });
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

// Lattices: the same for all frames.
std::optional<Shot> one_lattice(const Shot& shot, Progress& progress) {
    if (!leaves_levels_open(shot))
        return std::nullopt;
    const auto choose = [&](const FrameFile& frame) {
        return frame.file.empty() ? shot : with_levels_of(shot, frame.file, frame.frame, progress);
    };
    return by_largest_file(shot, "levels", choose, progress);
}

// What was chosen for all frames, before the first.
struct SharedChoice {
    std::optional<TimedSettings> timed;
    std::optional<MethodForecast> method;

    void note(bool first, RenderedFrame& frame) const {
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
};

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
    if (const std::optional<Shot> levelled = one_lattice(shot, progress))
        shot = *levelled;
    return out;
}

}  // namespace

int run_render(const RenderOptions& options) {
    TextProgress progress(options.progress);
    const ThreadLimit limit(options.threads);
    Shot shot = load(options, progress);
    if (options.print_config) {
        progress.finish();
        std::fputs(to_json(shot).c_str(), stdout);
        return static_cast<int>(ExitCode::Success);
    }
    Failures failures;
    const std::vector<FrameFile> frames = usable_frames(shot, options, progress, failures);
    const std::vector<FrameOutput> outputs =
        plan_outputs(shot, options.output, frames, options.input, options.make_folders);
    const std::vector<fs::path> checkpoints =
        plan_checkpoints(shot, options.checkpoint, frames, outputs, options.input);
    const SharedChoice choice = frames.empty() ? SharedChoice{} : choose_for_all(shot, progress);
    PngExposure exposure(shot);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const FrameFile& frame = frames[i];
        progress.begin_frame(frame.frame, frame.file.string(), i, frames.size());
        const auto work = [&] {
            RenderedFrame rendered = render_frame(shot, frame.file, frame.frame, progress, checkpoints[i]);
            choice.note(i == 0, rendered);
            write_frame(rendered, shot, frame.file, outputs[i], exposure, progress);
            if (options.explain)
                progress.say(without_last_newline(rendered.statistics.explain()));
        };
        const std::string what = frames.size() > 1 ? fmt::format("frame {}: ", frame.frame) : "";
        if (!attempt(what, work, progress, failures) && !options.keep_going)
            break;
    }
    if (failures.count > 0 && options.keep_going)
        progress.say(fmt::format("{} frame{} failed", failures.count, failures.count == 1 ? "" : "s"));
    progress.finish();
    return static_cast<int>(failures.first);
}

int run_plan(const RenderOptions& options) {
    TextProgress progress(options.progress);
    const ThreadLimit limit(options.threads);
    Shot shot = load(options, progress);
    Failures failures;
    const std::vector<FrameFile> frames = usable_frames(shot, options, progress, failures);
    if (frames.empty())
        return static_cast<int>(failures.first);
    const std::vector<FrameOutput> outputs =
        plan_outputs(shot, options.output, frames, options.input, options.make_folders);
    choose_for_all(shot, progress);
    const Statistics plan = plan_frame(shot, frames.front().file, frames.front().frame, progress);
    progress.finish();
    for (std::size_t i = 0; i < frames.size(); ++i)
        fmt::print("frame {}: {} -> {}\n", frames[i].frame, frames[i].file.string(), outputs[i].exr.string());
    fmt::print("{}{}\n", frames.size() > 1 ? fmt::format("plan of frame {}\n", frames.front().frame) : "",
               without_last_newline(plan.explain()));
    return static_cast<int>(failures.first);
}

}  // namespace brisance
