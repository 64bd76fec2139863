#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "suite/contest.h"
#include "suite/suite_report.h"

namespace brisance {
namespace {

// A cell of a table: a bar would end it.
std::string markdown_text(const std::string& text) {
    std::string out;
    for (const char c : text)
        out += c == '|' ? std::string("\\|") : c == '\n' ? std::string(" ") : std::string(1, c);
    return out;
}

std::string percent(double error) {
    return fmt::format("{:.3g} %", 100.0 * error);
}

std::string floor_text(const Contender& contender) {
    return contender.floor_spread
               ? fmt::format("{:.3g} ± {:.2g} %", 100.0 * contender.floor, 100.0 * *contender.floor_spread)
               : percent(contender.floor);
}

std::string seconds(double value) {
    return fmt::format("{:.3g} s", value);
}

std::string mark_of(const Reading& reading) {
    return reading.kind == ReadingKind::Extrapolated ? "~ " : reading.kind == ReadingKind::AtMost ? "≤ " : "";
}

std::string error_text(const Contest& contest, const Contender& contender) {
    const Reading& reading = contender.error;
    if (reading.kind == ReadingKind::NotReached)
        return "-";
    return mark_of(reading) + percent(reading.value) + (reading.value < contest.noise ? " †" : "");
}

std::string time_text(const Reading& reading) {
    return reading.kind == ReadingKind::NotReached ? "-" : mark_of(reading) + seconds(reading.value);
}

std::string target_text(double target) {
    return fmt::format("{:g} %", 100.0 * target);
}

std::string markdown_row(const std::vector<std::string>& fields) {
    return fmt::format("| {} |\n", fmt::join(fields, " | "));
}

std::string markdown_head(const std::vector<std::string>& fields) {
    return markdown_row(fields) + markdown_row(std::vector<std::string>(fields.size(), "---"));
}

std::string winner_row(const SuiteScene& scene, const Contest& contest) {
    const auto named = [&](std::size_t i) { return contest.contenders[i].method; };
    if (!contest.at_time)
        return markdown_row({markdown_text(scene.name), contest.cell, "-", "no light", "", "", ""});
    const auto second = second_at_time(contest);
    const auto with_error = [&](std::size_t i) {
        return fmt::format("{} ({})", named(i), error_text(contest, contest.contenders[i]));
    };
    return markdown_row(
        {markdown_text(scene.name), contest.cell, seconds(contest.seconds), with_error(*contest.at_time),
         second ? with_error(*second) : "-", contest.target ? target_text(kSuiteTargets[*contest.target]) : "-",
         contest.at_error ? fmt::format("{} ({})", named(*contest.at_error),
                                        time_text(contest.contenders[*contest.at_error].times[*contest.target]))
                          : "none reaches 10 %"});
}

std::string winners(const SuiteReport& suite) {
    std::string text =
        "## Who is best\n\n" + markdown_head({"scene", "cell", "equal time", "best then (error)", "second (error)",
                                              "equal error", "first to reach it (time)"});
    for (const MeasuredScene& scene : suite.scenes) {
        if (!scene.report) {
            text += markdown_row(
                {markdown_text(scene.scene.name), "-", "-", "failed: " + markdown_text(scene.failure), "", "", ""});
            continue;
        }
        for (const Contest& contest : contests(*scene.report, kSuiteClock))
            text += winner_row(scene.scene, contest);
    }
    return text;
}

std::string failures(const SuiteReport& suite) {
    std::string rows;
    for (const MeasuredScene& scene : suite.scenes) {
        if (!scene.report)
            rows += markdown_row({markdown_text(scene.scene.name), "all", markdown_text(scene.failure)});
        else
            for (const MethodFailure& failure : scene.report->failures)
                rows += markdown_row({markdown_text(scene.scene.name), failure.method, markdown_text(failure.reason)});
    }
    return "## What failed\n\n" + (rows.empty() ? "Nothing: every scene and every method gave pictures.\n"
                                                : markdown_head({"scene", "method", "reason"}) + rows);
}

std::string contender_row(const Contest& contest, std::size_t i, bool flicker) {
    const Contender& contender = contest.contenders[i];
    std::vector<std::string> fields = {contest.cell,
                                       contest.at_time == i ? "**" + contender.method + "**" : contender.method,
                                       error_text(contest, contender)};
    for (const Reading& time : contender.times)
        fields.push_back(time_text(time));
    fields.push_back(floor_text(contender));
    if (flicker)
        fields.push_back(contender.flicker ? percent(*contender.flicker) : "-");
    return markdown_row(fields);
}

std::string figures_of(const MeasuredScene& scene) {
    std::string text = fmt::format("### {}\n\n", scene.scene.name);
    if (!scene.report)
        return text + fmt::format("Failed: {}\n", scene.failure);
    const Report& report = *scene.report;
    text += fmt::format("{} x {} pixels; reference: {}. Times and noise of the reference: ", report.shot.width,
                        report.shot.height, report.reference.label);
    const std::vector<Contest> all = contests(report, kSuiteClock);
    for (std::size_t c = 0; c < all.size(); ++c)
        text += fmt::format("{}`{}` {}, {}", c == 0 ? "" : "; ", all[c].cell, seconds(all[c].seconds),
                            std::isfinite(all[c].noise) ? percent(all[c].noise) : "no light");
    std::vector<std::string> columns = {"cell", "method", "error then"};
    for (const double target : kSuiteTargets)
        columns.push_back("time to " + target_text(target));
    columns.push_back("smallest error");
    const bool flicker = report.strip_frames > 0;
    if (flicker)
        columns.push_back("flicker");
    text += ".\n\n" + markdown_head(columns);
    for (const Contest& contest : all)
        for (std::size_t i = 0; i < contest.contenders.size(); ++i)
            text += contender_row(contest, i, flicker);
    return text;
}

// Of the pictures, which settings of the command may have changed [pixels].
int width_of(const SuiteReport& suite) {
    for (const MeasuredScene& scene : suite.scenes)
        if (scene.report)
            return scene.report->shot.width;
    return suite.size.width;
}

std::string how_it_was_made(const SuiteReport& suite) {
    const SuiteSize& size = suite.size;
    std::string text = fmt::format("```sh\n{}\n```\n\n", suite.command);
    text += fmt::format(
        "Brisance {}, {}, on {} ({} cores, {} threads used, load {:.1f} before the first render), in {:.0f} minutes.\n",
        suite.version, suite.date.substr(0, 10), suite.machine.processor, suite.machine.cores, suite.machine.threads,
        suite.machine.load[0], std::ceil(suite.seconds / 60.0));
    text += fmt::format(
        "Suite `{}`: pictures {} pixels wide; references of {} paths per pixel in two independent halves; path tracers "
        "with {} paths per pixel, `lighting_grid` by steps {} of its ladder, all others with {} samples along a "
        "pixel's side.",
        size.name, width_of(suite), suite.reference_samples, size.path_samples, size.grid_steps, size.sides);
    if (!size.settings.empty())
        text += fmt::format(" Settings over those of every shot: `{}`.", fmt::join(size.settings, " "));
    for (const auto& [settings, others] :
         {std::pair{&size.beside_fire, "that do not compete in `MV`, nor go on from it, nor compete in `SS`,"},
          {&size.beside_fire_of_surfaces, "that compete in `SS` and not in `MV`"},
          {&size.beside_scattering, "that do not compete in `MM`, nor go on from it,"}})
        if (!settings->empty())
            text += fmt::format(" Methods {} have `{}`.", others, fmt::join(*settings, " "));
    return text + "\n";
}

bool has_strips(const SuiteReport& suite) {
    return std::any_of(suite.scenes.begin(), suite.scenes.end(),
                       [](const MeasuredScene& scene) { return scene.report && scene.report->strip_frames > 0; });
}

constexpr const char* kHowToReadFlicker =
    R"(- *Flicker* is of the cheapest run: what changes between frames whose true picture is the same, but with other seeds, and
  moved by whole voxels with the camera ([Film strips](compare_and_report.md#film-strips)). Noise that is new in each
  frame has as much as its error; bias that stands still has none.
)";

std::string how_to_read_bars(const SuiteReport& suite) {
    for (const MeasuredScene& scene : suite.scenes)
        if (scene.report && scene.report->repeats > 1)
            return fmt::format("- Errors are means of {} renders with other seeds, ± the standard deviation of one.\n",
                               scene.report->repeats);
    return "";
}

constexpr const char* kHowToRead =
    R"(Every method competes in the cells ([Layers](layers.md)) that it computes by its own technique: `lighting_grid` in all
but `MS` and `SS`, scattering methods in `MM` and `SM`, virtual lights in `MS` and `SS`, path tracers everywhere.

- Errors are rRMSE of the cell, free of the noise of the reference. † marks those below that noise: they are not told
  apart, neither from each other nor from 0.
- Times are CPU seconds of the whole picture, with all its cells, not of the cell alone. *Equal time* is that of
  the finest run of the method that shots take by default, `lighting_grid` or `vbnl`: rows say what the others give for
  it. Where neither competes it is the median of the competitors' longest runs. *Equal error* is the smallest of 10, 5
  and 2 % that any of them reaches.
- `~` is extrapolated from the longest run as time^(−1/2); `≤` is an upper bound: of a time, the cheapest run's, or of
  an error, that of the finest run, which had ended before. `-` is not reached, or not finished by then.
- Few budgets and small pictures favour methods without a start-up, and one run has the luck of its seed: differences
  of a few tenths of an error mean little.
)";

}  // namespace

std::string suite_markdown(const SuiteReport& suite) {
    std::string text =
        "# Comparison of the methods\n\nMade by `brisance report --suite` ([Compare and "
        "report](compare_and_report.md#suites)); not written by hand.\n\n";
    text += how_it_was_made(suite) + "\n" + kHowToRead + how_to_read_bars(suite) +
            (has_strips(suite) ? kHowToReadFlicker : "") + "\n" + winners(suite) + "\n" + failures(suite) +
            "\n## Figures\n";
    for (const MeasuredScene& scene : suite.scenes)
        text.append("\n").append(figures_of(scene));
    return text;
}

}  // namespace brisance
