// The comparison of all methods on several scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "core/error.h"
#include "fire_lights/samplings.h"
#include "suite/contest.h"
#include "suite/suite.h"
#include "suite/suite_report.h"
#include "unified_lights/samplings.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

std::set<std::string> labels_of(const std::vector<Method>& methods) {
    std::set<std::string> labels;
    for (const Method& method : methods)
        labels.insert(method.label);
    return labels;
}

std::vector<Method> all_methods() {
    return suite_methods(suite_size("quick"), {});
}

TEST(SuiteMethods, AreAllOfTheTable) {
    EXPECT_EQ(labels_of(all_methods()), std::set<std::string>(built_in_methods().begin(), built_in_methods().end()));
}

// What scatters the grid's light on is judged by it, and begins with light as good as the grid's.
TEST(SuiteMethods, OfWhatScattersOnKeepTheLightOfTheFire) {
    const std::vector<std::string>& coarse = suite_size("quick").beside_fire;
    const auto has_coarse_fire = [&](const std::string& name) {
        const std::vector<std::string> settings = suite_methods(suite_size("quick"), {name})[0].settings;
        return std::find(settings.begin(), settings.end(), coarse[0]) != settings.end();
    };
    for (const char* const name : {"radiance_cascades", "diffusion", "lighting_grid"})
        EXPECT_FALSE(has_coarse_fire(name)) << name;
    EXPECT_TRUE(has_coarse_fire("ray_lights"));
}

// Paths between surfaces would walk through the smoke of any other method.
TEST(SuiteMethods, OfSurfacesHaveTheSmokeOfTheGrid) {
    const auto has = [](const Method& method, const std::string& setting) {
        return std::find(method.settings.begin(), method.settings.end(), setting) != method.settings.end();
    };
    for (const SuiteSize& size : suite_sizes()) {
        int surfaces = 0;
        for (const Method& method : suite_methods(size, {})) {
            if (!owns(method, name_of(Cell::SS)) || has(method, "method=path"))
                continue;
            ++surfaces;
            EXPECT_TRUE(has(method, "scattering.method=lighting_grid")) << size.name << ": " << method.label;
            for (const std::string& coarse : size.beside_fire)
                EXPECT_FALSE(has(method, coarse)) << size.name << ": " << method.label << ": " << coarse;
            for (const std::string& finer : size.beside_fire_of_surfaces)
                EXPECT_TRUE(has(method, finer)) << size.name << ": " << method.label << ": " << finer;
        }
        EXPECT_GT(surfaces, 10) << size.name;
    }
}

TEST(SuiteMethods, EachOwnsACellAndEachCellHasTwo) {
    const std::vector<Method> methods = all_methods();
    for (const Method& method : methods)
        EXPECT_EQ(owners_of({method}, method.cells).size(), 1u) << method.label;
    for (int cell = 0; cell < kCells; ++cell)
        EXPECT_GE(owners_of(methods, {static_cast<Cell>(cell)}).size(), 2u) << kCellNames[cell];
}

// Without surfaces virtual lights have nothing to carry, and with single scattering alone scattering methods neither.
TEST(SuiteMethods, OfASceneFollowFromItsCells) {
    const std::vector<Method> methods = all_methods();
    const std::set<std::string> free_fire = labels_of(owners_of(methods, {Cell::V, Cell::MV, Cell::MM}));
    EXPECT_TRUE(free_fire.contains("ray_lights"));
    EXPECT_TRUE(free_fire.contains("lighting_grid"));
    EXPECT_FALSE(free_fire.contains("vbnl"));
    EXPECT_FALSE(free_fire.contains("vpl"));
    const std::set<std::string> single = labels_of(owners_of(methods, {Cell::V, Cell::MV}));
    std::set<std::string> of_fire = {"lighting_grid", "path", "path_plain", "path_filtered", "fire_clusters"};
    for (const FireLightSampling& row : fire_light_samplings())
        if (!row.asks_every_light)
            of_fire.insert(std::string("fire_") + row.name);
    for (const UnifiedLightSampling& row : unified_light_samplings())  // one tree, with the fire alone in it
        if (!row.asks_every_light)
            of_fire.insert(std::string("unified_") + row.name);
    EXPECT_EQ(single, of_fire);
    const std::set<std::string> room = labels_of(owners_of(methods, {Cell::SS}));
    EXPECT_TRUE(room.contains("vbnl"));
    EXPECT_FALSE(room.contains("lighting_grid"));
    EXPECT_FALSE(room.contains("ray_lights"));
    EXPECT_TRUE(owners_of(methods, {}).empty());
}

TEST(SuiteMethods, HaveTheBudgetsOfTheSuite) {
    const std::vector<Method> methods = suite_methods(suite_size("full"), {"path", "lighting_grid", "vbnl"});
    ASSERT_EQ(methods.size(), 3u);
    EXPECT_EQ(methods[0].steps.size(), 4u);
    EXPECT_EQ(methods[0].steps.back().label, "256 spp");
    EXPECT_EQ(methods[1].steps.size(), 4u);
    ASSERT_EQ(methods[2].steps.size(), 3u);
    EXPECT_EQ(methods[2].steps.back().settings.back(), "camera.samples_per_axis=4");
    EXPECT_THROW(suite_size("middling"), Error);
    const std::vector<Method> baselines =
        suite_methods(suite_size("full"), {"fire_clusters", "path_filtered", "radiance_cascades"});
    EXPECT_EQ(baselines[2].steps.size(), 3u);
    EXPECT_EQ(baselines[0].steps.back().label, "256 lamps");
    EXPECT_EQ(baselines[1].steps.back().label, "256 spp");
}

TEST(SuiteScenes, AreTheListThenMediaThenFurther) {
    const fs::path shots = fs::path(testing::TempDir()) / "suite_scenes";
    fs::create_directories(shots / "media");
    for (const char* const name : {"media/b.json", "media/a.json", "media/notes.txt"})
        std::ofstream(shots / name) << "{}";
    std::vector<std::string> names;
    for (const SuiteScene& scene : suite_scenes(shots, {}, {"sets/room.glb"}))
        names.push_back(scene.name);
    EXPECT_EQ(names, (std::vector<std::string>{"explosion", "fire_room", "street", "media/a", "media/b", "room"}));
    const std::vector<SuiteScene> some = suite_scenes(shots, {"media/b", "explosion"}, {"sets/room.glb"});
    ASSERT_EQ(some.size(), 3u);
    EXPECT_EQ(some[0].name, "explosion");
    EXPECT_EQ(some[1].name, "media/b");
    EXPECT_EQ(some[2].name, "room");
    EXPECT_THROW(suite_scenes(shots, {"media/c"}, {}), Error);
    fs::remove_all(shots);
    EXPECT_THROW(suite_scenes(shots, {}, {}), Error);
}

TEST(SuiteScenes, KeepTheirShape) {
    SuiteSize size;
    size.width = 64;
    EXPECT_EQ(size_settings(size, 1280, 720, {}), (std::vector<std::string>{"camera.width=64", "camera.height=36"}));
    EXPECT_EQ(size_settings(size, 500, 1000, {}).back(), "camera.height=128");
    EXPECT_TRUE(size_settings(size, 1280, 720, {"camera.width=8"}).empty());
}

// A method that owns these cells, with runs of these CPU times [s] and errors in all of them.
MethodResult measured(const std::string& label, const CellSet& cells, bool averages,
                      const std::vector<std::pair<double, double>>& runs) {
    MethodResult result;
    result.method.label = label;
    result.method.cells = cells;
    result.method.averages = averages;
    for (const auto& [seconds, error] : runs) {
        MeasuredRun run;
        run.cost = {10.0 * seconds, seconds};
        for (const char* const layer : {"", "MM", "SS"})
            run.errors[layer].differences.rrmse = error;
        result.runs.push_back(run);
    }
    return result;
}

// The grid is quick and stays at its bias; paths are slow and go on; virtual lights compete in SS alone.
Report three_methods() {
    Report report;
    report.layers = {"", "MM", "SS"};
    report.reference.noise = {{"MM", 0.001}};
    report.methods = {measured("grid", {Cell::MM}, false, {{1.0, 0.08}, {2.0, 0.06}}),
                      measured("paths", {Cell::MM, Cell::SS}, true, {{1.0, 0.16}, {4.0, 0.08}, {16.0, 0.04}}),
                      measured("lights", {Cell::SS}, false, {{2.0, 0.5}})};
    return report;
}

TEST(Contests, AreAmongTheOwnersOfACell) {
    const std::vector<Contest> all = contests(three_methods(), Clock::Cpu);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].cell, "MM");
    ASSERT_EQ(all[0].contenders.size(), 2u);
    EXPECT_EQ(all[0].contenders[0].method, "grid");
    EXPECT_EQ(all[0].noise, 0.001);
    ASSERT_EQ(all[1].contenders.size(), 2u);
    EXPECT_EQ(all[1].contenders[1].method, "lights");
}

// What do the others give for the time of the method that nobody has to ask for?
TEST(Contests, AreHeldInTheTimeOfTheDefault) {
    Report report = three_methods();
    report.methods[1].method.by_default = true;
    const Contest contest = contests(report, Clock::Cpu)[0];
    EXPECT_EQ(contest.seconds, 16.0);
    EXPECT_EQ(contest.at_time, 1u);
    const std::vector<Method> methods = suite_methods(suite_size("quick"), {});
    for (const Method& method : methods)
        EXPECT_EQ(method.by_default, method.base == "lighting_grid" || method.base == "vbnl") << method.label;
}

TEST(Contests, HaveAWinnerAtEqualTimeAndAtEqualError) {
    const Contest contest = contests(three_methods(), Clock::Cpu)[0];
    EXPECT_EQ(contest.seconds, 2.0);  // of 2 and 16 the lower
    ASSERT_TRUE(contest.at_time);
    EXPECT_EQ(*contest.at_time, 0u);
    EXPECT_EQ(second_at_time(contest), 1u);
    EXPECT_NEAR(contest.contenders[1].error.value, 0.16 / std::sqrt(2.0), 1e-12);
    // 2 % is 64 s for paths, by the law of averages, and never for the grid.
    ASSERT_TRUE(contest.target && contest.at_error);
    EXPECT_EQ(kSuiteTargets[*contest.target], 0.02);
    EXPECT_EQ(*contest.at_error, 1u);
    const Reading& reading = contest.contenders[1].times[*contest.target];
    EXPECT_EQ(reading.kind, ReadingKind::Extrapolated);
    EXPECT_NEAR(reading.value, 64.0, 1e-9);
    EXPECT_EQ(contest.contenders[0].times[2].kind, ReadingKind::NotReached);
}

TEST(Contests, OfABlackCellHaveNoWinner) {
    Report report = three_methods();
    for (MethodResult& result : report.methods)
        for (MeasuredRun& run : result.runs)
            run.errors["SS"].differences.rrmse = std::numeric_limits<double>::quiet_NaN();
    const Contest contest = contests(report, Clock::Cpu)[1];
    EXPECT_TRUE(contest.contenders.empty());
    EXPECT_FALSE(contest.at_time);
    EXPECT_FALSE(contest.at_error);
    EXPECT_FALSE(contest.target);
}

SuiteReport two_scenes() {
    SuiteReport suite;
    suite.size = suite_size("quick");
    suite.date = "2001-09-09T01:46:40Z";
    Report report = three_methods();
    report.failures = {{"lights", "2 x 2 spp: out | of memory"}};
    suite.scenes.push_back({{"room", "room.json"}, report, "", std::nullopt});
    suite.scenes.push_back({{"media/gone", "media/gone.json"}, std::nullopt, "media/gone.json: no such file", {}});
    return suite;
}

TEST(SuiteMarkdown, HasEverySceneCellMethodAndFailure) {
    const std::string text = suite_markdown(two_scenes());
    for (const char* const part :
         {"### room", "### media/gone", "| room | MM | 2 s | grid (6 %) | paths (11.3 %) | 2 % | paths (~ 64 s) |",
          "| MM | **grid** | 6 % |", "| SS | lights |", "| media/gone | all | media/gone.json: no such file |",
          "| room | lights | 2 x 2 spp: out \\| of memory |", "Suite `quick`"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

// Of repeats the smallest error has its bar, and the text says what that is.
TEST(SuiteMarkdown, HasBarsWhereRepeatsDiffered) {
    SuiteReport suite = two_scenes();
    EXPECT_EQ(suite_markdown(suite).find("±"), std::string::npos);
    Report& report = *suite.scenes[0].report;
    report.repeats = 5;
    for (MeasuredRun& run : report.methods[1].runs) {
        ErrorSpread spread;
        spread.rrmse = 0.1 * run.errors["MM"].differences.rrmse;
        run.errors["MM"].spread = spread;
    }
    const std::string text = suite_markdown(suite);
    for (const char* const part :
         {"means of 5 renders", "± the standard deviation of one", " | 4 ± 0.4 % |", "| MM | **grid** | 6 % |"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    const auto contenders = suite_json(suite)["scenes"][0]["cells"][0]["contenders"];
    EXPECT_TRUE(contenders[0]["floor_spread"].is_null()) << "the grid is the same picture every time";
    EXPECT_NEAR(contenders[1]["floor_spread"].get<double>(), 0.004, 1e-12);
}

TEST(SuiteJson, NumbersTheScenesThatWereMeasured) {
    const auto json = suite_json(two_scenes());
    EXPECT_EQ(json["scenes"][0]["report"], 0);
    EXPECT_EQ(json["scenes"][0]["cells"][0]["best_at_time"], 0);
    EXPECT_TRUE(json["scenes"][1]["report"].is_null());
    EXPECT_EQ(json["scenes"][1]["failure"], "media/gone.json: no such file");
}

}  // namespace
}  // namespace brisance
