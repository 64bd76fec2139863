#include "stability/results_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace brisance::stability {

namespace {

std::string percent(double part) {
    return fmt::format("{:.2g} %", 100.0 * part);
}

std::string balance_text(const Result& r) {
    return r.imbalance ? fmt::format("{:+.2f} %", 100.0 * *r.imbalance) : "-";
}

std::string error_text(const Result& r) {
    if (!r.trouble.empty())
        return r.trouble;
    return r.measured.noise > 0.0
               ? fmt::format("{:.2g} \xC2\xB1 {:.1g} %", 100.0 * r.measured.error, 100.0 * r.measured.noise)
               : percent(r.measured.error);
}

const char* verdict(const Result& r) {
    return !r.passed() ? "MISS" : r.limit ? "limit" : "pass";
}

// The first case of this name.
const Case& case_of(const std::vector<Case>& cases, const std::string& name) {
    return *std::find_if(cases.begin(), cases.end(), [&](const Case& c) { return c.name == name; });
}

}  // namespace

std::string table_head() {
    return fmt::format("{:38} {:14} {:7} {:>9} {:>17} {:>10}  {:5} {:>6}", "case", "method", "finite", "energy",
                       "error", "tolerance", "", "s");
}

std::string table_line(const Result& r) {
    return fmt::format("{:38} {:14} {:7} {:>9} {:>17} {:>10}  {:5} {:6.2f}", r.name, r.method, r.finite ? "yes" : "NO",
                       balance_text(r), error_text(r), percent(r.tolerance), verdict(r), r.seconds);
}

std::string markdown_table(const std::vector<Case>& cases, const std::vector<Result>& results) {
    std::string text =
        "| case | method | finite | energy | error | tolerance | | s |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const Result& r : results)
        text +=
            fmt::format("| {} | `{}` | {} | {} | {} | {} | {} | {:.2f} |\n", r.name, r.method, r.finite ? "yes" : "no",
                        balance_text(r), error_text(r), percent(r.tolerance), verdict(r), r.seconds);
    text += "\n| case | held against | tolerance, because |\n| --- | --- | --- |\n";
    std::string last;
    for (const Result& r : results)
        if (r.name != std::exchange(last, r.name)) {
            const Case& c = case_of(cases, r.name);
            text += fmt::format("| {} | {} | {} |\n", c.name, c.truth, c.tolerance.reason);
        }
    text += "\n| case | method | limit, because |\n| --- | --- | --- |\n";
    for (const Result& r : results)
        if (r.limit)
            text += fmt::format("| {} | `{}` | {}: {} |\n", r.name, r.method, percent(r.tolerance),
                                case_of(cases, r.name).tolerance.limits.at(r.method).reason);
    return text;
}

std::string results_json(const std::vector<Case>& cases, const std::vector<Result>& results) {
    auto list = nlohmann::ordered_json::array();
    for (const Result& r : results) {
        nlohmann::ordered_json row = {{"case", r.name},
                                      {"method", r.method},
                                      {"finite", r.finite},
                                      {"error", r.measured.error},
                                      {"noise", r.measured.noise},
                                      {"tolerance", r.tolerance},
                                      {"passed", r.passed()},
                                      {"limit", r.limit},
                                      {"seconds", r.seconds},
                                      {"truth", case_of(cases, r.name).truth}};
        if (r.imbalance)
            row["imbalance"] = *r.imbalance;
        if (!r.trouble.empty())
            row["trouble"] = r.trouble;
        list.push_back(std::move(row));
    }
    return list.dump(2) + "\n";
}

}  // namespace brisance::stability
