#include "shared_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "core/content_hash.h"
#include "core/error.h"
#include "farm/input_files.h"
#include "film/write_image.h"
#include "load_shot.h"
#include "render/choice/sequence_levels.h"
#include "render/input/kept_inputs.h"
#include "render/input/load_medium.h"
#include "render/input/volume_in_time.h"
#include "sequence/kept_choice.h"
#include "shot/write_shot.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

constexpr float kTrialError = 0.1f;  // lighting.error of a trial picture
constexpr int kTrialSamples = 16;    // of its pixels, with method path

bool has_all_volumes(const Shot& shot, const FrameFile& frame) {
    try {
        const std::vector<fs::path> files = further_files(shot, frame.frame);
        return std::ranges::all_of(files, [](const fs::path& f) { return f.empty() || fs::exists(f); });
    } catch (const Error&) {
        return false;
    }
}

// All frames on disk for which every volume of the shot is; none where there are fewer than two, and a frame chooses
// for itself.
std::vector<FrameFile> largest_first(const Shot& shot) {
    if (volume_pattern(shot).empty())
        return {};
    std::vector<FrameFile> all = own_frames(shot, std::nullopt);
    std::erase_if(all, [&](const FrameFile& f) { return f.file.empty() || !has_all_volumes(shot, f); });
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

// Lattices: the same for all frames.
std::optional<Shot> one_lattice(const Shot& shot, Progress& progress) {
    if (!leaves_levels_open(shot))
        return std::nullopt;
    const auto choose = [&](const FrameFile& frame) {
        return frame.file.empty() ? shot : with_levels_of(shot, frame.file, frame.frame, progress);
    };
    return by_largest_file(shot, "levels", choose, progress);
}

constexpr int kTrialHeight = 72;  // pixels

// A small, rough picture of the same light.
Shot trial_of(const Shot& given) {
    Shot shot = given;
    CameraSettings& camera = shot.camera;
    camera.width = std::max(1, camera.width * kTrialHeight / camera.height);
    camera.height = kTrialHeight;
    camera.samples_per_axis = camera.edge_refinement = 1;
    shot.lighting.error = std::max(shot.lighting.error, kTrialError);
    shot.tracing.samples = kTrialSamples;
    shot.tracing.seconds = shot.tracing.error = shot.seconds = 0.0;
    shot.certify.enabled = false;
    shot.virtual_lights.window = 0;  // one frame alone
    if (shot.method == RenderMethod::Automatic)
        shot.method = RenderMethod::LightingGrid;
    shot.output.virtual_lights = shot.output.bounce_layers = false;
    return shot;
}

bool wants_png_exposure(const Shot& shot) {
    return !shot.exposure_given && (shot.output.png || shot.output.virtual_lights);
}

constexpr const char* kChoiceName = "choices for all frames";

// The settings, the frames on disk with the sizes of their files, and the contents of those that are read: of the
// deciding files, of the files of the frame that the largest of them shows, and of the set.
std::string what_decides(const Shot& shot) {
    std::string text = settings_hash(shot) + "\n";
    const std::vector<FrameFile> all = largest_first(shot);
    for (const FrameFile& frame : all)
        text += fmt::format("{} {}\n", frame.frame, fs::file_size(frame.file));
    std::vector<fs::path> files = deciding_files(shot);
    if (!all.empty())
        for (const fs::path& file : input_files(shot, all.front()))
            files.push_back(file);
    for (const fs::path& file : files)
        text += fmt::format("{} {}\n", file.filename().string(), content_hash_of_file(file));
    return text;
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

std::string exposure_notice(float stops, const std::string& chosen_from) {
    return fmt::format(
        "exposure of the PNG: {:+.2f} stops, chosen from {}; keep it with --set output.exposure_stops={:.2f}", stops,
        chosen_from, stops);
}

std::optional<float> exposure_for_all(const Shot& shot, Progress& progress) {
    if (!wants_png_exposure(shot))
        return std::nullopt;
    const auto choose = [&](const FrameFile& frame) -> std::optional<float> {
        if (frame.file.empty())
            return std::nullopt;
        Progress silent;
        progress.stage("exposure of the sequence");
        const float stops = automatic_exposure(render_frame(trial_of(shot), frame.file, frame.frame, silent).image);
        if (stops == 0.0f)
            throw Error(ExitCode::BadData, fmt::format("{}: its picture is black", frame.file.string()));
        const float rounded = std::round(100.0f * stops) / 100.0f;
        progress.notice(exposure_notice(rounded, fmt::format("a small picture of frame {}", frame.frame)));
        return rounded;
    };
    return by_largest_file(shot, "exposure", choose, progress).value_or(std::nullopt);
}

SharedChoice choose_for_all(Shot& shot, Progress& progress) {
    SharedChoice out;
    shot = settle_time(shot, progress);
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

SharedChoice choose_all(Shot& shot, ResultCache* cache, Progress& to) {
    if (!cache || shot.method == RenderMethod::Automatic || shot.seconds > 0.0) {
        SharedChoice choice = choose_for_all(shot, to);
        choice.exposure_stops = exposure_for_all(shot, to);
        return choice;
    }
    const std::string made_of = what_decides(shot);
    if (const std::optional<std::string> text = cache->find(kChoiceName, made_of))
        if (std::optional<KeptChoice> known = kept_choice(*text, shot)) {
            say_again(known->said, to);
            shot = std::move(known->shot);
            SharedChoice choice;
            choice.exposure_stops = known->exposure_stops;
            return choice;
        }
    SaidLines progress(to);
    SharedChoice choice = choose_for_all(shot, progress);
    choice.exposure_stops = exposure_for_all(shot, progress);
    const auto is_warning = [](const auto& line) { return !line.first.empty(); };
    if (std::ranges::none_of(progress.lines, is_warning))
        cache->keep(kChoiceName, made_of, to_text({shot, choice.exposure_stops, progress.lines}));
    return choice;
}

std::vector<fs::path> deciding_files(const Shot& shot) {
    std::vector<fs::path> files;
    if (shot.method == RenderMethod::Automatic || shot.seconds > 0.0 || wants_png_exposure(shot) ||
        leaves_levels_open(shot))
        if (const std::vector<FrameFile> all = largest_first(shot); !all.empty())
            files.push_back(all.front().file.lexically_normal());
    for (const fs::path& file : files_to_settle_time(shot))
        if (const fs::path plain = file.lexically_normal(); std::ranges::find(files, plain) == files.end())
            files.push_back(plain);
    return files;
}

}  // namespace brisance
