// The table of a shot's keys. Reading, checking, help, the published schema and writing back all follow it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codec/codec.h"
#include "shot/shot.h"

namespace brisance {

// What a key affects: the true picture, on which every method must agree, or how it is computed and written.
enum class Affects { Picture, Method };

struct Key {
    std::string path;  // dotted: "smoke.albedo"
    std::string help;  // one line, with the unit
    std::string expected;
    Json schema;
    std::function<bool(Shot&, const Json&)> set;          // false: not accepted, the shot is unchanged
    std::function<std::optional<Json>(const Shot&)> get;  // absent: the shot leaves it open
    std::function<std::optional<Mismatch>(const Json&)> find_mismatch = {};  // of values with parts; else empty
    Affects affects = Affects::Picture;                                      // set for all keys by their paths
};

Affects affected_by(const std::string& path);

// A value that lives at `at(shot)`.
template <class T, class At>
Key make_key(const std::string& path, const std::string& help, const Codec<T>& codec, At at) {
    return {path,
            help,
            codec.expected,
            codec.schema,
            [codec, at](Shot& shot, const Json& json) {
                std::optional<T> value = codec.read(json);
                if (value)
                    at(shot) = std::move(*value);
                return value.has_value();
            },
            [codec, at](const Shot& shot) -> std::optional<Json> {
                Shot copy = shot;  // so that one accessor reads and writes
                return codec.write(at(copy));
            },
            codec.find_mismatch};
}

// A value whose presence says more than the value: `flag(shot)` becomes true, and it is written only then.
template <class T, class At, class Flag>
Key make_flagged_key(const std::string& path, const std::string& help, const Codec<T>& codec, At at, Flag flag) {
    Key key = make_key(path, help, codec, at);
    key.set = [set = key.set, flag](Shot& shot, const Json& json) {
        const bool accepted = set(shot, json);
        if (accepted)
            flag(shot) = true;
        return accepted;
    };
    key.get = [get = key.get, flag](const Shot& shot) -> std::optional<Json> {
        Shot copy = shot;
        return flag(copy) ? get(shot) : std::nullopt;
    };
    return key;
}

void add_volume_keys(std::vector<Key>& keys);
void add_time_keys(std::vector<Key>& keys);
void add_medium_keys(std::vector<Key>& keys);
void add_scene_keys(std::vector<Key>& keys);
void add_camera_keys(std::vector<Key>& keys);
void add_shutter_keys(std::vector<Key>& keys);
void add_lighting_keys(std::vector<Key>& keys);
void add_fire_light_keys(std::vector<Key>& keys);
void add_unified_light_keys(std::vector<Key>& keys);
void add_scattering_method_keys(std::vector<Key>& keys);
void add_virtual_light_keys(std::vector<Key>& keys);
void add_tracing_keys(std::vector<Key>& keys);
void add_correction_keys(std::vector<Key>& keys);
void add_certify_keys(std::vector<Key>& keys);
void add_output_keys(std::vector<Key>& keys);

// All of them, in the order they are written.
const std::vector<Key>& shot_keys();

// Objects that hold keys, with one line each: {"smoke", "..."}, parents before children.
const std::vector<std::pair<std::string, std::string>>& shot_sections();

}  // namespace brisance
