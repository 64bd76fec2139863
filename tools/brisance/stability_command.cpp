#include "stability_command.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "stability/results_table.h"

namespace brisance {
namespace {

void print(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    if (!text.ends_with('\n'))
        std::fputc('\n', stdout);
    std::fflush(stdout);
}

}  // namespace

int run_stability(const StabilityOptions& options) {
    std::vector<stability::Case> cases = stability::all_cases();
    std::erase_if(cases, [&](const auto& c) { return c.name.find(options.part) == std::string::npos; });
    if (cases.empty())
        throw Error(ExitCode::Usage, "no case is called " + options.part);
    const bool lines = !options.markdown && !options.json;
    if (lines)
        print(stability::table_head());
    std::vector<stability::Result> results;
    for (const stability::Case& c : cases)
        for (const RenderMethod method : {RenderMethod::LightingGrid, RenderMethod::Path}) {
            const std::string name = stability::method_name(method);
            if (!c.tolerance.of(method) || std::ranges::find(options.methods, name) == options.methods.end())
                continue;
            results.push_back(stability::run_case(c, method));
            if (lines)
                print(stability::table_line(results.back()));
        }
    if (options.markdown)
        print(stability::markdown_table(cases, results));
    if (options.json)
        print(stability::results_json(cases, results));
    const bool passed = std::ranges::all_of(results, [](const auto& r) { return r.passed(); });
    return static_cast<int>(passed ? ExitCode::Success : ExitCode::RenderFailed);
}

}  // namespace brisance
