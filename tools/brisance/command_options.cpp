#include "command_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/printable.h"
#include "shot/nearest_key.h"

namespace brisance {

namespace {

// What decides which frames there are, and what is in them.
void add_shot_options(CLI::App& command, RenderOptions& options) {
    command
        .add_option("SHOT_OR_VDB", options.input,
                    "A shot (JSON), a .vdb with or without frame token (####), or a folder of them")
        ->required();
    command.add_option("-o,--output", options.output,
                       "The EXR, with #### for the frame number, or a folder; PNG and statistics go beside it");
    command.add_option("-f,--frames", options.frames, "Frames: 1001-1100x2,1200; without it, all that are on disk");
    command.add_option("--method", options.method, "lighting_grid, path or auto: the same as --set method=...")
        ->check(one_of({"lighting_grid", "path", "auto"}))
        ->type_name("METHOD");
    command
        .add_option("--seconds", options.seconds,
                    "Wall time for a frame with all but its certificate: the settings of least error that fit, one for "
                    "all frames; the same as --set seconds=...")
        ->check(CLI::PositiveNumber)
        ->type_name("S");
    command
        .add_option("--look", options.look,
                    "A first look from `brisance inspect --write-look`, or auto, for what a shot leaves open; a bare "
                    "volume has auto without it")
        ->type_name("FILE");
    add_common_options(command, options);
    command.add_flag("--certify", options.certify,
                     "Estimates the finished picture's error against the truth, with 95 % confidence intervals, from "
                     "certify.samples unbiased samples: on standard error, in the statistics and in the EXR's header");
}

void add_folder_and_failure_options(CLI::App& command, RenderOptions& options) {
    command.add_flag("--make-folders", options.make_folders, "Makes the folders of the outputs where they are missing");
    command.add_flag("--keep-going", options.keep_going, "Renders the remaining frames when one fails");
}

void add_task_options(CLI::App& command, RenderOptions& options) {
    CLI::Option* const index =
        command
            .add_option("--task-index", options.task_index,
                        "Of a farm: this task's number, from 0; its frames are a contiguous part of --frames")
            ->type_name("I");
    CLI::Option* const count =
        command.add_option("--task-count", options.task_count, "Of a farm: how many tasks there are")
            ->type_name("N")
            ->check(CLI::Range(1, 1'000'000));
    index->needs(count);
    count->needs(index);
}

void add_cache_options(CLI::App& command, CacheOptions& options) {
    CLI::Option* const folder =
        command
            .add_option("--cache", options.folder,
                        "Keeps results in this folder for other processes: what is decided for all frames, and "
                        "positions of virtual lights. Several may use it at once. Never changes the picture")
            ->type_name("FOLDER");
    command.add_option("--cache-limit", options.most_mebibytes, "Of all results in it [MiB]; default 1024")
        ->check(CLI::Range(1, 1 << 30))
        ->needs(folder);
}

}  // namespace

CLI::Validator one_of(const std::vector<std::string>& words) {
    const auto trouble = [words](const std::string& given) -> std::string {
        if (std::find(words.begin(), words.end(), given) != words.end())
            return {};
        const std::string shown = printable(given, kLongestName);
        return fmt::format("expected one of {}, got {}; did you mean {}?", fmt::join(words, ", "), shown,
                           nearest_key(shown, words));
    };
    return {trouble, fmt::format("{{{}}}", fmt::join(words, ","))};
}

void add_render_options(CLI::App& command, RenderOptions& options) {
    add_shot_options(command, options);
    add_cache_options(command, options.cache);
    add_folder_and_failure_options(command, options);
    add_task_options(command, options);
    command.add_flag("--skip-existing", options.skip_existing,
                     "Leaves out frames whose files are whole, readable and made with the same program, settings and "
                     "inputs; says why another is rendered again");
    command.add_flag("--list-inputs", options.list_inputs,
                     "Prints every file that the frames read, one on each line, instead of rendering");
    command
        .add_option("--checkpoint", options.checkpoint,
                    "Method path: keeps the state of the render in this file, with #### for the frame number, every "
                    "tracing.checkpoint_seconds, and resumes from it where it exists: after an interruption, or for "
                    "more paths than before. Its picture has the same bits as that of one uninterrupted render")
        ->type_name("FILE");
    command
        .add_option("--debug", options.debug,
                    "virtual-lights: pictures of the method beside the EXR, STEM.virtual_lights.*: the virtual lights "
                    "of surfaces as points (.ply), as the camera sees them (.exr, .png), how many cover each pixel "
                    "(.count.png), how long paths are (.path_length.png), and the glossy ones' profiles "
                    "(.profiles.exr, .profiles.png); the same as --set output.virtual_lights=true")
        ->check(one_of({kDebugVirtualLights}))
        ->type_name("WHAT")
        ->allow_extra_args(false);
    command.add_flag("--explain", options.explain, "Prints what ran, what was left out and why, and what it cost");
    command.add_flag("--print-config", options.print_config, "Prints the resolved shot instead of rendering");
}

void add_plan_options(CLI::App& command, PlanOptions& options) {
    add_shot_options(command, options.render);
    add_folder_and_failure_options(command, options.render);
    add_task_options(command, options.render);
    command.add_flag("--list-inputs", options.render.list_inputs,
                     "Prints every file that the frames read, one on each line, and nothing else");
    command.add_flag("--json", options.as_json,
                     "As JSON, with the files, the seconds and the memory that each frame is expected to need");
}

void add_verify_options(CLI::App& command, VerifyOptions& options) {
    add_shot_options(command, options.render);
    add_task_options(command, options.render);
    command
        .add_option("--fail-above", options.fail_above,
                    "Exit code 1 where a frame changes by more than this against both neighbours, e.g. 0.1")
        ->check(CLI::NonNegativeNumber)
        ->type_name("CHANGE");
}

void add_submit_options(CLI::App& command, SubmitOptions& options) {
    add_shot_options(command, options.render);
    add_cache_options(command, options.render.cache);
    command.add_flag("--make-folders", options.render.make_folders,
                     "Makes the folders of the outputs where they are missing");
    command.add_option("--engine", options.engine, fmt::format("{}", fmt::join(farm_engines(), ", ")))
        ->check(one_of(farm_engines()))
        ->type_name("ENGINE");
    CLI::Option* const tasks =
        command.add_option("--tasks", options.tasks, "How many; default: one for each frame, of engine local one")
            ->check(CLI::Range(1, 1'000'000));
    command.add_option("--frames-per-task", options.frames_a_task, "At most; instead of --tasks")
        ->check(CLI::Range(1, 1'000'000))
        ->excludes(tasks);
    command.add_option("--retries", options.retries, "Further tries of a task that failed; default 2")
        ->check(CLI::Range(0, 100));
    command
        .add_option("--memory", options.memory_mebibytes,
                    "Of a task [MiB]; default: what the frame with the largest file may need at most")
        ->check(CLI::Range(1, 1 << 30));
    command.add_option("--sbatch-option", options.engine_options, "Engine slurm: passed on to sbatch; repeatable")
        ->type_name("OPTION")
        ->allow_extra_args(false);
    command.add_option("--write", options.write, "Writes the job to this file instead of submitting it")
        ->type_name("FILE")
        ->allow_extra_args(false);
}

}  // namespace brisance
