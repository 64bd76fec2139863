#include "first_look/look_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/input_file.h"
#include "core/printable.h"
#include "shot/json_text.h"
#include "shot/read_shot.h"

namespace brisance {

namespace {

constexpr std::uint64_t kLargestLook = std::uint64_t{16} << 20;
constexpr int kVersion = 1;

[[noreturn]] void reject(const std::string& source, const std::string& what) {
    throw Error(ExitCode::Usage,
                fmt::format("{}: {}; `brisance inspect VOLUME --write-look FILE` writes a sound one", source, what));
}

const Json& part(const Json& json, const char* name, Json::value_t kind, const std::string& source) {
    const auto found = json.find(name);
    if (found == json.end())
        reject(source, fmt::format("no look: \"{}\" is missing", name));
    const bool number = kind == Json::value_t::number_float && found->is_number();
    if (found->type() != kind && !number)
        reject(source, fmt::format("\"{}\" is of the wrong kind", name));
    return *found;
}

std::vector<int> integers(const Json& list, const char* name, const std::string& source) {
    std::vector<int> out;
    for (const Json& item : list) {
        if (!item.is_number_integer() || std::abs(item.get<double>()) > double(std::numeric_limits<int>::max()))
            reject(source, fmt::format("\"{}\" must hold whole numbers of at most 31 bits", name));
        out.push_back(item.get<int>());
    }
    return out;
}

// Keys become paths into a shot, so only keys of a shot are safe.
LookDecision decision_of(const std::string& key, const Json& decision, const JsonText& text,
                         const std::string& source) {
    const std::string shown = printable(key, kLongestName);
    if (!decision.is_object() || !decision.contains("value"))
        reject(source, fmt::format("decision \"{}\" has no \"value\"", shown));
    const auto line = text.line_of_key.find("decisions." + key);
    check_setting(line == text.line_of_key.end() ? source : fmt::format("{}:{}", source, line->second), key,
                  decision["value"]);
    const auto why = decision.find("why");
    const bool reasoned = why != decision.end() && why->is_string();
    return {key, decision["value"], reasoned ? why->get<std::string>() : ""};
}

std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool is_point(const LookDecision* decision) {
    return decision != nullptr && decision->value.is_array() && decision->value.size() == 3 &&
           std::ranges::all_of(decision->value, [](const Json& v) { return v.is_number(); });
}

// Steps back from the target, or closer, for a picture of another aspect.
void refit(Json& shot, const Look& look, double aspect) {
    const LookDecision *const eye = look.find("camera.eye"), *const target = look.find("camera.target");
    const double fill = std::max(look.fill[0] * look.aspect / aspect, look.fill[1]);
    if (!is_point(eye) || !is_point(target) || !(fill > 0.0) || std::abs(aspect / look.aspect - 1.0) < 1e-3)
        return;
    Json moved = Json::array();
    for (std::size_t a = 0; a < 3; ++a) {
        const double from = target->value[a].get<double>(), to = eye->value[a].get<double>();
        moved.push_back(from + (to - from) * fill / kLookFill);
    }
    at_path(shot, "camera.eye") = moved;
}

}  // namespace

Json shot_of_look(const Look& look, const Stated& stated) {
    const auto open = [&](const std::string& key) {
        if (stated.has(key) || (stated.shot.camera_given && key.starts_with("camera.")))
            return false;
        return !(stated.has("fire.model") && key.starts_with("fire.") && key != "fire.strength");
    };
    Json shot = Json::object();
    for (const LookDecision& d : look.decisions)
        if (open(d.key))
            at_path(shot, d.key) = d.value;
    if (!stated.shot.camera_given)
        refit(shot, look, double(stated.shot.camera.width) / stated.shot.camera.height);
    return shot;
}

std::vector<std::string> describe_look(const Look& look) {
    std::vector<std::string> lines;
    for (const LookDecision& d : look.decisions) {
        std::string value = dump(d.value);
        if (value.size() > 60)
            value = d.value.is_array() ? fmt::format("({} entries)", d.value.size()) : printable(value, 60);
        lines.push_back(fmt::format("{} = {}{}{}", d.key, value, d.why.empty() ? "" : "  # ", d.why));
    }
    return lines;
}

std::string look_to_json(const Look& look) {
    std::string text = fmt::format(
        "{{\n    \"brisance_look\": {},\n    \"volume\": {},\n    \"frames\": {},\n    \"looked_at\": {},\n"
        "    \"aspect\": {},\n    \"fill\": {},\n    \"warnings\": {},\n    \"decisions\": {{",
        kVersion, dump(look.volume), dump(look.frames), dump(look.looked_at), dump(look.aspect),
        dump(Json{look.fill[0], look.fill[1]}), dump(look.warnings));
    const char* separator = "\n";
    for (const LookDecision& d : look.decisions) {
        text += fmt::format("{}        {}: {{\"value\": {}, \"why\": {}}}", separator, dump(d.key), dump(d.value),
                            dump(d.why));
        separator = ",\n";
    }
    return text + "\n    }\n}\n";
}

Look look_from_json(const std::string& text, const std::string& source) {
    using Kind = Json::value_t;
    const JsonText parsed = parse_json_text(text, source);
    const Json& json = parsed.value;
    if (!json.is_object() || !json.contains("brisance_look"))
        reject(source, "is no look");
    if (json["brisance_look"] != kVersion)
        reject(source, fmt::format("is a look of another version than {}", kVersion));
    Look look;
    look.volume = part(json, "volume", Kind::string, source).get<std::string>();
    look.frames = integers(part(json, "frames", Kind::array, source), "frames", source);
    look.looked_at = integers(part(json, "looked_at", Kind::array, source), "looked_at", source);
    look.aspect = part(json, "aspect", Kind::number_float, source).get<double>();
    const Json& fill = part(json, "fill", Kind::array, source);
    if (fill.size() != 2 || !fill[0].is_number() || !fill[1].is_number() || !(look.aspect > 0.0))
        reject(source, "\"aspect\" must be above 0, and \"fill\" two numbers");
    look.fill[0] = fill[0].get<double>(), look.fill[1] = fill[1].get<double>();
    for (const Json& line : part(json, "warnings", Kind::array, source))
        look.warnings.push_back(line.is_string() ? line.get<std::string>() : dump(line));
    for (const auto& [key, decision] : part(json, "decisions", Kind::object, source).items())
        look.decisions.push_back(decision_of(key, decision, parsed, source));
    return look;
}

Look read_look(const std::filesystem::path& file) {
    return look_from_json(read_input(file, kLargestLook, ExitCode::Usage), file.string());
}

}  // namespace brisance
