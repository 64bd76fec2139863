#include <fmt/format.h>

#include "shot/keys/keys.h"
#include "shot/keys/object_codec.h"
#include "shot/keys/time_codecs.h"

namespace brisance {
namespace {

std::optional<std::vector<TimePoint>> read_curve(const Json& json) {
    if (!json.is_array())
        return std::nullopt;
    std::vector<TimePoint> curve;
    const Codec<double> number = real(source_times());
    for (const Json& item : json) {
        if (!item.is_array() || item.size() != 2)
            return std::nullopt;
        const std::optional<double> frame = number.read(item[0]), source = number.read(item[1]);
        if (!frame || !source)
            return std::nullopt;
        if (!curve.empty() && !(*frame > curve.back().frame && *source >= curve.back().source))
            return std::nullopt;
        curve.push_back({*frame, *source});
    }
    return curve;
}

// Says which pair goes backward.
std::optional<Mismatch> find_curve_mismatch(const Json& json) {
    for (std::size_t i = 0; json.is_array() && i < json.size(); ++i) {
        const std::string path = fmt::format("[{}]", i);
        if (!read_curve(Json::array({json[i]})))
            return Mismatch{path, "a pair [frame, source time] of numbers", json[i]};
        if (i > 0 && !read_curve(Json::array({json[i - 1], json[i]})))
            return Mismatch{path,
                            fmt::format("a pair that does not go backward: a frame after, and a time not before, {}",
                                        json[i - 1].dump()),
                            json[i]};
    }
    return std::nullopt;
}

}  // namespace

Range source_times() {
    return {-1e9, 1e9};
}

Range speeds() {
    return {0.0, 1e6};
}

Range frame_rates() {
    return {0.0, 1e6, true};
}

Codec<BeyondEnd> beyond_end() {
    return choice<BeyondEnd>({{"error", BeyondEnd::Error},
                              {"hold", BeyondEnd::Hold},
                              {"repeat", BeyondEnd::Repeat},
                              {"ping_pong", BeyondEnd::PingPong},
                              {"empty", BeyondEnd::Empty}});
}

Codec<MissingFrame> missing_frame() {
    return choice<MissingFrame>(
        {{"error", MissingFrame::Error}, {"hold", MissingFrame::Hold}, {"interpolate", MissingFrame::Interpolate}});
}

Codec<Retime> retime() {
    return choice<Retime>({{"auto", Retime::Automatic},
                           {"nearest", Retime::Nearest},
                           {"linear", Retime::Linear},
                           {"advect", Retime::Advect}});
}

Codec<VelocityUnit> velocity_unit() {
    return choice<VelocityUnit>({{"auto", VelocityUnit::Automatic},
                                 {"second", VelocityUnit::Second},
                                 {"frame", VelocityUnit::Frame},
                                 {"voxel_second", VelocityUnit::VoxelSecond},
                                 {"voxel_frame", VelocityUnit::VoxelFrame}});
}

Codec<std::vector<TimePoint>> time_curve() {
    Codec<std::vector<TimePoint>> codec;
    const Json number = real(source_times()).schema;
    codec.schema = {{"type", "array"},
                    {"items", {{"type", "array"}, {"items", number}, {"minItems", 2}, {"maxItems", 2}}}};
    codec.expected = "a list of pairs [[frame, source time], ...] with rising frames and times that do not fall";
    codec.read = read_curve;
    codec.write = [](const std::vector<TimePoint>& curve) {
        Json json = Json::array();
        for (const TimePoint& point : curve)
            json.push_back(Json::array({point.frame, point.source}));
        return json;
    };
    codec.find_mismatch = find_curve_mismatch;
    return codec;
}

Codec<std::optional<std::vector<std::string>>> velocity_grids() {
    using Value = std::optional<std::vector<std::string>>;
    const Json name = {{"type", "string"}};
    const Json three = {{"type", "array"}, {"items", name}, {"minItems", 3}, {"maxItems", 3}};
    Codec<Value> codec;
    codec.schema = {{"anyOf", Json::array({name, three, Json{{"type", "null"}}})}};
    codec.expected = "a name in quotes, three of them [\"x\", \"y\", \"z\"], or null";
    codec.read = [](const Json& json) -> std::optional<Value> {
        if (json.is_null())
            return Value();
        if (json.is_string())
            return json.get<std::string>().empty() ? Value(std::vector<std::string>())
                                                   : Value(std::vector<std::string>{json.get<std::string>()});
        std::vector<std::string> names;
        for (const Json& item : json.is_array() ? json : Json::array())
            if (item.is_string() && !item.get_ref<const std::string&>().empty())
                names.push_back(item.get<std::string>());
        return names.size() == 3 && json.size() == 3 ? std::optional<Value>(names) : std::nullopt;
    };
    codec.write = [](const Value& value) -> Json {
        if (!value)
            return nullptr;
        return value->size() == 3 ? Json(*value) : Json(value->empty() ? "" : value->front());
    };
    return codec;
}

Codec<TimeSettings> time_object() {
    using T = TimeSettings;
    return object_of<T>("times {\"offset\": ..., \"speed\": ..., \"after\": \"hold\", ...}, as the section time",
                        {member<T>(
                             "offset", real(source_times()), [](T & t) -> auto& { return t.offset; }),
                         member<T>(
                             "speed", real(speeds()), [](T & t) -> auto& { return t.speed; }),
                         member<T>(
                             "curve", time_curve(), [](T & t) -> auto& { return t.curve; }),
                         member<T>(
                             "before", beyond_end(), [](T & t) -> auto& { return t.before; }),
                         member<T>(
                             "after", beyond_end(), [](T & t) -> auto& { return t.after; }),
                         member<T>(
                             "missing", missing_frame(), [](T & t) -> auto& { return t.missing; }),
                         member<T>(
                             "retime", retime(), [](T & t) -> auto& { return t.retime; })});
}

Codec<VelocitySettings> velocity_object() {
    using T = VelocitySettings;
    return object_of<T>(
        "a velocity {\"unit\": ..., \"scale\": ..., \"frames_per_second\": ...}",
        {member<T>(
             "unit", velocity_unit(), [](T & t) -> auto& { return t.unit; }),
         member<T>(
             "scale", real(grid_value()), [](T & t) -> auto& { return t.scale; }),
         member<T>(
             "frames_per_second", real(frame_rates()), [](T & t) -> auto& { return t.frames_per_second; })});
}

void add_time_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "time.offset", "added to the time of a sequence of volumes [its frames]", real(source_times()),
        [](Shot & s) -> auto& { return s.time.offset; }));
    keys.push_back(make_key(
        "time.speed", "frames of the sequence for each frame of the picture, from the sequence's first frame on",
        real(speeds()), [](Shot & s) -> auto& { return s.time.speed; }));
    keys.push_back(make_key(
        "time.curve", "instead of a speed: the sequence's time at frames of the picture, linear in between",
        time_curve(), [](Shot & s) -> auto& { return s.time.curve; }));
    keys.push_back(make_key(
        "time.before", "what times before the sequence's first frame show", beyond_end(),
        [](Shot & s) -> auto& { return s.time.before; }));
    keys.push_back(make_key(
        "time.after", "what times after the sequence's last frame show", beyond_end(),
        [](Shot & s) -> auto& { return s.time.after; }));
    keys.push_back(make_key(
        "time.missing", "what stands in for frames that are missing in between", missing_frame(),
        [](Shot & s) -> auto& { return s.time.missing; }));
    keys.push_back(make_key(
        "time.retime", "how times between frames are made; auto: linear or advect, by frames that are known", retime(),
        [](Shot & s) -> auto& { return s.time.retime; }));
    keys.push_back(make_key(
        "velocity.unit", "of the velocity grid: metres or voxels, per second or frame; auto: fitted to the motion",
        velocity_unit(), [](Shot & s) -> auto& { return s.velocity.unit; }));
    keys.push_back(make_key(
        "velocity.scale", "multiplies the velocity", real(grid_value()),
        [](Shot & s) -> auto& { return s.velocity.scale; }));
    keys.push_back(make_key(
        "velocity.frames_per_second", "of the sequence, for units per second [1/s]", real(frame_rates()),
        [](Shot & s) -> auto& { return s.velocity.frames_per_second; }));
}

}  // namespace brisance
