// Options of the commands that render or deal with rendered frames.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "progress.h"
#include "sequence/plan_command.h"
#include "sequence/verify_command.h"
#include "shot/read_shot.h"
#include "submit/submit_command.h"

namespace brisance {

// Accepts these words alone, and says which it expected and which is nearest.
CLI::Validator one_of(const std::vector<std::string>& words);

// Options of every command that renders.
template <class Options>
void add_common_options(CLI::App& command, Options& options) {
    static const std::map<std::string, ProgressStyle> styles = {
        {"auto", ProgressStyle::Automatic}, {"bar", ProgressStyle::Bar},       {"tty", ProgressStyle::Bar},
        {"plain", ProgressStyle::Plain},    {"alfred", ProgressStyle::Alfred}, {"ndjson", ProgressStyle::Ndjson},
        {"none", ProgressStyle::None}};
    std::vector<std::string> style_names;
    for (const auto& [name, style] : styles)
        style_names.push_back(name);
    command.add_option("--set", options.overrides, "Overrides one key of the shot: --set smoke.albedo=0.9; repeatable")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command.add_option("--preset", options.preset, "draft: quick look; final: the shot as written")
        ->check(one_of(shot_presets()));
    command.add_option("--threads", options.threads, "Threads; 0: all processors. Never changes the picture")
        ->check(CLI::Range(0, 4096));
    command
        .add_option(
            "--progress", options.progress,
            "auto, bar (or tty), plain (lines), alfred (ALF_PROGRESS 12%), ndjson (one JSON object on each line) or "
            "none")
        ->transform(CLI::Transformer(styles).description(""))
        ->transform(one_of(style_names).description(""))  // comes first
        ->type_name("STYLE");
}

void add_render_options(CLI::App& command, RenderOptions& options);
void add_plan_options(CLI::App& command, PlanOptions& options);
void add_verify_options(CLI::App& command, VerifyOptions& options);
void add_submit_options(CLI::App& command, SubmitOptions& options);

}  // namespace brisance
