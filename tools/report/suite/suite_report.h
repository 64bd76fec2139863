// What `brisance report --suite` found, as JSON, as CSV and as a document in Markdown.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "page_pictures.h"
#include "report.h"
#include "suite/suite.h"

namespace brisance {

struct MeasuredScene {
    SuiteScene scene;
    std::optional<Report> report;            // absent: the scene failed
    std::string failure;                     // why, in one line
    std::optional<PagePictures> pictures{};  // with the report
};

struct SuiteReport {
    SuiteSize size;
    int reference_samples = 0;  // paths per pixel, of the scenes
    std::string version;
    std::string date;  // as Report::date
    std::string command;
    Machine machine;
    double seconds = 0.0;  // of the whole, wall time
    std::vector<MeasuredScene> scenes;
};

// Times are compared by this clock: CPU time is hardly disturbed by other work on the machine.
constexpr Clock kSuiteClock = Clock::Cpu;

// Without the reports of the scenes, which `index` numbers: "report" is that of a measured scene, else null.
nlohmann::ordered_json suite_json(const SuiteReport& suite);

// With the whole reports of all scenes.
nlohmann::ordered_json suite_json_with_reports(const SuiteReport& suite);

// measurements_csv of all scenes.
std::string suite_csv(const SuiteReport& suite);

// The document: who is best, what failed, and the figures of every scene, cell and method.
std::string suite_markdown(const SuiteReport& suite);

}  // namespace brisance
