// The command line: options to functions, errors to exit codes.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <map>
#include <new>
#include <string>

#include "core/error.h"
#include "film/whole_file.h"
#include "inspect.h"
#include "render_command.h"
#include "shot/read_shot.h"
#include "shot/write_shot.h"

namespace {

using namespace brisance;

constexpr const char* kExitCodes = R"(Exit codes:
  0    all frames written
  1    rendering failed
  2    command line or shot file: unknown key, wrong type, value out of range
  65   a file exists but cannot be used: not a VDB, truncated, no usable grid
  66   a file or frame is not there
  73   the output folder or file cannot be made
  74   writing failed half way: the disk is full
  75   out of memory: worth a retry on a larger machine
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
    // A file that grows beyond its limit is then an error of write, reported like a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
}

void add_shot_options(CLI::App& command, RenderOptions& options) {
    static const std::map<std::string, ProgressStyle> styles = {{"auto", ProgressStyle::Automatic},
                                                                {"tty", ProgressStyle::Bar},
                                                                {"plain", ProgressStyle::Plain},
                                                                {"none", ProgressStyle::None}};
    command.add_option("SHOT_OR_VDB", options.input, "A shot (JSON), or a .vdb with or without frame token (####)")
        ->required();
    command.add_option("-o,--output", options.output,
                       "The EXR, with #### for the frame number, or a folder; PNG and statistics go beside it");
    command.add_option("-f,--frames", options.frames, "Frames: 1001-1100x2,1200; without it, all that are on disk");
    command.add_option("--set", options.overrides, "Overrides one key of the shot: --set smoke.albedo=0.9; repeatable")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command.add_option("--preset", options.preset, "draft: quick look; final: the shot as written")
        ->check(CLI::IsMember(shot_presets()));
    command.add_option("--threads", options.threads, "Threads; 0: all processors. Never changes the picture")
        ->check(CLI::Range(0, 4096));
    command.add_option("--progress", options.progress, "auto, tty (bar), plain (lines) or none")
        ->transform(CLI::CheckedTransformer(styles).description(""))
        ->type_name("STYLE");
    command.add_flag("--keep-going", options.keep_going, "A frame that fails does not stop the others");
}

int run(int argc, char** argv) {
    CLI::App app("Brisance renders OpenVDB fire and smoke: the fire lights its own smoke.", "brisance");
    app.set_version_flag("--version", "brisance " BRISANCE_VERSION);
    app.require_subcommand(1);
    app.footer(kExitCodes);

    RenderOptions options;
    CLI::App* const render = app.add_subcommand("render", "Renders a shot, or a bare .vdb, to OpenEXR");
    add_shot_options(*render, options);
    render->add_flag("--explain", options.explain, "Prints what ran, what was left out and why, and what it cost");
    render->add_flag("--print-config", options.print_config, "Prints the resolved shot instead of rendering");
    render->footer(kExitCodes);

    CLI::App* const plan = app.add_subcommand("plan", "Prints what a render would read, run and leave out");
    add_shot_options(*plan, options);

    std::string file;
    bool as_json = false;
    CLI::App* const inspect = app.add_subcommand("inspect", "Prints a .vdb file's grids and suggests a shot");
    inspect->add_option("FILE", file, "The .vdb file")->required();
    inspect->add_flag("--json", as_json, "As JSON");

    bool keys = false;
    CLI::App* const schema = app.add_subcommand("schema", "Prints the JSON Schema of shots");
    schema->add_flag("--keys", keys, "Prints all keys of a shot for people instead");

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::Usage);
    }
    if (render->parsed())
        return run_render(options);
    if (plan->parsed())
        return run_plan(options);
    if (inspect->parsed())
        return run_inspect(file, as_json);
    std::fputs((keys ? shot_keys_text() : shot_schema()).c_str(), stdout);
    return static_cast<int>(ExitCode::Success);
}

int fail(ExitCode code, const std::string& line) {
    fmt::print(stderr, "brisance: error: {}\n", line);
    return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
    install_signal_handlers();
    try {
        const int code = run(argc, argv);
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
