// The command line: options to functions, errors to exit codes.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <functional>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "command_options.h"
#include "compare/compare_command.h"
#include "compare/compare_report.h"
#include "compare/flicker_command.h"
#include "core/error.h"
#include "core/printable.h"
#include "film/whole_file.h"
#include "inspect.h"
#include "render_command.h"
#include "shot/nearest_key.h"
#include "shot/read_shot.h"
#include "shot/write_shot.h"
#include "stability_command.h"
#include "trace_path_command.h"
#ifdef BRISANCE_REPORT
#include "report/report_options.h"
#endif

namespace {

using namespace brisance;

constexpr const char* kExitCodes = R"(Exit codes:
  0    all frames written
  1    rendering failed; a measure of compare, flicker or verify is above its --fail-above; verify found frames that
       are not finished
  2    command line or shot file: unknown key, wrong type, value out of range
  65   a file exists but cannot be used: not a VDB, truncated, no usable grid; images that do not compare;
       a checkpoint of another render
  66   a file or frame is not there
  69   a program or a service is not there, or refuses: Slurm
  73   the output folder or file cannot be made
  74   writing failed half way: the disk is full
  75   out of memory: retry on a larger machine
  130  interrupted (143: terminated); nothing half-written is left)";

// Ends at once: pixels of an unfinished frame are worth nothing, and every output is whole or absent.
extern "C" void on_signal(int signal) {
    remove_unfinished_files();
    static constexpr char line[] = "\nbrisance: stopped\n";
    static_cast<void>(!write(STDERR_FILENO, line, sizeof(line) - 1));
    _exit(128 + signal);
}

void install_signal_handlers() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before {};
        // Under nohup, or in the background of a script, a signal may be ignored on purpose.
        if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(signal, &action, nullptr);
    }
    // Ignored, so that a file beyond its size limit is an error of write(), reported like a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
}

void add_compare_options(CLI::App& command, CompareOptions& options) {
    command.add_option("IMAGE", options.image, "The EXR to measure, with or without frame token (####)")->required();
    command
        .add_option("REFERENCE", options.references,
                    "The reference EXR, or two independent halves of it: their noise is then measured and removed")
        ->required()
        ->expected(1, 2);
    command.add_option("-f,--frames", options.frames, "Frames: 1001-1100x2,1200; without it, all of IMAGE on disk");
    CLI::Option* const cells =
        command.add_flag("--cells", options.cells, "Each layer that all have: V, MV, MM, bounce1, ...");
    command
        .add_option("--layers", options.layers,
                    "A layer, or a sum of layers (V+MV), instead of the beauty; an EXR of one layer stands for it")
        ->excludes(cells);
    command.add_flag("--json", options.as_json, "As JSON");
    command
        .add_option(
            "--motion", options.motion,
            "Of a sequence: the layer of IMAGE with motion vectors, two channels that lead from a pixel to where "
            "its point was in the frame before [pixels, x right, y down]; without it, flicker is measured along "
            "the movement of the cameras at the depth Z")
        ->type_name("LAYER");
    command.add_option("--spectrum", options.spectrum,
                       "Of a sequence: a page (.html) of the error's temporal spectrum");
    command.add_option("--flip-map", options.flip_map,
                       "A PNG of the errors that HDR-FLIP sees: black 0, violet, red, pale yellow 1");
    command
        .add_option("--fail-above", options.limits,
                    fmt::format("Exit code 1 when a measure is larger, or has pixels that are not finite; repeatable; "
                                "measures: {}",
                                fmt::join(metric_names(), ", ")))
        ->type_name("METRIC=VALUE")
        ->allow_extra_args(false);
    command.add_option("--pixels-per-degree", options.pixels_per_degree, "Angular resolution of HDR-FLIP; default 67")
        ->check(CLI::Range(1.0, 1000.0));
    command.add_flag("--force", options.force, "Compares images of different shots or frames");
}

void add_trace_path_options(CLI::App& command, TracePathOptions& options) {
    command.add_option("SHOT_OR_VDB", options.input, "A shot (JSON), or a .vdb with or without frame token (####)")
        ->required();
    command.add_option("X", options.x, "The pixel's column, from 0 at the left")->required();
    command.add_option("Y", options.y, "The pixel's row, from 0 at the top")->required();
    command.add_option("SAMPLE", options.sample, "The path's number in its pixel, from 0")->required();
    command.add_option("-f,--frame", options.frames, "The frame; without it, the only one on disk");
    add_common_options(command, options);
}

// All commands with their options; the parsed command runs.
class CommandLine {
public:
    CommandLine(int argc, char** argv) : argc_(argc), argv_(argv) {
        app_.set_version_flag("--version", "brisance " BRISANCE_VERSION);
        app_.require_subcommand(1);
        app_.footer(kExitCodes);
        add_rendering();
        add_comparing();
        add_studies();
    }

    int run() {
        if (argc_ == 1) {
            std::fputs(app_.help().c_str(), stdout);
            return static_cast<int>(ExitCode::Usage);
        }
        check_command(argv_[1]);
        try {
            app_.parse(argc_, argv_);
        } catch (const CLI::ParseError& error) {
            if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
                return app_.exit(error);  // help, or the version
            throw Error(ExitCode::Usage, in_our_words(error));
        }
        for (const auto& [command, run] : commands_)
            if (command->parsed())
                return run();
        return static_cast<int>(ExitCode::Usage);  // a subcommand is required
    }

private:
    void check_command(const std::string& given) const {
        std::vector<std::string> names;
        for (const auto& [command, run] : commands_)
            names.push_back(command->get_name());
        if (!given.starts_with('-') && std::find(names.begin(), names.end(), given) == names.end())
            throw Error(ExitCode::Usage, fmt::format("unknown command {}; did you mean {}?",
                                                     printable(given, kLongestName), nearest_key(given, names)));
    }

    // The command that was given, or the program.
    const CLI::App& parsed_app() const {
        for (const auto& [command, run] : commands_)
            if (command->get_name() == argv_[1])
                return *command;
        return app_;
    }

    // Names the nearest option where one is unknown.
    std::string in_our_words(const CLI::ParseError& error) const {
        const CLI::App& app = parsed_app();
        const std::string help =
            fmt::format("`brisance {}--help` lists all options", &app == &app_ ? "" : app.get_name() + " ");
        const std::vector<std::string> unexpected = app.remaining();
        const std::string what = printable(error.what());
        if (unexpected.empty())
            return fmt::format("{}{} {}", what, what.ends_with('?') ? "" : ";", help);
        const std::string& given = unexpected.front();
        const std::string name = printable(given.substr(0, given.find('=')), kLongestName);
        if (!given.starts_with('-'))
            return fmt::format("unexpected argument {}; {}", printable(given, kLongestName), help);
        if (!given.starts_with("--"))
            return fmt::format("unknown option {}; {}", name, help);
        std::vector<std::string> known;
        for (const CLI::Option* const option : app.get_options())
            for (const std::string& long_name : option->get_lnames())
                known.push_back("--" + long_name);
        return fmt::format("unknown option {}; did you mean {}? {}", name, nearest_key(name, known), help);
    }

    CLI::App& add(const char* name, const char* help, const std::function<int()>& run) {
        CLI::App* const command = app_.add_subcommand(name, help);
        commands_.emplace_back(command, run);
        return *command;
    }

    void add_rendering() {
        CLI::App& render =
            add("render", "Renders a shot, or a bare .vdb, to OpenEXR", [this] { return run_render(options_); });
        add_render_options(render, options_);
        render.footer(kExitCodes);
        add_plan_options(
            add("plan", "Prints what a render would read, run and leave out", [this] { return run_plan(planned_); }),
            planned_);
        add_verify_options(add("verify", "Says which frames are missing, damaged or of another render",
                               [this] { return run_verify(verified_); }),
                           verified_);
        CLI::App& submit = add("submit", "Renders a sequence by tasks, on this machine or on a farm",
                               [this] { return run_submit(submitted_); });
        add_submit_options(submit, submitted_);
        submit.footer(kExitCodes);
        CLI::App& inspect = add("inspect", "Prints a .vdb file's grids and suggests a shot",
                                [this] { return run_inspect(inspected_); });
        inspect
            .add_option(
                "FILE", inspected_.input,
                "The .vdb file, or a sequence (####, or its folder): its largest file and the look of the whole")
            ->required();
        inspect.add_flag("--json", inspected_.as_json, "As JSON");
        inspect.add_option("--write-look", inspected_.write_look, "Writes the first look to a file, for render --look")
            ->type_name("FILE");
    }

    void add_comparing() {
        CLI::App& compare =
            add("compare", "Measures how far an EXR is from a reference", [this] { return run_compare(comparison_); });
        add_compare_options(compare, comparison_);
        compare.footer(kExitCodes);
        CLI::App& flicker = add("flicker", "Measures how much a still changes that ought not to: no reference needed",
                                [this] { return run_flicker(flickering_); });
        add_flicker_options(flicker, flickering_);
        add_common_options(flicker, flickering_);
        flicker.footer(kExitCodes);
#ifdef BRISANCE_REPORT
        CLI::App& report =
            add("report", "Measures methods against a reference, on one shot or a suite of scenes: page, CSV and JSON",
                [this] { return report_on(reported_); });
        add_report_options(report, reported_);
        report.footer(kExitCodes);
        reported_.command_line = {"brisance"};
        reported_.command_line.insert(reported_.command_line.end(), argv_ + 1, argv_ + argc_);
#endif
    }

    void add_studies() {
        CLI::App& stability =
            add("stability", "Renders extreme cases by every method and prints a table of their errors",
                [this] { return run_stability(extreme_); });
        std::vector<std::string> known = stability_methods(), presets = stability_presets();
        known.insert(known.end(), presets.begin(), presets.end());
        stability
            .add_option("--methods", extreme_.methods,
                        fmt::format("{}; these are the default; or {}", fmt::join(extreme_.methods, ", "),
                                    fmt::join(presets, ", ")))
            ->check(one_of(known))
            ->delimiter(',');
        stability.add_option("--case", extreme_.part, "Only cases whose name contains this");
        stability.add_flag("--markdown", extreme_.markdown, "As a table for a document");
        stability.add_flag("--json", extreme_.json, "As JSON");
        add_trace_path_options(add("trace-path", "Prints one path of method path, vertex by vertex",
                                   [this] { return run_trace_path(traced_); }),
                               traced_);
        add("schema", "Prints the JSON Schema of shots", [this] {
            std::fputs((keys_ ? shot_keys_text() : shot_schema()).c_str(), stdout);
            return static_cast<int>(ExitCode::Success);
        }).add_flag("--keys", keys_, "Prints all keys of a shot for people instead");
    }

    int argc_;
    char** argv_;
    CLI::App app_{"Brisance renders OpenVDB fire and smoke: the fire lights its own smoke.", "brisance"};
    std::vector<std::pair<CLI::App*, std::function<int()>>> commands_;
    RenderOptions options_;
    PlanOptions planned_;
    VerifyOptions verified_;
    SubmitOptions submitted_;
    InspectOptions inspected_;
    bool keys_ = false;
    CompareOptions comparison_;
    FlickerOptions flickering_;
#ifdef BRISANCE_REPORT
    ReportOptions reported_;
#endif
    StabilityOptions extreme_;
    TracePathOptions traced_;
};

int fail(ExitCode code, const std::string& line) {
    if (standard_error_is_json()) {
        TextProgress(ProgressStyle::Ndjson).error(line);
        return static_cast<int>(code);
    }
    fmt::print(stderr, "brisance: error: {}\n", printable_line(line));
    return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
    install_signal_handlers();
    try {
        const int code = CommandLine(argc, argv).run();
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
            return fail(ExitCode::OutputFailed, "cannot write to standard output");
        return code;
    } catch (const Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::Temporary, "out of memory; render at a lower resolution or on a larger machine");
    } catch (const std::exception& error) {
        return fail(ExitCode::RenderFailed, error.what());
    }
}
