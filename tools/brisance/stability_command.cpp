#include "stability_command.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "stability/results_table.h"

namespace brisance {
namespace {

void print(const std::string& text, std::FILE* to = stdout) {
    std::fputs(text.c_str(), to);
    if (!text.ends_with('\n'))
        std::fputc('\n', to);
    std::fflush(to);
}

std::vector<std::string> names_of(const std::vector<stability::Method>& methods) {
    std::vector<std::string> names;
    for (const stability::Method& method : methods)
        names.push_back(method.name());
    return names;
}

std::vector<stability::Method> methods_of(const std::vector<std::string>& names) {
    std::vector<stability::Method> chosen;
    for (const auto* methods : {&stability::all_methods(), &stability::preset_methods()})
        for (const stability::Method& method : *methods)
            if (std::ranges::find(names, method.name()) != names.end())
                chosen.push_back(method);
    return chosen;
}

}  // namespace

std::vector<std::string> stability_methods() {
    return names_of(stability::all_methods());
}

std::vector<std::string> stability_presets() {
    return names_of(stability::preset_methods());
}

int run_stability(const StabilityOptions& options) {
    std::vector<stability::Case> cases = stability::all_cases();
    std::erase_if(cases, [&](const auto& c) { return c.name.find(options.part) == std::string::npos; });
    if (cases.empty())
        throw Error(ExitCode::Usage, "no case is called " + options.part);
    const std::vector<stability::Method> methods = methods_of(options.methods);
    // Line by line as it grows; beside a document, as a sign of life.
    std::FILE* const lines = options.markdown || options.json ? stderr : stdout;
    print(stability::table_head(), lines);
    std::vector<stability::Result> results;
    for (const stability::Case& c : cases)
        for (const stability::Method& method : methods) {
            if (!c.tolerance_of(method))
                continue;
            const std::optional<stability::Result> result = stability::run_case(c, method);
            if (!result)
                continue;
            results.push_back(*result);
            print(stability::table_line(*result), lines);
        }
    if (options.markdown)
        print(stability::markdown_table(cases, results));
    if (options.json)
        print(stability::results_json(cases, results));
    const bool passed = std::ranges::all_of(results, [](const auto& r) { return r.passed(); });
    return static_cast<int>(passed ? ExitCode::Success : ExitCode::RenderFailed);
}

}  // namespace brisance
