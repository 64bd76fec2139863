#include "shot/write_shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "shot/keys/keys.h"

namespace brisance {
namespace {

Json& at_path(Json& root, const std::string& path) {
    Json* node = &root;
    std::size_t begin = 0;
    for (std::size_t point = path.find('.'); point != std::string::npos; point = path.find('.', begin)) {
        node = &(*node)[path.substr(begin, point - begin)];
        begin = point + 1;
    }
    return (*node)[path.substr(begin)];
}

Json resolved(const Shot& shot) {
    Json root = Json::object();
    for (const Key& key : shot_keys())
        if (const std::optional<Json> value = key.get(shot))
            at_path(root, key.path) = *value;
    return root;
}

std::string schema_path(const std::string& path) {
    std::string result = "properties.";
    for (const char c : path)
        result += c == '.' ? std::string(".properties.") : std::string(1, c);
    return result;
}

std::string dumped(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string one_line(const Json& json) {
    if (!json.is_array())
        return dumped(json, -1);
    std::string text = "[";
    for (const Json& item : json)
        text.append(text.size() > 1 ? ", " : "").append(one_line(item));
    return text + "]";
}

bool holds_objects(const Json& json) {
    return json.is_object() || (json.is_array() && std::any_of(json.begin(), json.end(), holds_objects));
}

// Prints JSON indented, with lists of plain values on one line.
void print(const Json& json, int depth, std::string& out) {
    if (!holds_objects(json)) {
        out += one_line(json);
        return;
    }
    const std::string indent(static_cast<std::size_t>(depth) * 4, ' ');
    out += json.is_array() ? '[' : '{';
    const char* separator = "";
    for (const auto& item : json.items()) {
        out.append(separator).append("\n    ").append(indent);
        if (json.is_object())
            out.append(dumped(Json(item.key()), -1)).append(": ");
        print(item.value(), depth + 1, out);
        separator = ",";
    }
    if (!json.empty())
        out.append("\n").append(indent);
    out += json.is_array() ? ']' : '}';
}

std::string printed(const Json& json) {
    std::string text;
    print(json, 0, text);
    return text + "\n";
}

}  // namespace

std::string to_json(const Shot& shot) {
    return printed(resolved(shot));
}

std::string settings_hash(const Shot& shot) {
    Json settings = resolved(shot);
    at_path(settings, "output").erase("path");
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : dumped(settings, -1))
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return fmt::format("{:016x}", hash);
}

std::string shot_schema() {
    const Shot defaults;
    Json root = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "Brisance shot"},
                 {"description", "One image or sequence. Comments are allowed in shot files."},
                 {"type", "object"},
                 {"additionalProperties", false},
                 {"required", {"volume"}},
                 {"properties", Json::object()}};
    const auto declare_sections_of = [&](const std::string& path) {
        for (const auto& [name, help] : shot_sections()) {
            if (!path.starts_with(name + "."))
                continue;
            Json& section = at_path(root, schema_path(name));
            if (section.is_null())
                section = {{"description", help}, {"type", "object"}, {"additionalProperties", false}};
        }
    };
    for (const Key& key : shot_keys()) {
        declare_sections_of(key.path);
        Json& node = at_path(root, schema_path(key.path));
        node = {{"description", key.help}};
        node.update(key.schema);
        if (const std::optional<Json> value = key.get(defaults); value && key.path != "volume.file")
            node["default"] = *value;
    }
    at_path(root, schema_path("volume"))["required"] = {"file"};
    return printed(root);
}

std::string shot_keys_text() {
    const Shot defaults;
    std::string text;
    for (const Key& key : shot_keys()) {
        const std::optional<Json> value = key.get(defaults);
        text += fmt::format("{}\n    {}\n    {}{}\n", key.path, key.help, key.expected,
                            value ? "; default " + dumped(*value, -1) : "");
    }
    return text;
}

}  // namespace brisance
