// A shot from its JSON file. Errors say file and line, the key, what was given and what is expected.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "codec/codec.h"
#include "shot/shot.h"

namespace brisance {

// Layers over the defaults: the base, the file, then the preset, then the overrides in their order. A later one wins.
struct ShotOptions {
    std::string preset;                  // a name of shot_presets(); empty: none
    std::vector<std::string> overrides;  // "smoke.albedo=0.9": JSON, or text where it is no JSON
    std::string base = {};               // a shot in JSON, for what the file leaves open; empty: none
    std::string base_source = {};        // stands for it in messages
};

// Names of the presets. "final" changes nothing: the shot as written, over the defaults.
const std::vector<std::string>& shot_presets();

// Throws Error MissingInput (no such file) or Usage (no JSON; unknown, misplaced or doubled key; wrong type; out of
// range; settings that contradict each other).
// `given` receives the keys that are stated in any layer.
Shot read_shot(const std::filesystem::path& file, const ShotOptions& options = {},
               std::set<std::string>* given = nullptr);

// The same from text. `source` stands for the file in messages; relative paths of the shot are relative to `folder`.
Shot parse_shot(const std::string& text, const std::string& source, const std::filesystem::path& folder,
                const ShotOptions& options = {}, std::set<std::string>* given = nullptr);

// Throws Error Usage, beginning with `where`, unless `path` is a key of a shot ("smoke.albedo") that accepts `value`.
void check_setting(const std::string& where, const std::string& path, const Json& value);

}  // namespace brisance
