#include "report/report_options.h"

#include <fmt/format.h>

#include "command_options.h"
#include "core/error.h"
#include "suite/suite.h"

namespace brisance {
namespace {

std::string suites_help() {
    std::vector<std::string> lines;
    for (const SuiteSize& size : suite_sizes())
        lines.push_back(size.name + ": " + size.help);
    return fmt::format("{}", fmt::join(lines, "; "));
}

}  // namespace

int report_on(ReportOptions options) {
    if (options.suite.empty() && options.inputs.size() != 1)
        throw Error(ExitCode::Usage,
                    fmt::format("report takes one SHOT_OR_VDB, or --suite; {} were given", options.inputs.size()));
    if (options.suite.empty())
        options.input = options.inputs.front();
    return run_report(options);
}

void add_report_options(CLI::App& command, ReportOptions& options) {
    command
        .add_option("SHOT_OR_VDB", options.inputs,
                    "A shot (JSON), glTF, or a .vdb with or without frame token (####); with --suite, further scenes")
        ->type_name("");
    command.add_option("-o,--output", options.output,
                       "The page; CSV and JSON go beside it, of a suite also a summary (.md); default report.html");
    CLI::Option* const frame =
        command.add_option("-f,--frame", options.frame, "The frame; without it, the only one on disk");
    CLI::Option* const suite =
        command.add_option("--suite", options.suite, "All methods on a list of scenes; " + suites_help())
            ->excludes(frame);
    command
        .add_option("--shots", options.shots,
                    "The folder with the suite's shots: explosion.json, fire_room.json, street.json, media/*.json; "
                    "default shots")
        ->needs(suite);
    command
        .add_option("--scenes", options.scenes,
                    "Only these of the suite's: explosion street media/candle; default: all")
        ->type_name("NAME ...")
        ->needs(suite);
    command
        .add_option("--strip", options.strip_frames,
                    "Frames of a film strip of each method, which show its flicker, at its cheapest step; 0: none; "
                    "default 3, of quick 0")
        ->type_name("FRAMES")
        ->check(CLI::Range(0, 16))
        ->needs(suite);
    command
        .add_option("--methods", options.methods.methods,
                    fmt::format("NAME, or LABEL=NAME, and settings: exact=path,tracing.free_flight=exact; "
                                "names: {}; default: lighting_grid path; of a suite: all",
                                fmt::join(built_in_methods(), ", ")))
        ->type_name("METHOD ...");
    command
        .add_option("--budgets", options.methods.budgets,
                    "Paths per pixel of the path methods: 4,16,64,256; of one method alone: path:16,64; steps 1 to 4, "
                    "from coarse to fine, of the other one: lighting_grid:2,3; lamps: fire_clusters:4,64; directions: "
                    "radiance_cascades:4,8; lattice levels: diffusion:2,1")
        ->type_name("[METHOD:]LIST ...")
        ->excludes(suite);
    command
        .add_option("--ladder", options.methods.ladders,
                    "Steps of a method's own: lighting_grid:lighting.alpha=1,2,3; several keys go side by side")
        ->type_name("METHOD:KEY=LIST ...")
        ->excludes(suite);
    CLI::Option* const reference =
        command
            .add_option("--reference", options.references,
                        "An EXR, or two independent halves, instead of a reference made for the report")
            ->expected(1, 2)
            ->excludes(suite);
    command
        .add_option(
            "--reference-samples", options.reference_samples,
            "Paths per pixel of the reference; default: 1024, or four times the largest budget; of a suite: its own")
        ->check(CLI::Range(4, 1 << 30))
        ->excludes(reference);
    command.add_option("--reference-seconds", options.reference_seconds, "Stops the reference after this time [s]")
        ->check(CLI::PositiveNumber)
        ->excludes(reference)
        ->excludes(suite);
    command
        .add_option(
            "--repeats", options.repeats,
            "Renders each step this many times, with other seeds each time: its errors are means with their standard "
            "deviation, its time is the median")
        ->check(CLI::Range(1, 1000));
    command.add_option("--exposures", options.exposures, "Of the page's pictures, beside the shot's [stops]: -3,0,3")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->excludes(suite);
    command.add_option("--picture-width", options.picture_width, "Of the page's pictures, at most [pixels]: 480")
        ->check(CLI::Range(16, 16384));
    add_common_options(command, options);
}

}  // namespace brisance
