#include "methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>

#include "built_in_methods.h"
#include "core/error.h"

namespace brisance {
namespace {

using Settings = std::vector<std::string>;

// From coarse to finer than the default, which is the third. By lights alone: corrections are the path tracer's work.
const std::vector<Settings>& grid_ladder() {
    static const std::vector<Settings> all = {
        {"lighting.alpha=1", "lighting.error=0.05", "scattering.alpha=1", "correction.samples=0"},
        {"lighting.alpha=1.5", "lighting.error=0.03", "scattering.alpha=1.25", "correction.samples=0"},
        {"lighting.alpha=2", "lighting.error=0.02", "scattering.alpha=1.5", "correction.samples=0"},
        {"lighting.alpha=3", "lighting.error=0.01", "scattering.alpha=2", "correction.samples=0"}};
    return all;
}

const std::vector<std::string> kNumbersOfLamps = {"4", "16", "64", "256"};
const std::vector<std::string> kSidesOfCascades = {"4", "8", "16"};
const std::vector<std::string> kLevelsOfLattices = {"2", "1", "0"};
const std::vector<std::string> kPathBudgets = {"4", "16", "64", "256"};
const std::vector<std::string> kSidesOfSamples = {"1", "2", "4", "8"};

[[noreturn]] void refuse(const std::string& line) {
    throw Error(ExitCode::Usage, line);
}

// At commas outside of brackets and quotes: values may be lists.
std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts(1);
    int depth = 0;
    bool quoted = false;
    for (const char c : text) {
        quoted = quoted != (c == '"');
        depth += quoted ? 0 : (c == '[' || c == '{') - (c == ']' || c == '}');
        if (c == ',' && depth == 0 && !quoted)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

std::string key_of(const std::string& setting) {
    return setting.substr(0, setting.find('='));
}

std::string value_of(const std::string& setting) {
    return setting.substr(setting.find('=') + 1);
}

}  // namespace

bool sets(const std::vector<std::string>& settings, const std::string& key) {
    return std::any_of(settings.begin(), settings.end(), [&](const std::string& s) { return key_of(s) == key; });
}

namespace {

// "LABEL:REST"; without a colon the label is empty.
std::pair<std::string, std::string> split_label(const std::string& text) {
    const std::size_t colon = text.find(':');
    return colon == std::string::npos ? std::pair{std::string(), text}
                                      : std::pair{text.substr(0, colon), text.substr(colon + 1)};
}

const BuiltIn& built_in(const std::string& name, const std::string& text) {
    for (const BuiltIn& method : built_ins())
        if (method.name == name)
            return method;
    refuse(fmt::format("--methods {}: no method is called \"{}\"; there are {}", text, name,
                       fmt::join(built_in_methods(), ", ")));
}

Method parse_method(const std::string& text) {
    const std::vector<std::string> parts = split(text);
    const bool named = parts[0].find('=') != std::string::npos;
    const BuiltIn& base = built_in(named ? value_of(parts[0]) : parts[0], text);
    Method method{.label = named ? key_of(parts[0]) : text,
                  .base = base.name,
                  .settings = base.settings,
                  .steps = {},
                  .steps_of = base.steps,
                  .unbiased = base.unbiased,
                  .by_default = base.by_default && parts.size() == 1,
                  .scatters_grid = base.scatters_grid,
                  .cells = base.cells};
    if (method.label.empty() || method.label.find(':') != std::string::npos)
        refuse(fmt::format("--methods {}: a label is not empty and holds no colon", text));
    for (std::size_t i = 1; i < parts.size(); ++i) {
        if (parts[i].find('=') == std::string::npos || parts[i][0] == '=')
            refuse(fmt::format("--methods {}: \"{}\" is no setting; they look like tracing.free_flight=exact", text,
                               parts[i]));
        if (key_of(parts[i]) == "method")
            refuse(fmt::format("--methods {}: the method is what stands first, not a setting", text));
        method.settings.push_back(parts[i]);
    }
    return method;
}

// "lighting.alpha=2": the section says nothing new beside its method.
std::string short_setting(const std::string& setting) {
    const std::string key = key_of(setting);
    if (key == "tracing.samples")
        return value_of(setting) + " spp";
    if (key == "tracing.seconds")
        return value_of(setting) + " s";
    return key.substr(key.rfind('.') + 1) + "=" + value_of(setting);
}

std::string label_of(const Settings& settings) {
    std::vector<std::string> parts;
    for (const std::string& setting : settings)
        parts.push_back(short_setting(setting));
    return fmt::format("{}", fmt::join(parts, " "));
}

MethodStep built_in_grid_step(std::size_t number, const Method& method) {
    MethodStep step{fmt::format("step {}", number + 1), {}};
    // What the method says of itself stays so at every step.
    for (const std::string& setting : grid_ladder()[number])
        if (!sets(method.settings, key_of(setting)))
            step.settings.push_back(setting);
    std::vector<std::string> values;
    for (const std::string& setting : step.settings)
        values.push_back(value_of(setting));
    if (!values.empty())
        step.label += fmt::format(": {}", fmt::join(values, "/"));
    return step;
}

std::vector<MethodStep> grid_steps(const std::optional<std::vector<std::string>>& chosen, const Method& method) {
    std::vector<MethodStep> steps;
    const auto add = [&](std::size_t number) {
        const MethodStep step = built_in_grid_step(number, method);
        if (steps.empty() || steps.back().settings != step.settings)
            steps.push_back(step);
    };
    if (!chosen)
        for (std::size_t i = 0; i < grid_ladder().size(); ++i)
            add(i);
    for (const std::string& text : chosen.value_or(std::vector<std::string>{})) {
        std::size_t number = 0;
        const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error != std::errc() || rest != text.data() + text.size() || number < 1 || number > grid_ladder().size())
            refuse(fmt::format("--budgets {}: the steps of lighting_grid are 1 to {}, not \"{}\"", method.label,
                               grid_ladder().size(), text));
        add(number - 1);
    }
    return steps;
}

// Samples along a pixel's side.
std::vector<MethodStep> sample_steps(const std::vector<std::string>& sides) {
    std::vector<MethodStep> steps(sides.size());
    for (std::size_t i = 0; i < sides.size(); ++i)
        steps[i] = {fmt::format("{0} x {0} spp", sides[i]), {"camera.samples_per_axis=" + sides[i]}};
    return steps;
}

std::vector<MethodStep> lamp_steps(const std::vector<std::string>& numbers) {
    std::vector<MethodStep> steps(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
        steps[i] = {numbers[i] + " lamps", {"lighting.clusters=" + numbers[i]}};
    return steps;
}

std::vector<MethodStep> direction_steps(const std::vector<std::string>& sides) {
    std::vector<MethodStep> steps(sides.size());
    for (std::size_t i = 0; i < sides.size(); ++i)
        steps[i] = {fmt::format("{0} x {0} directions", sides[i]), {"scattering.cascade_side=" + sides[i]}};
    return steps;
}

std::vector<MethodStep> lattice_steps(const std::vector<std::string>& levels) {
    std::vector<MethodStep> steps(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i)
        steps[i] = {fmt::format("lattice level {}", levels[i]), {"scattering.lattice_level=" + levels[i]}};
    return steps;
}

bool stops(const Settings& settings) {
    return sets(settings, "tracing.samples") || sets(settings, "tracing.seconds") || sets(settings, "tracing.error");
}

// Whoever names a time does not want the shot's number of samples to end it.
void until(MethodStep& step) {
    if (stops(step.settings) && !sets(step.settings, "tracing.samples"))
        step.settings.push_back("tracing.samples=none");
}

std::vector<MethodStep> path_steps(const std::optional<std::vector<std::string>>& budgets, const Method& method) {
    if (stops(method.settings)) {
        if (budgets)
            refuse(fmt::format("--budgets: {} says itself when it stops; leave one of the two out", method.label));
        MethodStep step;
        for (const std::string& setting : method.settings)
            if (stops({setting}))
                step.label += fmt::format("{}{}", step.label.empty() ? "" : " ", short_setting(setting));
        if (!sets(method.settings, "tracing.samples"))
            step.settings = {"tracing.samples=none"};
        return {step};
    }
    std::vector<MethodStep> steps;
    for (const std::string& samples : budgets.value_or(kPathBudgets))
        steps.push_back({samples + " spp", {"tracing.samples=" + samples}});
    return steps;
}

using Ladder = std::vector<std::pair<std::string, std::vector<std::string>>>;  // keys with their values, side by side

std::vector<MethodStep> ladder_steps(const Ladder& ladder, const Method& method) {
    std::vector<MethodStep> steps(ladder.front().second.size());
    for (const auto& [key, values] : ladder) {
        if (values.size() != steps.size())
            refuse(fmt::format("--ladder {}: {} has {} values and {} has {}; they go side by side", method.label,
                               ladder.front().first, steps.size(), key, values.size()));
        for (std::size_t i = 0; i < steps.size(); ++i)
            steps[i].settings.push_back(key + "=" + values[i]);
    }
    for (MethodStep& step : steps) {
        step.label = label_of(step.settings);
        until(step);
    }
    return steps;
}

struct Choices {
    std::map<std::string, std::vector<std::string>> budgets;  // by label; "": of all path methods
    std::map<std::string, Ladder> ladders;                    // by label
};

Choices parse_choices(const MethodOptions& options) {
    Choices choices;
    for (const std::string& text : options.budgets) {
        const auto [label, list] = split_label(text);
        if (!choices.budgets.emplace(label, split(list)).second)
            refuse(fmt::format("--budgets: given twice for {}", label.empty() ? "all path methods" : label));
    }
    for (const std::string& text : options.ladders) {
        const auto [label, list] = split_label(text);
        const std::size_t equals = list.find('=');
        if (label.empty() || equals == std::string::npos || equals == 0)
            refuse(fmt::format("--ladder {}: expected METHOD:KEY=VALUE,VALUE,...", text));
        choices.ladders[label].push_back({list.substr(0, equals), split(list.substr(equals + 1))});
    }
    for (const auto& [label, ladder] : choices.ladders)
        if (choices.budgets.contains(label))
            refuse(fmt::format("{}: --ladder and --budgets both say its steps; leave one of the two out", label));
    return choices;
}

void check_labels(const std::vector<Method>& methods, const Choices& choices) {
    std::set<std::string> labels;
    for (const Method& method : methods)
        if (!labels.insert(method.label).second)
            refuse(fmt::format("--methods: two are called {}; give one a label: LABEL={}", method.label, method.base));
    const auto check = [&](const std::string& label, const char* option) {
        if (!label.empty() && !labels.contains(label))
            refuse(
                fmt::format("{} {}: no method has this label; there are {}", option, label, fmt::join(labels, ", ")));
    };
    for (const auto& [label, list] : choices.budgets)
        check(label, "--budgets");
    for (const auto& [label, ladder] : choices.ladders)
        check(label, "--ladder");
}

std::vector<MethodStep> built_in_steps(const std::optional<std::vector<std::string>>& budgets, const Method& method) {
    switch (method.steps_of) {
        case StepsOf::Paths:
            return path_steps(budgets, method);
        case StepsOf::Samples:
            return sample_steps(budgets.value_or(kSidesOfSamples));
        case StepsOf::Lamps:
            return lamp_steps(budgets.value_or(kNumbersOfLamps));
        case StepsOf::Directions:
            return direction_steps(budgets.value_or(kSidesOfCascades));
        case StepsOf::Lattices:
            return lattice_steps(budgets.value_or(kLevelsOfLattices));
        case StepsOf::Grid:
            break;
    }
    return grid_steps(budgets, method);
}

void add_steps(Method& method, const Choices& choices) {
    const auto ladder = choices.ladders.find(method.label);
    const auto own = choices.budgets.find(method.label), common = choices.budgets.find("");
    std::optional<std::vector<std::string>> budgets;
    if (own != choices.budgets.end())
        budgets = own->second;
    else if (common != choices.budgets.end() && method.steps_of == StepsOf::Paths && !stops(method.settings))
        budgets = common->second;
    if (ladder != choices.ladders.end())
        method.steps = ladder_steps(ladder->second, method);
    else
        method.steps = built_in_steps(budgets, method);
    const auto filters = [](const Settings& settings) { return sets(settings, "tracing.denoising_radius"); };
    method.unbiased = method.unbiased && !filters(method.settings) &&
                      std::none_of(method.steps.begin(), method.steps.end(),
                                   [&](const MethodStep& step) { return filters(step.settings); });
    // More samples, or more time, and nothing else that changes.
    method.averages = method.unbiased && (ladder == choices.ladders.end() ||
                                          std::all_of(ladder->second.begin(), ladder->second.end(),
                                                      [](const auto& rung) { return stops({rung.first}); }));
}

}  // namespace

const std::vector<std::string>& built_in_methods() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const BuiltIn& method : built_ins())
            all.push_back(method.name);
        return all;
    }();
    return names;
}

bool owns(const Method& method, const std::string& cell) {
    for (std::size_t c = 0; c < kCells; ++c)
        if (cell == kCellNames[c])
            return method.cells[c];
    return false;
}

namespace {

bool shares_a_cell(const CellSet& a, const CellSet& b) {
    for (std::size_t cell = 0; cell < kCells; ++cell)
        if (a[cell] && b[cell])
            return true;
    return false;
}

}  // namespace

std::vector<Method> owners_of(const std::vector<Method>& methods, const CellSet& cells) {
    std::vector<Method> owners;
    for (const Method& method : methods)
        if (shares_a_cell(method.cells, cells))
            owners.push_back(method);
    return owners;
}

std::vector<Method> parse_methods(const MethodOptions& options) {
    const std::vector<std::string> texts =
        options.methods.empty() ? std::vector<std::string>{"lighting_grid", "path"} : options.methods;
    std::vector<Method> methods;
    methods.reserve(texts.size());
    for (const std::string& text : texts)
        methods.push_back(parse_method(text));
    const Choices choices = parse_choices(options);
    check_labels(methods, choices);
    for (Method& method : methods)
        add_steps(method, choices);
    return methods;
}

}  // namespace brisance
