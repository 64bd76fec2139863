// Pictures of virtual lights: positions in the picture, contents of the files, and cases without pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include "core/error.h"
#include "diagnostics/write_light_pictures.h"
#include "film/fixtures.h"
#include "film/write_image.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"
#include "virtual_lights/octahedral_map.h"

namespace brisance {
namespace {

using namespace testing;
namespace fs = std::filesystem;

constexpr int kWidth = 40, kHeight = 30;
const vec3 kLow(-1.0f), kHigh(1.0f);

// A closed box with a lamp in its middle.
struct LitBox {
    explicit LitBox(const SceneMaterial& walls, int count) : surroundings(scene_of(walls), {LightSettings{}}) {
        VirtualLightSettings settings;
        settings.count = count;
        settings.photons = 20000;
        const Camera from = camera(dvec3(0.9, 0.8, 0.7), dvec3(0.0));
        lights.emplace(direct, PixelCamera{kWidth, kHeight, [&](double x, double y) { return from.ray(x, y); }},
                       settings);
    }
    static Scene scene_of(const SceneMaterial& walls) {
        Scene scene;
        add_box(scene, kLow, kHigh, walls, true);
        return scene;
    }
    static CameraSettings camera_settings(const dvec3& eye, const dvec3& target) {
        CameraSettings s;
        s.eye = eye;
        s.target = target;
        s.up = {0.3, 0.4, 1.0};
        s.vertical_fov_degrees = 60.0;
        s.width = kWidth;
        s.height = kHeight;
        return s;
    }
    Camera camera(const dvec3& eye, const dvec3& target) const { return {camera_settings(eye, target), medium}; }
    LightPictures pictures(const Camera& from) const {
        const Layer gray = gray_image(kWidth, kHeight, 1.0f).layer("");
        return make_light_pictures(*lights, surroundings, from, gray, std::vector<float>(kWidth * kHeight, 1.0f));
    }

    Medium medium;
    Surroundings surroundings;
    DirectLight direct{medium, {}, &surroundings};
    std::optional<VirtualLights> lights;
};

SceneMaterial rough_metal() {
    SceneMaterial m = lambert(0.7f);
    m.surface.metallic = 1.0f;
    m.surface.roughness = 0.5f;
    return m;
}

std::size_t drawn(const LightPictures& pictures) {
    const std::vector<float>& number = pictures.image.layer("light").pixels;
    return static_cast<std::size_t>(std::count_if(number.begin(), number.end(), [](float n) { return n > 0.0f; }));
}

TEST(CameraProjection, FindsThePixelOfARay) {
    const LitBox box(lambert(0.7f), 1);
    const Camera camera = box.camera({0.3, -0.2, 0.1}, {-0.5, 0.6, 0.4});
    for (const double x : {0.0, 7.3, 39.9})
        for (const double y : {0.2, 15.0, 29.5}) {
            const Ray ray = camera.ray(x, y);
            const std::optional<glm::dvec2> at = camera.project(ray.origin + 3.7 * ray.direction);
            ASSERT_TRUE(at);
            EXPECT_NEAR(at->x, x, 1e-9);
            EXPECT_NEAR(at->y, y, 1e-9);
            EXPECT_FALSE(camera.project(ray.origin - ray.direction));
        }
    EXPECT_FALSE(camera.project(camera.eye_local()));
}

TEST(LightPictures, ALightIsDrawnWhereTheCameraSeesIt) {
    const LitBox box(lambert(0.7f), 1);
    ASSERT_EQ(box.lights->lights().size(), 1u);
    const VirtualLight& light = box.lights->lights().front();
    // Beside the middle of the picture.
    const dvec3 eye = light.position + 0.8 * light.frame.normal;
    const LightPictures pictures =
        box.pictures(box.camera(eye, light.position + 0.2 * light.frame.tangent - 0.1 * light.frame.bitangent));
    EXPECT_EQ(pictures.seen, 1u);
    const Camera camera = box.camera(eye, light.position + 0.2 * light.frame.tangent - 0.1 * light.frame.bitangent);
    const Rgb sent = box.lights->radiance(light, light.frame.normal);
    const Layer &alone = pictures.image.layer("lights"), &number = pictures.image.layer("light");
    int covered = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto p = static_cast<std::size_t>(y * kWidth + x);
            const double off = std::acos(
                std::min(1.0, glm::dot(camera.ray(x + 0.5, y + 0.5).direction, glm::normalize(light.position - eye))));
            const bool disc = number.pixels[p] == 1.0f;
            covered += disc ? 1 : 0;
            EXPECT_EQ(alone.pixels[4 * p + 3], disc ? 1.0f : 0.0f);
            EXPECT_EQ(alone.pixels[4 * p + 1], disc ? sent.y : 0.0f);
            if (off < 0.4 * camera.pixel_angle()) {  // its own pixel
                EXPECT_TRUE(disc) << x << " " << y;
            } else if (off > 1.5 * camera.pixel_angle()) {
                EXPECT_FALSE(disc) << x << " " << y;
            }
        }
    EXPECT_GE(covered, 1);
    EXPECT_LE(covered, 4);
}

TEST(LightPictures, HiddenLightsAreNotDrawn) {
    const LitBox box(lambert(0.7f), 1);
    const VirtualLight& light = box.lights->lights().front();
    // Through the opposite wall, from behind its own, and with the back to it.
    for (const double away : {5.0, -1.0})
        EXPECT_EQ(drawn(box.pictures(box.camera(light.position + away * light.frame.normal, light.position))), 0u);
    const dvec3 eye = light.position + 0.5 * light.frame.normal;
    EXPECT_EQ(drawn(box.pictures(box.camera(eye, eye + light.frame.normal))), 0u);
}

TEST(LightPictures, CountsAreTheLightsThatSpeakForAPixel) {
    const LitBox box(lambert(0.7f), 300);
    const Camera camera = box.camera({0.9, 0.8, 0.7}, dvec3(0.0));
    const std::vector<float> counts = box.pictures(camera).image.layer("count").pixels;
    double sum = 0.0;
    for (std::size_t p = 0; p < counts.size(); ++p) {
        const RaySegment seen =
            box.direct.segment_along(camera.ray(double(p % kWidth) + 0.5, double(p / kWidth) + 0.5));
        int within = 0;  // by their spheres: walls are flat, nothing stands on them
        for (const VirtualLight& light : box.lights->lights())
            within += glm::distance(light.position, seen.point->position) < light.radius &&
                      glm::dot(light.frame.normal, seen.point->geometric_normal) > 0.7;
        EXPECT_NEAR(counts[p], std::min(within, LightShares::kMost), 1.0) << p;  // rounding at a sphere's edge
        sum += counts[p] - std::min(within, LightShares::kMost);
    }
    EXPECT_NEAR(sum / double(counts.size()), 0.0, 0.01);
}

TEST(LightPictures, ATileIsTheProfileOfItsLight) {
    const LitBox box(rough_metal(), 20);
    const LightPictures pictures = box.pictures(box.camera({0.9, 0.8, 0.7}, dvec3(0.0)));
    const Layer& atlas = pictures.profiles.layer("");
    const int side = pictures.tile;
    EXPECT_EQ(side, VirtualLightSettings{}.profile_resolution);
    ASSERT_EQ(pictures.lights.size(), box.lights->lights().size());
    for (std::size_t i = 0; i < pictures.lights.size(); ++i) {
        const VirtualLight& light = box.lights->lights()[i];
        const int tile = pictures.lights[i].profile;
        ASSERT_GE(tile, 0);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const dvec3 toward =
                    light.frame.world_from_local(hemisphere_of_square((x + 0.5) / side, (y + 0.5) / side));
                const Rgb expected = box.lights->radiance(light, toward);
                const std::size_t row = static_cast<std::size_t>(tile / pictures.columns * side + y),
                                  column = static_cast<std::size_t>(tile % pictures.columns * side + x);
                const float* const texel =
                    &atlas.pixels[3 * (row * static_cast<std::size_t>(pictures.profiles.width) + column)];
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(texel[c], expected[c], 1e-4f * (expected[c] + 1.0f)) << i << " " << x << " " << y;
            }
    }
}

TEST(LightPictures, LambertLightsHaveNoProfiles) {
    const LitBox box(lambert(0.7f), 5);
    const LightPictures pictures = box.pictures(box.camera({0.9, 0.8, 0.7}, dvec3(0.0)));
    EXPECT_TRUE(pictures.profiles.layers.empty());
    for (const LightPictures::Light& light : pictures.lights)
        EXPECT_EQ(light.profile, -1);
}

// Properties by name, of a binary little-endian file of vertices alone.
std::map<std::string, std::vector<double>> read_ply(const fs::path& file, std::size_t& vertices) {
    const std::string bytes = contents(file);
    const std::string end = "end_header\n";
    const std::size_t header = bytes.find(end) + end.size();
    std::istringstream lines(bytes.substr(0, header));
    std::vector<std::pair<std::string, std::string>> properties;  // type, name
    std::string word;
    while (lines >> word) {
        if (word == "vertex")
            lines >> vertices;
        if (word != "property")
            continue;
        std::string type, name;
        lines >> type >> name;
        properties.emplace_back(type, name);
    }
    std::map<std::string, std::vector<double>> out;
    const char* at = bytes.data() + header;
    const auto take = [&](auto value) {
        std::memcpy(&value, at, sizeof value);
        at += sizeof value;
        return static_cast<double>(value);
    };
    for (std::size_t v = 0; v < vertices; ++v)
        for (const auto& [type, name] : properties)
            out[name].push_back(type == "double"  ? take(double{})
                                : type == "float" ? take(float{})
                                : type == "int"   ? take(std::int32_t{})
                                                  : take(std::uint8_t{}));
    EXPECT_EQ(at, bytes.data() + bytes.size());
    return out;
}

Shot shot_of_box() {
    Shot shot;
    shot.camera_given = true;
    shot.camera = LitBox::camera_settings({0.9, 0.8, 0.7}, dvec3(0.0));
    shot.camera.samples_per_axis = 2;
    shot.virtual_lights.count = 400;
    shot.virtual_lights.photons = 20000;
    shot.output.virtual_lights = true;
    shot.certify.belief = 0.0;
    shot.correction.samples = 0;  // by lights alone
    return shot;
}

// Keeps warnings, but for that of the believed error: so few lights leave noise.
class Listener : public Progress {
public:
    void warning(const std::string& code, const std::string& line) override {
        if (code != "error")
            warnings.push_back(code + ": " + line);
    }
    std::vector<std::string> warnings;
};

RenderedFrame render(const Shot& shot, Progress& progress, const SceneMaterial& walls = lambert(0.7f)) {
    const Surroundings surroundings(LitBox::scene_of(walls), {LightSettings{}});
    return render_medium(shot, Medium{}, progress, &surroundings);
}

TEST(LightPictures, FilesHoldAllLightsAndTheirFlux) {
    Listener listener;
    const RenderedFrame frame = render(shot_of_box(), listener, rough_metal());
    EXPECT_TRUE(listener.warnings.empty());
    ASSERT_TRUE(frame.light_pictures);
    const TemporaryFolder folder;
    const LightPictureFiles files = light_picture_files(folder / "a.0001.exr", true);
    std::vector<fs::path> written;
    write_light_pictures(*frame.light_pictures, files, frame.metadata, 0.0f, ViewTransform::Filmic,
                         [&](const fs::path& file) { written.push_back(file); });
    std::vector<std::string> names = folder.names();
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names, (std::vector<std::string>{"a.0001.virtual_lights.count.png", "a.0001.virtual_lights.exr",
                                               "a.0001.virtual_lights.path_length.png", "a.0001.virtual_lights.ply",
                                               "a.0001.virtual_lights.png", "a.0001.virtual_lights.profiles.exr",
                                               "a.0001.virtual_lights.profiles.png"}));
    EXPECT_EQ(written.size(), names.size());

    std::size_t vertices = 0;
    auto ply = read_ply(files.ply, vertices);
    const auto stage = std::find_if(frame.statistics.stages.begin(), frame.statistics.stages.end(),
                                    [](const StageCost& s) { return s.name == "virtual lights"; });
    EXPECT_EQ(vertices, stage->detail["lights"].get<std::size_t>());
    EXPECT_GT(vertices, 100u);
    int c = 0;
    for (const char* name : {"flux_r", "flux_g", "flux_b"}) {
        double sum = 0.0;
        for (const double flux : ply[name])
            sum += flux;
        const double reported = stage->detail["reflected_watts"][static_cast<std::size_t>(c++)].get<double>();
        EXPECT_GT(sum, 0.0);
        EXPECT_NEAR(sum, reported, 1e-4 * reported);
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        EXPECT_NEAR(std::hypot(ply["nx"][v], ply["ny"][v], ply["nz"][v]), 1.0, 1e-5);
        EXPECT_NEAR(ply["nx"][v] * ply["tx"][v] + ply["ny"][v] * ply["ty"][v] + ply["nz"][v] * ply["tz"][v], 0, 1e-5);
        // On a wall.
        EXPECT_NEAR(std::max({std::abs(ply["x"][v]), std::abs(ply["y"][v]), std::abs(ply["z"][v])}), 1.0, 1e-5);
        EXPECT_EQ(ply["profile"][v], double(v));
    }
    const Image back = read_exr(files.exr);
    EXPECT_EQ(back.layer("light").pixels, frame.light_pictures->image.layer("light").pixels);
}

TEST(LightPictures, DoNotChangeTheFrame) {
    Listener listener;
    Shot shot = shot_of_box();
    const RenderedFrame with_pictures = render(shot, listener);
    shot.output.virtual_lights = false;
    const RenderedFrame plain = render(shot, listener);
    EXPECT_FALSE(plain.light_pictures);
    ASSERT_EQ(with_pictures.image.layers.size(), plain.image.layers.size());
    for (std::size_t l = 0; l < plain.image.layers.size(); ++l)
        EXPECT_EQ(with_pictures.image.layers[l].pixels, plain.image.layers[l].pixels) << plain.image.layers[l].name;
}

TEST(LightPictures, PathsHaveOneVertexWithoutExtensionAndMoreWithIt) {
    Listener listener;
    Shot shot = shot_of_box();
    shot.virtual_lights.count = 2000;
    shot.virtual_lights.radius = LightRadius::Uniform;
    shot.virtual_lights.radius_factor = 2.5;  // no gaps between the lights
    shot.virtual_lights.path_extension = false;
    const RenderedFrame plain = render(shot, listener);
    for (const float length : plain.light_pictures->image.layer("path_length").pixels)
        ASSERT_EQ(length, 1.0f);
    shot.virtual_lights.path_extension = true;
    const RenderedFrame extended = render(shot, listener);
    double sum = 0.0;
    for (const float length : extended.light_pictures->image.layer("path_length").pixels) {
        ASSERT_GE(length, 1.0f);
        sum += length;
    }
    EXPECT_GT(sum, 1.05 * kWidth * kHeight);
}

TEST(LightPictures, WhatHasNoneSaysWhy) {
    const auto warning_of = [](const std::function<void(Shot&)>& change) {
        Shot shot = shot_of_box();
        change(shot);
        Listener listener;
        EXPECT_FALSE(render(shot, listener).light_pictures);
        EXPECT_EQ(listener.warnings.size(), 1u) << (listener.warnings.empty() ? "" : listener.warnings.back());
        return listener.warnings.empty() ? "" : listener.warnings.front();
    };
    const auto path = warning_of([](Shot& shot) {
        shot.method = RenderMethod::Path;
        shot.tracing.samples = 2;
    });
    EXPECT_NE(path.find("method path"), std::string::npos) << path;
    const auto count = warning_of([](Shot& shot) { shot.virtual_lights.count = 0; });
    EXPECT_NE(count.find("virtual_lights.count is 0"), std::string::npos) << count;
    const auto photons = warning_of([](Shot& shot) { shot.virtual_lights.photons = 0; });
    EXPECT_NE(photons.find("virtual_lights.photons is 0"), std::string::npos) << photons;
    const auto bounces = warning_of([](Shot& shot) { shot.scattering.bounces = 1; });
    EXPECT_NE(bounces.find("scattering.bounces"), std::string::npos) << bounces;
    // Outside the box and turned away from it.
    const auto away = warning_of([](Shot& shot) { shot.camera = LitBox::camera_settings({0, 0, 50}, {0.1, 0.1, 60}); });
    EXPECT_NE(away.find("none was placed"), std::string::npos) << away;

    Listener listener;
    const Medium fire = make_medium(glowing_ball(8, 3.0f));
    EXPECT_FALSE(render_medium(shot_of_box(), fire, listener).light_pictures);
    ASSERT_EQ(listener.warnings.size(), 1u);
    EXPECT_NE(listener.warnings.front().find("no surfaces"), std::string::npos) << listener.warnings.front();
}

// Frame by frame, file by file: what is there is whole.
TEST(LightPictures, FilesThatHaveNoPlaceAreAbsent) {
    Listener listener;
    const RenderedFrame frame = render(shot_of_box(), listener);
    const TemporaryFolder folder;
    const auto write = [&](const LightPictureFiles& files) {
        write_light_pictures(*frame.light_pictures, files, frame.metadata, 0.0f, ViewTransform::Srgb,
                             [](const fs::path&) {});
    };
    try {
        write(light_picture_files(folder / "absent" / "a.exr", true));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::CannotCreate);
    }
    EXPECT_TRUE(folder.names().empty());
    fs::create_directory(folder / "a.virtual_lights.exr");  // no room for the second
    EXPECT_THROW(write(light_picture_files(folder / "a.exr", true)), Error);
    EXPECT_EQ(folder.names().size(), 2u);
    std::size_t vertices = 0;
    read_ply(folder / "a.virtual_lights.ply", vertices);
    EXPECT_EQ(vertices, frame.light_pictures->lights.size());
}

}  // namespace
}  // namespace brisance
