#include "suite_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "film/write_image.h"
#include "measured_shot.h"
#include "named_progress.h"
#include "page.h"
#include "report_files.h"
#include "report_json.h"
#include "suite/suite_report.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

struct SuiteFiles {
    fs::path page, summary, measurements, data;
    std::vector<fs::path> all() const { return {page, summary, measurements, data}; }
};

SuiteFiles suite_files(const std::string& output) {
    return {page_file(output), file_beside(output, ".md"), file_beside(output, ".csv"), file_beside(output, ".json")};
}

// Those of the suite for one scene, the settings of the command line last.
ReportOptions options_for(const SuiteScene& scene, const SuiteSize& size, const ReportOptions& given) {
    ReportOptions options = given;
    options.input = scene.file.string();
    options.overrides = size.settings;
    options.overrides.insert(options.overrides.end(), given.overrides.begin(), given.overrides.end());
    if (options.reference_samples == 0)
        options.reference_samples = size.reference_samples;
    options.exposures = {0.0};
    options.strip_frames = given.strip_frames.value_or(size.strip_frames);
    return options;
}

MeasuredShot measure_scene(const SuiteScene& scene, const SuiteSize& size, const std::vector<Method>& methods,
                           const ReportOptions& given, Progress& progress) {
    ReportOptions options = options_for(scene, size, given);
    OpenedShot opened = open_shot(options, progress);
    const std::vector<std::string> shape =
        size_settings(size, opened.shot.camera.width, opened.shot.camera.height, given.overrides);
    if (!shape.empty()) {
        options.overrides.insert(options.overrides.end(), shape.begin(), shape.end());
        opened = open_shot(options, progress);
    }
    return measure_shot(options, opened, methods, Comparing::Owners, progress);
}

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

MeasuredScene try_scene(const SuiteScene& scene, const SuiteSize& size, const std::vector<Method>& methods,
                        const ReportOptions& given, Progress& progress) {
    MeasuredScene measured{scene, std::nullopt, {}, std::nullopt};
    try {
        MeasuredShot shot = measure_scene(scene, size, methods, given, progress);
        measured.report = std::move(shot.report);
        measured.pictures = std::move(shot.pictures);
    } catch (const std::exception& error) {
        measured.failure = first_line(error.what());
    }
    return measured;
}

void write_suite(const SuiteFiles& files, const SuiteReport& suite) {
    std::vector<ScenePage> pages;
    for (const MeasuredScene& scene : suite.scenes)
        if (scene.report)
            pages.push_back({report_json(*scene.report), scene.pictures->to_json()});
    write_json(files.data, suite_json_with_reports(suite));
    write_text(files.measurements, suite_csv(suite));
    write_text(files.summary, suite_markdown(suite));
    write_text(files.page, suite_page(suite_json(suite), pages));
}

void print_rows(const SuiteReport& suite) {
    for (const MeasuredScene& scene : suite.scenes) {
        if (!scene.report)
            fmt::print("{}: failed: {}\n", scene.scene.name, scene.failure);
        else
            fmt::print("{}: {} methods, {} failures\n", scene.scene.name, scene.report->methods.size(),
                       scene.report->failures.size());
    }
}

std::string command_of(const ReportOptions& options) {
    std::string line;
    for (const std::string& word : options.command_line)
        line += fmt::format("{}{}", line.empty() ? "" : " ", shell_quoted(word));
    return line;
}

}  // namespace

int run_suite(const ReportOptions& options) {
    TextProgress progress(options.progress);
    const ThreadLimit limit(options.threads);
    const SuiteSize& size = suite_size(options.suite);
    if (options.strip_frames == 1)
        throw Error(ExitCode::Usage, "--strip 1: nothing changes in one frame; take 0, or 2 and more");
    const std::vector<Method> methods = suite_methods(size, options.methods.methods);
    const std::vector<SuiteScene> scenes = suite_scenes(options.shots, options.scenes, options.inputs);
    const SuiteFiles files = suite_files(options.output);
    std::vector<fs::path> inputs;
    for (const SuiteScene& scene : scenes)
        inputs.push_back(scene.file);
    check_report_files(files.all(), inputs);

    const Stopwatch watch;
    SuiteReport suite{size,
                      options.reference_samples > 0 ? options.reference_samples : size.reference_samples,
                      BRISANCE_VERSION,
                      report_date(),
                      command_of(options),
                      this_machine(),
                      0.0,
                      {}};
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        NamedProgress named(progress, fmt::format("scene {} of {}, {}", i + 1, scenes.size(), scenes[i].name));
        suite.scenes.push_back(try_scene(scenes[i], size, methods, options, named));
    }
    suite.seconds = watch.seconds();
    if (std::none_of(suite.scenes.begin(), suite.scenes.end(),
                     [](const MeasuredScene& s) { return s.report.has_value(); }))
        throw Error(ExitCode::RenderFailed,
                    fmt::format("every scene failed; {}: {}", suite.scenes[0].scene.name, suite.scenes[0].failure));
    progress.stage("writing");
    write_suite(files, suite);
    progress.finish();
    print_rows(suite);
    for (const fs::path& file : files.all())
        fmt::print("{}\n", file.string());
    return static_cast<int>(ExitCode::Success);
}

}  // namespace brisance
