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
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "film/whole_file.h"
#include "film/write_image.h"
#include "first_look/look_file.h"
#include "load_shot.h"
#include "outputs.h"
#include "render/render_frame.h"
#include "render/volume_in_time.h"
#include "shared_choice.h"
#include "shot/write_shot.h"
#include "volume/vdb_header.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

struct Failures {
    std::size_t count = 0;
    ExitCode first = ExitCode::Success;
};

LoadedShot load(const RenderOptions& options, Progress& progress) {
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
                "", [&] { frames.push_back(resolve_frames(shot, std::vector<int>{frame}).front()); }, progress,
                failures);
    }
    if (pattern.empty())
        return frames;
    std::vector<FrameFile> usable;
    for (const FrameFile& frame : frames) {
        const auto look = [&] {
            if (!frame.file.empty())  // else nothing is at this time
                read_vdb_header(frame.file);
        };
        if (!options.keep_going)
            look();
        if (!options.keep_going || attempt("", look, progress, failures))
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

// Exposure of the PNGs: the shot's, or that of the whole sequence; else an automatic one is kept from the first frame
// that is not black.
class PngExposure {
public:
    PngExposure(const Shot& shot, const SharedChoice& choice) {
        if (shot.exposure_given)
            stops_ = shot.output.exposure_stops;
        else
            stops_ = choice.exposure_stops;
    }
    float of(const Image& image, TextProgress& progress) {
        if (stops_)
            return *stops_;
        const float stops = automatic_exposure(image);
        if (stops != 0.0f) {
            stops_ = std::round(100.0f * stops) / 100.0f;
            progress.notice(exposure_notice(*stops_, "the picture"));
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

void write_look(const Look& look, const fs::path& file) {
    write_whole_file(file, look_to_json(look));
    announce(file);
}

}  // namespace

int run_render(const RenderOptions& options) {
    TextProgress progress(options.progress);
    const ThreadLimit limit(options.threads);
    const LoadedShot loaded = load(options, progress);
    Shot shot = loaded.shot;
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
    fs::path look_file;
    if (loaded.look && shot.output.statistics && !frames.empty())
        look_file = plan_look(shot, options.output, frames.size() > 1, options.input);
    SharedChoice choice;
    if (!frames.empty()) {
        choice = choose_for_all(shot, progress);
        choice.exposure_stops = exposure_for_all(shot, progress);
    }
    PngExposure exposure(shot, choice);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const FrameFile& frame = frames[i];
        progress.begin_frame(frame.frame, frame.file.string(), i, frames.size());
        const auto work = [&] {
            RenderedFrame rendered = render_frame(shot, frame.file, frame.frame, progress, checkpoints[i]);
            choice.note(i == 0, rendered);
            write_frame(rendered, shot, frame.file, outputs[i], exposure, progress);
            if (!look_file.empty())
                write_look(*loaded.look, std::exchange(look_file, {}));
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
    Shot shot = load(options, progress).shot;
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
