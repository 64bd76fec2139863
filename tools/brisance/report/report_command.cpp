#include "report_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "core/error.h"
#include "core/parallel.h"
#include "film/whole_file.h"
#include "film/write_image.h"
#include "measured_shot.h"
#include "page.h"
#include "report_files.h"
#include "report_json.h"
#include "report_text.h"
#include "suite_command.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

struct ReportFiles {
    fs::path page, measurements, times, data;
    std::vector<fs::path> all() const { return {page, measurements, times, data}; }
};

ReportFiles report_files(const std::string& output) {
    return {page_file(output), file_beside(output, ".csv"), file_beside(output, ".times.csv"),
            file_beside(output, ".json")};
}

void write_report(const ReportFiles& files, const MeasuredShot& measured) {
    const nlohmann::ordered_json json = report_json(measured.report);
    write_json(files.data, json);
    write_text(files.measurements, measurements_csv(measured.report));
    write_text(files.times, times_csv(measured.report));
    write_text(files.page, report_page(json, measured.pictures.to_json()));
}

}  // namespace

int run_report(const ReportOptions& options) {
    if (!options.suite.empty())
        return run_suite(options);
    TextProgress progress(options.progress);
    const ThreadLimit limit(options.threads);
    const std::vector<Method> methods = parse_methods(options.methods);
    const ReportFiles files = report_files(options.output);
    const OpenedShot opened = open_shot(options, progress);
    std::vector<fs::path> inputs = {options.input, opened.frame.file};
    inputs.insert(inputs.end(), options.references.begin(), options.references.end());
    check_report_files(files.all(), inputs);
    const MeasuredShot measured = measure_shot(options, opened, methods, Comparing::All, progress);
    progress.stage("writing");
    write_report(files, measured);
    progress.finish();
    std::fputs(times_table(measured.report).c_str(), stdout);
    std::fputs(surface_table(measured.report).c_str(), stdout);
    for (const fs::path& file : files.all())
        fmt::print("{}\n", file.string());
    return static_cast<int>(ExitCode::Success);
}

}  // namespace brisance
