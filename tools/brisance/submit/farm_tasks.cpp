#include "farm_tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "farm/frame_chunk.h"
#include "forecast/machine_speed.h"
#include "outputs.h"
#include "render/choice/forecast_frame.h"
#include "sequence/frame_job.h"
#include "sequence/shared_choice.h"

namespace brisance {

namespace {

namespace fs = std::filesystem;

void add_option(Words& words, const char* name, const std::string& value) {
    if (!value.empty())
        words.insert(words.end(), {name, value});
}

// For jobs and files.
std::string plain_name(std::string name) {
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_' && c != '.')
            c = '_';
    return name;
}

// "10-13,15": every frame, however many.
std::string list_of(const std::vector<int>& frames) {
    std::string text;
    for (std::size_t i = 0; i < frames.size();) {
        std::size_t last = i;
        while (last + 1 < frames.size() && frames[last + 1] == frames[last] + 1)
            ++last;
        text += text.empty() ? "" : ",";
        text += last == i ? fmt::format("{}", frames[i]) : fmt::format("{}-{}", frames[i], frames[last]);
        i = last + 1;
    }
    return text;
}

int task_count(const SubmitOptions& options, std::size_t frames) {
    int count = options.engine == "local" ? 1 : static_cast<int>(frames);
    if (options.frames_a_task > 0)
        count = tasks_for(frames, options.frames_a_task);
    if (options.tasks > 0)
        count = options.tasks;
    return std::clamp(count, 1, std::max(1, static_cast<int>(frames)));
}

// What the frame with the largest file may need at most. 0 where nothing can be read.
std::uint64_t memory_of_largest(Shot shot, const std::vector<FrameFile>& frames, Progress& progress) {
    const auto size = [](const FrameFile& f) {
        std::error_code error;
        const auto bytes = f.file.empty() ? 0 : fs::file_size(f.file, error);
        return error ? 0 : bytes;
    };
    const auto largest = std::ranges::max_element(frames, {}, size);
    choose_for_all(shot, progress);
    return forecast_frame(shot, largest->file, largest->frame, machine_speed(), progress).memory_bytes;
}

}  // namespace

Words FarmTasks::command(const std::string& command) const {
    Words words = {program, command, render.input};
    add_option(words, "-o", render.output);
    add_option(words, "-f", frames);
    add_option(words, "--preset", render.preset);
    add_option(words, "--method", render.method);
    add_option(words, "--look", render.look);
    if (render.seconds > 0.0)
        add_option(words, "--seconds", fmt::format("{}", render.seconds));
    for (const std::string& override : render.overrides)
        add_option(words, "--set", override);
    if (render.certify)
        words.emplace_back("--certify");
    return words;
}

Words FarmTasks::task(const std::string& index) const {
    Words words = rest();
    words.insert(words.end(), {"--task-index", index, "--task-count", fmt::format("{}", count)});
    return words;
}

Words FarmTasks::rest() const {
    Words words = command("render");
    words.insert(words.end(), {"--skip-existing", "--keep-going"});
    if (!render.cache.folder.empty())
        words.insert(words.end(),
                     {"--cache", render.cache.folder, "--cache-limit", fmt::format("{}", render.cache.most_mebibytes)});
    if (render.make_folders)
        words.emplace_back("--make-folders");
    return words;
}

FarmTasks plan_tasks(const SubmitOptions& options) {
    TextProgress progress(options.render.progress);
    const Shot shot = load_for(options.render, progress).shot;
    Failures failures;
    const FrameJob job = usable_frames(shot, options.render, progress, failures);
    if (job.frames.empty())
        throw Error(ExitCode::MissingInput, "there is no frame to render");
    const std::vector<FrameOutput> outputs = name_outputs(shot, options.render.output, job.frames, job.several);
    check_outputs(outputs, options.render.input, options.render.make_folders);
    FarmTasks tasks;
    for (const FrameFile& frame : job.frames)
        tasks.frame_list.push_back(frame.frame);
    tasks.name = plain_name(shot.name.empty() ? fs::path(options.render.input).stem().string() : shot.name);
    tasks.program = fs::read_symlink("/proc/self/exe").string();
    tasks.folder = fs::current_path().string();
    tasks.output_folder = fs::absolute(outputs.front().exr).parent_path().string();
    tasks.frames = list_of(tasks.frame_list);
    tasks.count = task_count(options, tasks.frame_list.size());
    tasks.retries = options.retries;
    tasks.render = options.render;
    tasks.memory_bytes = options.memory_mebibytes << 20;
    if (tasks.memory_bytes == 0 && options.engine != "local")
        tasks.memory_bytes = memory_of_largest(shot, job.frames, progress);
    progress.finish();
    return tasks;
}

std::string shell_line(const Words& words) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) != 0 || std::string_view("_-+=.,/:@%").find(static_cast<char>(c)) != std::string::npos;
    };
    std::string line;
    for (const std::string& word : words) {
        line += line.empty() ? "" : " ";
        if (word.starts_with("${")) {
            line += "\"" + word + "\"";
        } else if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) {
            line += word;
        } else {
            std::string quoted = word;
            for (std::size_t at = 0; (at = quoted.find('\'', at)) != std::string::npos; at += 4)
                quoted.replace(at, 1, "'\\''");
            line += "'" + quoted + "'";
        }
    }
    return line;
}

}  // namespace brisance
