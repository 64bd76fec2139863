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

// `metadata` is the frame's. Exposure and view apply to the PNG and to the colours in the PLY. `written` is called with
// each file once it exists. Profiles are only written where there are some; in their PNG each is scaled to full
// brightness, and a black line separates it from the next. Throws Error CannotCreate or OutputFailed; each file is then
// whole or as it was before.
void write_light_pictures(const LightPictures& pictures, const LightPictureFiles& files, ImageMetadata metadata,
                          float exposure_stops, ViewTransform view,
                          const std::function<void(const std::filesystem::path&)>& written);

// Upper ends of the heat maps' colour scales.
inline constexpr float kMostLightsShown = 8.0f, kLongestPathShown = 5.0f;

}  // namespace brisance
