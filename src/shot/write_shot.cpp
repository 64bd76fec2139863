#include "shot/write_shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "shot/json_text.h"
#include "shot/keys/keys.h"

namespace brisance {
namespace {

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

// What a schema accepts, in a few words.
std::string words_of(const Json& schema) {
    if (const auto any = schema.find("anyOf"); any != schema.end()) {
        std::string words;
        for (const Json& option : *any)
            words += (words.empty() ? "" : " or ") + words_of(option);
        return words;
    }
    if (schema.contains("enum"))
        return fmt::format("one of {}", dumped(schema["enum"], -1));
    if (schema.contains("const"))
        return dumped(schema["const"], -1);
    const std::string type = schema.contains("type") && schema["type"].is_string() ? schema["type"] : "value";
    if (type == "array" && schema.contains("items") && schema["items"].is_object())
        return fmt::format("a list of {}{}", schema.contains("minItems") ? dumped(schema["minItems"], -1) + " x " : "",
                           words_of(schema["items"]));
    std::string words = type == "number" || type == "integer" ? "a number" : type == "boolean" ? "true or false" : type;
    for (const auto& [bound, sign] : {std::pair("minimum", ">="), std::pair("exclusiveMinimum", ">"),
                                      std::pair("maximum", "<="), std::pair("exclusiveMaximum", "<")})
        if (schema.contains(bound))
            words += fmt::format(" {} {}", sign, dumped(schema[bound], -1));
    return words == "string" ? "text" : words;
}

// The keys of the objects of a list, each on a line that begins with `path`, which ends with a dot.
void append_members(const std::string& path, const Json& object, std::string& text) {
    for (const auto& [name, schema] : object["properties"].items()) {
        const Json required = object.value("required", Json::array());
        const bool needed = std::find(required.begin(), required.end(), Json(name)) != required.end();
        text += fmt::format("    {}{}: {}{}\n", path, name, words_of(schema), needed ? "; required" : "");
        if (schema.contains("properties"))
            append_members(fmt::format("{}{}.", path, name), schema, text);
    }
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
        const auto items = key.schema.find("items");
        if (items != key.schema.end() && items->contains("properties"))
            append_members(key.path + "[].", *items, text);
    }
    return text;
}

}  // namespace brisance
