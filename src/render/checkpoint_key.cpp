#include "render/checkpoint_key.h"

#include <algorithm>
#include <array>

#include "render/input/load_medium.h"
#include "render/input/volume_in_time.h"
#include "shot/keys/keys.h"

namespace brisance {

namespace {

// Settings of the method that decide which random numbers a path draws, or how sums are kept.
constexpr std::array kDecisive = {"tracing.seed",        "tracing.emission",      "tracing.light_sampling",
                                  "tracing.free_flight", "tracing.transmittance", "output.layers.bounces"};

bool decides_bits(const Key& key) {
    return key.affects == Affects::Picture ||
           std::find(kDecisive.begin(), kDecisive.end(), key.path) != kDecisive.end();
}

std::string size_of(const std::filesystem::path& file) {
    std::error_code ignored;
    return std::to_string(std::filesystem::file_size(file, ignored));
}

}  // namespace

std::string checkpoint_key(const Shot& shot, const std::filesystem::path& volume, int frame) {
    std::string text;
    for (const Key& key : shot_keys())
        if (decides_bits(key))
            if (const std::optional<Json> value = key.get(shot))
                text += key.path + "=" + value->dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    text += volume.filename().string() + " " + size_of(volume) + " " + std::to_string(frame);
    if (!volume.empty() && !shot.time.identity())
        if (const SourceFiles files = own_files(shot, frame); !files.single())
            text.append(" ").append(size_of(files.first)).append(" ").append(size_of(files.second));
    for (const std::filesystem::path& file : further_files(shot, frame))
        text.append(" ").append(size_of(file));
    for (const SceneFile& file : shot.scene.files)
        text.append(" ").append(size_of(shot.folder / file.file));
    return text;
}

}  // namespace brisance
