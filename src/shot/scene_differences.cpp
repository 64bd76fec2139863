#include "shot/scene_differences.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <set>

#include "core/error.h"
#include "shot/json_text.h"
#include "shot/keys/keys.h"

namespace brisance {
namespace {

using Values = std::map<std::string, Json>;  // by dotted path

void collect_values(const Json& json, const std::string& path, Values& values) {
    if (!json.is_object()) {
        values[path] = json;
        return;
    }
    for (const auto& item : json.items())
        collect_values(item.value(), path.empty() ? item.key() : path + "." + item.key(), values);
}

Values values_of(const std::string& shot_json) {
    const std::optional<Json> parsed = parse_json_value(shot_json);
    if (!parsed || !parsed->is_object())
        throw Error(ExitCode::BadData, "the shot stored with an image is damaged: it is no JSON object");
    Values values;
    collect_values(*parsed, "", values);
    return values;
}

// Paths of both, in the order of the keys, unknown ones last.
std::vector<std::string> paths_of(const Values& a, const Values& b) {
    std::vector<std::string> paths;
    for (const Key& key : shot_keys())
        paths.push_back(key.path);
    const std::set<std::string> known(paths.begin(), paths.end());
    for (const Values* values : {&a, &b})
        for (const auto& [path, value] : *values)
            if (!known.contains(path) && (values == &a || !a.contains(path)))
                paths.push_back(path);
    return paths;
}

Values defaults() {
    const Shot shot;
    Values values;
    for (const Key& key : shot_keys())
        if (const std::optional<Json> value = key.get(shot))
            values[key.path] = *value;
    return values;
}

std::optional<Json> value_at(const std::string& path, const Values& values) {
    static const Values otherwise = defaults();
    auto found = values.find(path);
    if (found == values.end() && (found = otherwise.find(path)) == otherwise.end())
        return std::nullopt;
    if (path == "volume.file" && found->second.is_string())
        return std::filesystem::path(found->second.get<std::string>()).filename().string();
    return found->second;
}

std::string shown(const std::optional<Json>& value) {
    if (!value)
        return "not given";
    if (!value->is_array())
        return value->dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string text;
    for (const Json& item : *value)
        text += (text.empty() ? "" : ", ") + shown(item);
    return "[" + text + "]";
}

template <class Counts>
std::vector<std::string> differences_where(const std::string& shot_json_a, const std::string& shot_json_b,
                                           const Counts& counts) {
    const Values a = values_of(shot_json_a), b = values_of(shot_json_b);
    std::vector<std::string> lines;
    for (const std::string& path : paths_of(a, b)) {
        if (!counts(path))
            continue;
        const std::optional<Json> in_a = value_at(path, a), in_b = value_at(path, b);
        if (in_a != in_b)
            lines.push_back(fmt::format("{}: {} against {}", path, shown(in_a), shown(in_b)));
    }
    return lines;
}

}  // namespace

std::vector<std::string> scene_differences(const std::string& shot_json_a, const std::string& shot_json_b) {
    return differences_where(shot_json_a, shot_json_b,
                             [](const std::string& path) { return affected_by(path) == Affects::Picture; });
}

std::vector<std::string> setting_differences(const std::string& shot_json_a, const std::string& shot_json_b) {
    return differences_where(shot_json_a, shot_json_b, [](const std::string& path) { return path != "output.path"; });
}

}  // namespace brisance
