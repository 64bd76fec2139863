#include "shot/read_shot.h"

#include <fmt/format.h>

#include <map>

#include "core/error.h"
#include "core/input_file.h"
#include "core/printable.h"
#include "shot/check_shot.h"
#include "shot/json_text.h"
#include "shot/keys/keys.h"
#include "shot/nearest_key.h"
#include "shot/renamed_keys.h"

namespace brisance {
namespace {

using Where = std::function<std::string(const std::string& path)>;  // "shot.json:12", "--set smoke.albedo=2"

constexpr std::uint64_t kLargestShot = std::uint64_t{16} << 20;

struct Preset {
    std::string name;
    std::vector<std::string> overrides;
};

const std::vector<Preset>& presets() {
    static const std::vector<Preset> all = {
        {"draft",
         {"lighting.alpha=1", "lighting.error=0.05", "camera.samples_per_axis=1", "camera.edge_refinement=1",
          "scattering.alpha=1", "scattering.remainder=0.01", "shutter.length=0"}},
        {"final", {}},
    };
    return all;
}

std::string kind_of(const Json& value) {
    if (value.is_object())
        return "an object";
    if (value.is_array())
        return "a list";
    if (value.is_string())
        return "text";
    return value.is_boolean() ? "a truth value" : value.is_null() ? "null" : "a number";
}

std::string shortened(const Json& value) {
    constexpr std::size_t most = 60;
    return printable(value.dump(-1, ' ', true, Json::error_handler_t::replace), most);
}

[[noreturn]] void reject_value(const std::string& where, const std::string& path, const std::string& expected,
                               const Json& value) {
    throw Error(ExitCode::Usage, fmt::format("{}: {}: expected {}, got {} ({})", where, path, expected,
                                             shortened(value), kind_of(value)));
}

// Names the part that is to blame where a value has parts.
[[noreturn]] void reject_value_of(const Key& key, const std::string& where, const Json& value) {
    if (const std::optional<std::string> renamed =
            renamed_value(key.path, value.dump(-1, ' ', false, Json::error_handler_t::replace)))
        throw Error(ExitCode::Usage, fmt::format("{}: {}: {}", where, key.path, *renamed));
    if (key.find_mismatch)
        if (const std::optional<Mismatch> part = key.find_mismatch(value))
            reject_value(where, key.path + part->path, part->expected, part->value);
    reject_value(where, key.path, key.expected, value);
}

const Key* find_key(const std::string& path) {
    for (const Key& key : shot_keys())
        if (key.path == path)
            return &key;
    return nullptr;
}

bool is_section(const std::string& path) {
    for (const auto& [name, help] : shot_sections())
        if (name == path)
            return true;
    return path.empty();
}

std::string first_key_below(const std::string& section) {
    for (const Key& key : shot_keys())
        if (section.empty() || key.path.starts_with(section + "."))
            return key.path;
    return {};
}

[[noreturn]] void reject_key(const std::string& where, const std::string& path) {
    if (const std::optional<std::string> renamed = renamed_key(path))
        throw Error(ExitCode::Usage, fmt::format("{}: {}", where, *renamed));
    const std::string shown = printable(path, kLongestName);
    if (is_section(path))
        throw Error(ExitCode::Usage, fmt::format("{}: {} is no key but holds some, such as {}", where,
                                                 path.empty() ? "\"\"" : path, first_key_below(path)));
    std::vector<std::string> known;
    for (const Key& key : shot_keys())
        known.push_back(key.path);
    for (const auto& [name, help] : shot_sections())
        known.push_back(name);
    throw Error(ExitCode::Usage,
                fmt::format("{}: unknown key {}; did you mean {}?", where, shown, nearest_key(shown, known)));
}

// Lays JSON over a shot and remembers where each key was given.
class Layering {
public:
    explicit Layering(Shot& shot) : shot_(shot) {}

    void apply(const std::string& path, const Json& value, const Where& where) {
        if (const Key* key = find_key(path)) {
            if (!key->set(shot_, value))
                reject_value_of(*key, where(path), value);
            given_[path] = where(path);
            return;
        }
        if (!is_section(path))
            reject_key(where(path), path);
        if (!value.is_object())
            reject_value(where(path), path.empty() ? "a shot" : path, "an object in braces", value);
        for (const auto& item : value.items())
            apply(path.empty() ? item.key() : path + "." + item.key(), item.value(), where);
    }

    // "key=value"; `origin` begins messages.
    void override_with(const std::string& setting, const std::string& origin) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos || equals == 0)
            throw Error(ExitCode::Usage, fmt::format("{}: expected key=value, e.g. smoke.albedo=0.9", origin));
        const std::string path = setting.substr(0, equals);
        const std::string text = setting.substr(equals + 1);
        const Where where = [&](const std::string&) { return origin; };
        Json value = parse_json_value(text).value_or(Json(text));
        // Text may look like JSON: name=2024 means "2024".
        if (const Key* key = find_key(path);
            key && !value.is_string() && !key->set(shot_, value) && key->set(shot_, text))
            value = text;
        apply(path, value, where);
    }

    const std::map<std::string, std::string>& given() const { return given_; }

private:
    Shot& shot_;
    std::map<std::string, std::string> given_;
};

void apply_preset(const std::string& name, Layering& layering) {
    if (name.empty())
        return;
    for (const Preset& preset : presets()) {
        if (preset.name != name)
            continue;
        for (const std::string& setting : preset.overrides)
            layering.override_with(setting, "preset " + name);
        return;
    }
    throw Error(ExitCode::Usage,
                fmt::format("unknown preset {}; there are {}", name, fmt::join(shot_presets(), " and ")));
}

}  // namespace

const std::vector<std::string>& shot_presets() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const Preset& preset : presets())
            result.push_back(preset.name);
        return result;
    }();
    return names;
}

Shot read_shot(const std::filesystem::path& file, const ShotOptions& options, std::set<std::string>* given) {
    Shot shot =
        parse_shot(read_input(file, kLargestShot, ExitCode::Usage), file.string(), file.parent_path(), options, given);
    if (shot.name.empty())
        shot.name = file.stem().string();
    return shot;
}

Shot parse_shot(const std::string& text, const std::string& source, const std::filesystem::path& folder,
                const ShotOptions& options, std::set<std::string>* given) {
    const JsonText json = parse_json_text(text, source);
    Shot shot;
    shot.folder = folder;
    Layering layering(shot);
    if (!options.base.empty())
        layering.apply("", parse_json_text(options.base, options.base_source).value,
                       [&](const std::string&) { return options.base_source; });
    layering.apply("", json.value, [&](const std::string& path) {
        const auto line = json.line_of_key.find(path);
        return line == json.line_of_key.end() ? source : fmt::format("{}:{}", source, line->second);
    });
    apply_preset(options.preset, layering);
    for (const std::string& setting : options.overrides)
        layering.override_with(setting, "--set " + setting);
    check_shot(shot, layering.given(), source);
    if (given != nullptr)
        for (const auto& [key, where] : layering.given())
            given->insert(key);
    return shot;
}

void check_setting(const std::string& where, const std::string& path, const Json& value) {
    const Key* const key = find_key(path);
    if (key == nullptr)
        reject_key(where, path);
    Shot shot;
    if (!key->set(shot, value))
        reject_value_of(*key, where, value);
}

}  // namespace brisance
