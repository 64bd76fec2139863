#include "render_command.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "farm/frame_stamp.h"
#include "film/whole_file.h"
#include "film/write_image.h"
#include "first_look/look_file.h"
#include "outputs.h"
#include "render/input/kept_inputs.h"
#include "render/render_frame.h"
#include "sequence/finished_frame.h"
#include "sequence/frame_job.h"
#include "sequence/plan_command.h"
#include "sequence/result_cache.h"
#include "sequence/shared_choice.h"
#include "shot/write_shot.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

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
    if (const auto stamp = frame.metadata.text.find(kStampKey); stamp != frame.metadata.text.end())
        json["inputs_hash"] = FrameStamps::hash_of(stamp->second);
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

// The frames of a job that are to be rendered, and what they need.
struct Todo {
    FrameJob job;
    std::vector<FrameOutput> outputs;
    std::vector<fs::path> checkpoints;
    std::size_t skipped = 0;
    std::optional<Look> look;  // to be written to `look_file` with the first frame
    fs::path look_file;
};

// --skip-existing: leaves those that are whole and what the shot asks for. Says why another is rendered again.
void leave_out_finished(Todo& todo, const Shot& shot, FrameStamps& stamps, TextProgress& progress) {
    Todo left;
    left.job.several = todo.job.several;
    for (std::size_t i = 0; i < todo.outputs.size(); ++i) {
        const FrameFile& frame = todo.job.frames[i];
        const std::optional<std::string> why = why_unfinished(todo.outputs[i], shot, stamps.of(frame));
        if (!why)
            continue;
        if (*why != kNotThere)
            progress.say(fmt::format("frame {}: rendered again: {}", frame.frame, *why));
        left.job.frames.push_back(frame);
        left.outputs.push_back(todo.outputs[i]);
        left.checkpoints.push_back(todo.checkpoints[i]);
    }
    left.skipped = todo.outputs.size() - left.outputs.size();
    todo = std::move(left);
}

Todo what_to_do(const Shot& shot, const RenderOptions& options, FrameStamps& stamps, TextProgress& progress,
                Failures& failures) {
    Todo todo;
    todo.job = usable_frames(shot, options, progress, failures);
    todo.outputs = name_outputs(shot, options.output, todo.job.frames, todo.job.several);
    check_outputs(todo.outputs, options.input, options.make_folders);
    todo.checkpoints =
        plan_checkpoints(shot, options.checkpoint, todo.job.frames, todo.outputs, options.input, todo.job.several);
    if (options.skip_existing)
        leave_out_finished(todo, shot, stamps, progress);
    return todo;
}

std::vector<std::string> files_on_disk(const FrameOutput& output) {
    std::vector<std::string> files;
    std::error_code error;
    for (const fs::path& file : files_of(output))
        if (fs::exists(file, error))
            files.push_back(file.string());
    return files;
}

// "4 frames written in 2.4 s: out/f.0010.exr to out/f.0013.exr; 2 were finished before; 1 failed"
void say_what_was_written(const std::vector<std::string>& images, std::size_t skipped, std::size_t failed,
                          TextProgress& progress) {
    const std::string head = fmt::format("{} frame{} written", images.size(), images.size() == 1 ? "" : "s");
    std::string tail;
    if (!images.empty())
        tail += ": " + images.front() + (images.size() > 1 ? " to " + images.back() : "");
    if (skipped > 0)
        tail += fmt::format("; {} {} finished before", skipped, skipped == 1 ? "was" : "were");
    if (failed > 0)
        tail += fmt::format("; {} failed", failed);
    progress.summary(head, tail,
                     {{"written", images.size()}, {"skipped", skipped}, {"failed", failed}, {"images", images}});
}

ExitCode render_all(Shot& shot, Todo& todo, const RenderOptions& options, FrameStamps& stamps, ResultCache* cache,
                    TextProgress& progress, Failures& failures) {
    const std::vector<FrameFile>& frames = todo.job.frames;
    progress.begin_sequence(frames.size());
    SharedChoice choice;
    if (!frames.empty()) {
        choice = choose_all(shot, cache, progress);
    }
    PngExposure exposure(shot, choice);
    std::vector<std::string> images;
    KeptInputs kept;
    kept.results = cache;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const FrameFile& frame = frames[i];
        progress.begin_frame(frame.frame, frame.file.string(), i, frames.size());
        kept.next = i + 1 < frames.size() ? std::optional(frames[i + 1]) : std::nullopt;
        const auto work = [&] {
            const std::string stamp = stamps.of(frame);  // before the files are read: they may change
            RenderedFrame rendered = render_frame(shot, frame.file, frame.frame, progress, todo.checkpoints[i], &kept);
            rendered.metadata.text[kStampKey] = stamp;
            choice.note(i == 0, rendered);
            write_frame(rendered, shot, frame.file, todo.outputs[i], exposure, progress);
            if (!todo.look_file.empty())
                write_look(*todo.look, std::exchange(todo.look_file, {}));
            if (options.explain)
                progress.say(without_last_newline(rendered.statistics.explain()));
        };
        const std::string what = frames.size() > 1 ? fmt::format("frame {}: ", frame.frame) : "";
        const fs::path look_file = todo.look_file;
        const bool done = attempt(what, work, progress, failures);
        if (!done && !options.keep_going)
            break;
        std::vector<std::string> written = done ? files_on_disk(todo.outputs[i]) : std::vector<std::string>{};
        if (done && !look_file.empty())
            written.push_back(look_file.string());
        progress.end_frame(frame.frame, written);
        if (done)
            images.push_back(todo.outputs[i].exr.string());
    }
    progress.finish();
    if (cache && options.explain)
        progress.say(cache->summary());
    if (failures.count > 0 && options.keep_going)
        progress.say(fmt::format("{} frame{} failed", failures.count, failures.count == 1 ? "" : "s"));
    say_what_was_written(images, todo.skipped, failures.count, progress);
    return failures.first;
}

}  // namespace

int run_render(const RenderOptions& options) {
    TextProgress progress(options.progress);
    const ThreadLimit limit(options.threads);
    const LoadedShot loaded = load_for(options, progress);
    Shot shot = loaded.shot;
    if (options.print_config) {
        progress.finish();
        std::fputs(to_json(shot).c_str(), stdout);
        return static_cast<int>(ExitCode::Success);
    }
    if (options.list_inputs)
        return list_inputs(loaded, options, progress);
    Failures failures;
    FrameStamps stamps(shot, BRISANCE_VERSION, deciding_files(shot));
    std::optional<ResultCache> cache;
    if (!options.cache.folder.empty())
        cache.emplace(options.cache, stamps, progress);
    Todo todo = what_to_do(shot, options, stamps, progress, failures);
    if (loaded.look && shot.output.statistics && !todo.job.frames.empty()) {
        todo.look = loaded.look;
        todo.look_file = plan_look(shot, options.output, todo.job.several, options.input);
    }
    return static_cast<int>(render_all(shot, todo, options, stamps, cache ? &*cache : nullptr, progress, failures));
}

}  // namespace brisance
