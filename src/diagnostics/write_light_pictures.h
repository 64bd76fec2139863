// Pictures of virtual lights as files beside a frame.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "diagnostics/light_pictures.h"
#include "film/settings.h"

namespace brisance {

struct LightPictureFiles {
    std::filesystem::path ply, exr, profiles_exr;
    std::filesystem::path png, count_png, path_length_png, profiles_png;  // empty: not wanted
    std::vector<std::filesystem::path> all() const;                       // those wanted
};

// STEM.virtual_lights.ply, .exr, .profiles.exr; with `png` also .png, .count.png, .path_length.png, .profiles.png.
LightPictureFiles light_picture_files(const std::filesystem::path& frame_exr, bool png);

// `metadata`: the frame's. Exposure and view of the PNG and of the colours in the PLY. `written` is told each file when
// it is there. Profiles are only written where there are some; in their PNG each is as bright as can be, and a black
// line parts it from the next. Throws Error CannotCreate or OutputFailed; each file is then whole or as it was before.
void write_light_pictures(const LightPictures& pictures, const LightPictureFiles& files, ImageMetadata metadata,
                          float exposure_stops, ViewTransform view,
                          const std::function<void(const std::filesystem::path&)>& written);

// Colours of the heat maps end at these.
inline constexpr float kMostLightsShown = 8.0f, kLongestPathShown = 5.0f;

}  // namespace brisance
