// A key of one module's settings: its name, the values it accepts, and the member that holds its value. Modules
// describe their own keys with it; the shot puts them under a section of its own (shot/keys/keys.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "codec/codec.h"

namespace brisance {

template <class Settings>
struct SettingKey {
    std::string name;  // without its section: "paths"
    std::string help;  // one line, with the unit
    std::string expected;
    Json schema;
    std::function<bool(Settings&, const Json&)> set;  // false: not accepted, nothing is changed
    std::function<Json(const Settings&)> get;
};

// A value that is the member `at` of the settings.
template <class Settings, class T, class Member>
SettingKey<Settings> setting_key(const std::string& name, const std::string& help, const Codec<T>& codec,
                                 Member Settings::*at) {
    return {name,
            help,
            codec.expected,
            codec.schema,
            [codec, at](Settings& settings, const Json& json) {
                std::optional<T> value = codec.read(json);
                if (value)
                    settings.*at = static_cast<Member>(*value);
                return value.has_value();
            },
            [codec, at](const Settings& settings) { return codec.write(static_cast<T>(settings.*at)); }};
}

}  // namespace brisance
