#include "diagnostics/write_light_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "film/view_transform.h"
#include "film/write_image.h"
#include "film/write_ply.h"
#include "metrics/false_colour.h"

namespace brisance {

namespace {

namespace fs = std::filesystem;
using Type = PlyProperty::Type;
using Light = LightPictures::Light;

// The colour of a light in a viewer: its mean radiance as the frame's PNG would show it.
std::array<double, 3> display_colour(const Light& light, float exposure_stops, ViewTransform view) {
    const float scale =
        light.area > 0.0 ? std::exp2(exposure_stops) / (std::numbers::pi_v<float> * float(light.area)) : 0.0f;
    const vec3 shown = 255.0f * apply_view(scale * light.flux, view);
    return {shown.x, shown.y, shown.z};
}

std::vector<PlyProperty> properties_of(const std::vector<Light>& lights, float exposure_stops, ViewTransform view) {
    std::vector<PlyProperty> out;
    const auto add = [&](const char* name, Type type, const auto& value) {
        out.push_back({name, type, {}});
        for (const Light& light : lights)
            out.back().values.push_back(value(light));
    };
    const auto add_three = [&](std::array<const char*, 3> names, Type type, const auto& value) {
        for (int c = 0; c < 3; ++c)
            add(names[static_cast<std::size_t>(c)], type, [&](const Light& light) { return value(light)[c]; });
    };
    add_three({"x", "y", "z"}, Type::Double, [](const Light& l) { return l.position; });
    add_three({"nx", "ny", "nz"}, Type::Float, [](const Light& l) { return l.normal; });
    add_three({"tx", "ty", "tz"}, Type::Float, [](const Light& l) { return l.tangent; });
    add("radius", Type::Float, [](const Light& l) { return l.radius; });
    add("area", Type::Float, [](const Light& l) { return l.area; });
    add_three({"flux_r", "flux_g", "flux_b"}, Type::Float, [](const Light& l) { return l.flux; });
    add("profile", Type::Int, [](const Light& l) { return double(l.profile); });
    add_three({"red", "green", "blue"}, Type::Byte,
              [&](const Light& l) { return display_colour(l, exposure_stops, view); });
    return out;
}

const std::vector<std::string> kComments = {
    "virtual lights of a frame of Brisance, in world space, metres",
    "nx ny nz: normal; tx ty tz: first axis of the profile's directions; radius [m]; area [m^2]",
    "flux_r flux_g flux_b: reflected, linear Rec. 709 [W]; profile: tile of the picture of profiles, -1: Lambert",
};

void write_heat(const fs::path& file, const Image& image, const std::string& layer, float most) {
    Plane plane{image.width, image.height, image.layer(layer).pixels};
    for (float& value : plane.values)
        value /= most;
    write_png(file, image.width, image.height, false_colours(plane));
}

// Profiles differ by powers of ten, and the picture shows their shape: each has its brightest texel at white.
Image shown_profiles(const LightPictures& pictures) {
    const Layer& from = pictures.profiles.layer("");
    const int side = pictures.tile, pitch = side + 1, rows = pictures.profiles.height / side;
    Image out{pictures.columns * pitch, rows * pitch, {{"", {"R", "G", "B"}, false, {}}}};
    std::vector<float>& to = out.layers.front().pixels;
    to.assign(std::size_t(3) * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height), 0.0f);
    const auto row_of = [&](int tile, int row) {
        const int y = tile / pictures.columns * side + row, x = tile % pictures.columns * side;
        return &from.pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(pictures.profiles.width) +
                                 static_cast<std::size_t>(x))];
    };
    for (int tile = 0; tile < pictures.columns * rows; ++tile) {
        float most = 0.0f;
        for (int row = 0; row < side; ++row)
            most = std::max(most, *std::max_element(row_of(tile, row), row_of(tile, row) + 3 * side));
        if (!(most > 0.0f))
            continue;
        for (int row = 0; row < side; ++row) {
            const int y = tile / pictures.columns * pitch + row, x = tile % pictures.columns * pitch;
            std::transform(row_of(tile, row), row_of(tile, row) + 3 * side,
                           &to[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                                    static_cast<std::size_t>(x))],
                           [&](float value) { return value / most; });
        }
    }
    return out;
}

}  // namespace

std::vector<fs::path> LightPictureFiles::all() const {
    std::vector<fs::path> out;
    for (const fs::path& file : {ply, exr, profiles_exr, png, count_png, path_length_png, profiles_png})
        if (!file.empty())
            out.push_back(file);
    return out;
}

LightPictureFiles light_picture_files(const fs::path& frame_exr, bool png) {
    const auto named = [&](const char* end) {
        return fs::path(frame_exr).replace_extension(std::string(".virtual_lights") + end);
    };
    LightPictureFiles files{named(".ply"), named(".exr"), named(".profiles.exr"), {}, {}, {}, {}};
    if (png) {
        files.png = named(".png");
        files.count_png = named(".count.png");
        files.path_length_png = named(".path_length.png");
        files.profiles_png = named(".profiles.png");
    }
    return files;
}

void write_light_pictures(const LightPictures& pictures, const LightPictureFiles& files, ImageMetadata metadata,
                          float exposure_stops, ViewTransform view,
                          const std::function<void(const fs::path&)>& written) {
    const auto write = [&](const fs::path& file, const auto& work) {
        if (file.empty())
            return;
        work(file);
        written(file);
    };
    metadata.text.erase("brisance/certificate");
    metadata.text.erase("brisance/believed_error");
    const std::vector<PlyProperty> properties = properties_of(pictures.lights, exposure_stops, view);
    write(files.ply, [&](const fs::path& file) { write_ply(file, properties, kComments); });
    write(files.exr, [&](const fs::path& file) { write_exr(file, pictures.image, metadata); });
    write(files.png, [&](const fs::path& file) { write_png(file, pictures.image, exposure_stops, view); });
    write(files.count_png, [&](const fs::path& file) { write_heat(file, pictures.image, "count", kMostLightsShown); });
    write(files.path_length_png,
          [&](const fs::path& file) { write_heat(file, pictures.image, "path_length", kLongestPathShown); });
    if (pictures.profiles.layers.empty())
        return;
    metadata.text["brisance/profiles"] =
        nlohmann::ordered_json{{"texels_along_a_tile", pictures.tile}, {"tiles_in_a_row", pictures.columns}}.dump();
    write(files.profiles_exr, [&](const fs::path& file) { write_exr(file, pictures.profiles, metadata); });
    write(files.profiles_png,
          [&](const fs::path& file) { write_png(file, shown_profiles(pictures), 0.0f, ViewTransform::Srgb); });
}

}  // namespace brisance
