#include "report_json.h"
#include "report_text.h"
#include "suite/contest.h"
#include "suite/suite_report.h"

namespace brisance {
namespace {

using Json = nlohmann::ordered_json;

Json reading_json(const Reading& reading) {
    return {{"value", reading.kind == ReadingKind::NotReached ? Json() : json_number(reading.value)},
            {"kind", name_of(reading.kind)}};
}

Json index_json(const std::optional<std::size_t>& index) {
    return index ? Json(*index) : Json();
}

Json contest_json(const Contest& contest) {
    Json contenders = Json::array();
    for (const Contender& contender : contest.contenders) {
        Json times = Json::array();
        for (const Reading& time : contender.times)
            times.push_back(reading_json(time));
        contenders.push_back({{"method", contender.method},
                              {"error", reading_json(contender.error)},
                              {"times", std::move(times)},
                              {"floor", json_number(contender.floor)},
                              {"floor_spread", contender.floor_spread ? json_number(*contender.floor_spread) : Json()},
                              {"flicker", contender.flicker ? json_number(*contender.flicker) : Json()}});
    }
    return {{"cell", contest.cell},
            {"seconds", contest.seconds},
            {"reference_noise", json_number(contest.noise)},
            {"contenders", std::move(contenders)},
            {"best_at_time", index_json(contest.at_time)},
            {"second_at_time", index_json(second_at_time(contest))},
            {"target", contest.target ? Json(kSuiteTargets[*contest.target]) : Json()},
            {"best_at_error", index_json(contest.at_error)}};
}

Json scene_json(const MeasuredScene& scene, Json index) {
    Json cells = Json::array(), failures = Json::array();
    if (scene.report) {
        for (const Contest& contest : contests(*scene.report, kSuiteClock))
            cells.push_back(contest_json(contest));
        for (const MethodFailure& failure : scene.report->failures)
            failures.push_back({{"method", failure.method}, {"reason", failure.reason}});
    }
    return {{"name", scene.scene.name},
            {"failure", scene.report ? Json() : Json(scene.failure)},
            {"report", std::move(index)},
            {"cells", std::move(cells)},
            {"failures", std::move(failures)}};
}

Json head_json(const SuiteReport& suite) {
    const SuiteSize& size = suite.size;
    return {{"schema_version", 1},
            {"suite", size.name},
            {"brisance", suite.version},
            {"date", suite.date},
            {"command", suite.command},
            {"seconds", suite.seconds},
            {"clock", "cpu"},
            {"targets", kSuiteTargets},
            {"size",
             {{"width", size.width},
              {"reference_samples", suite.reference_samples},
              {"path_samples", size.path_samples},
              {"grid_steps", size.grid_steps},
              {"sides", size.sides},
              {"settings", size.settings},
              {"beside_fire", size.beside_fire},
              {"beside_fire_of_surfaces", size.beside_fire_of_surfaces},
              {"beside_scattering", size.beside_scattering}}}};
}

}  // namespace

Json suite_json(const SuiteReport& suite) {
    Json json = head_json(suite), scenes = Json::array();
    std::size_t index = 0;
    for (const MeasuredScene& scene : suite.scenes)
        scenes.push_back(scene_json(scene, scene.report ? Json(index++) : Json()));
    json["scenes"] = std::move(scenes);
    return json;
}

Json suite_json_with_reports(const SuiteReport& suite) {
    Json json = head_json(suite), scenes = Json::array();
    for (const MeasuredScene& scene : suite.scenes)
        scenes.push_back(scene_json(scene, scene.report ? report_json(*scene.report) : Json()));
    json["scenes"] = std::move(scenes);
    return json;
}

std::string suite_csv(const SuiteReport& suite) {
    std::string csv;
    for (const MeasuredScene& scene : suite.scenes) {
        if (!scene.report)
            continue;
        const std::string rows = measurements_csv(*scene.report);
        csv += csv.empty() ? rows : rows.substr(rows.find('\n') + 1);  // one head
    }
    return csv;
}

}  // namespace brisance
