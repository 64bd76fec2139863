// Reading a shot: layers, positions in the file, and error messages that say what to do.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "shot/nearest_key.h"
#include "shot/write_shot.h"
#include "shot_errors.h"

namespace brisance {
namespace {

using testing::error_message;
using testing::message_of_overrides;
using testing::parsed;
using testing::with;

TEST(ReadShot, FurtherVolumesSayWhatIsOtherThanTheShot) {
    const Shot shot = parsed(R"({
        "volume": {"file": "burst.vdb", "up": "z"},
        "smoke": {"extinction_per_metre": 20, "albedo": 0.5, "mean_cosine": 0.2},
        "volumes": [{"file": "dust_####.vdb", "albedo": 0.9, "fire_model": "none", "grids": {"density": "dust"},
                     "world_from_file": [1, 0, 0, 7, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]
    })");
    EXPECT_EQ(shot.volume.up, 'z');
    ASSERT_EQ(shot.volumes.size(), 1u);
    const FurtherVolume& dust = shot.volumes[0];
    EXPECT_EQ(dust.volume.file, "dust_####.vdb");
    EXPECT_EQ(dust.volume.up, 'y');
    EXPECT_EQ(dust.volume.grids.density, "dust");
    EXPECT_EQ(dvec3(dust.volume.world_from_file[3]), dvec3(7, 0, 0));
    const MediumSettings look = changed(shot.medium, dust.changes);
    EXPECT_EQ(look.smoke.albedo, Rgb(0.9f));
    EXPECT_EQ(look.smoke.extinction_per_metre, 20.0f);
    EXPECT_EQ(look.fire.model, FireModel::None);
    EXPECT_EQ(parsed(to_json(shot)).volumes[0].changes.albedo, Rgb(0.9f)) << "survives writing";
}

TEST(ReadShot, DeepNestingIsAnError) {
    const std::string deep(100000, '[');
    EXPECT_EQ(error_message(deep), "a.json:1: nested more than 256 levels deep; a shot needs six");
    EXPECT_NE(error_message("{\"smoke\":" + std::string(300, '[') + std::string(300, ']') + "}").find("nested more"),
              std::string::npos);
    std::string objects;
    for (int i = 0; i < 100000; ++i)
        objects += "{\"a\":";
    EXPECT_NE(error_message(objects).find("nested more"), std::string::npos);
    EXPECT_NE(message_of_overrides({"smoke.albedo=" + std::string(100000, '[') + std::string(100000, ']')}), "");
}

// Each would take minutes if a path were joined, or compared with all keys, for each of them.
TEST(ReadShot, LongKeysAndManyKeysTakeNoTime) {
    const std::string message = error_message("{\"" + std::string(4000000, 'k') + "\": 1}");
    EXPECT_LT(message.size(), 300u);
    std::string many = "{\"" + std::string(1000000, 'k') + "\": {";
    for (int i = 0; i < 100000; ++i)
        many.append("\"").append(std::to_string(i)).append("\": 0, ");
    EXPECT_NE(error_message(many + "\"last\": 0}}").find("more than 10000 keys"), std::string::npos);
}

TEST(ReadShot, AKeyThatIsGivenTwiceWithinAListIsAnError) {
    EXPECT_EQ(error_message("{\"scene\": {\"lights\": [\n{\"kind\": \"point\",\n\"kind\": \"sun\"}]}}"),
              "a.json:3: scene.lights.kind is given twice; it was given first on line 2");
    EXPECT_EQ(error_message(R"({"volume": {"file": "a.vdb"}, "scene": {"lights": [{"kind": "point", "power": 1},
                                                                              {"kind": "sun", "power": 1}]}})"),
              "");
}

TEST(ReadShot, WhatSinglePrecisionCannotSumIsOutOfRange) {
    for (const char* const setting :
         {"fire.strength=1e36", "fire.colour=1e7", "fire.colour=[0,0,1e38]", "smoke.extinction_per_metre=3.4e38",
          "fire.ramp=[[0,[1e38,0,0]]]", "fire.temperature_kelvin=[0,1e38]", "camera.eye=[1e38,0,0]",
          "scene.lights=[{\"kind\":\"point\",\"power\":1e38}]",
          "scene.spheres=[{\"centre\":[0,0,0],\"radius\":1,\"emission\":1e38}]"}) {
        const std::string message = message_of_overrides({setting});
        const std::string key = std::string(setting).substr(0, std::string(setting).find('='));
        EXPECT_NE(message.find(key), std::string::npos) << setting << ": " << message;
        EXPECT_NE(message.find("in ["), std::string::npos) << setting << ": " << message;
    }
    EXPECT_EQ(message_of_overrides({"fire.strength=1e20", "smoke.extinction_per_metre=1e20"}), "");
}

TEST(ReadShot, ForeignTextInAMessageIsPrintable) {
    for (const char* const setting :
         {"fire.ramp=[[0,[1,0,0]z],[1,[~\xff\xff\xff\x99", "method=\xff", "fire.ramp=[\"\xff\"]"})
        EXPECT_NE(message_of_overrides({setting}).find("expected"), std::string::npos) << setting;
    EXPECT_EQ(error_message("{\"smo\xff\\nke\": 1}").find('\n'), std::string::npos);
    const std::string message = error_message("{\"smoke\": {\"alb\\u001b[31mdo\": 1}}");
    EXPECT_EQ(message.find('\x1b'), std::string::npos) << message;
}

TEST(ReadShot, EveryKindOfValueArrives) {
    const Shot shot = parsed(R"({
        // a comment
        "name": "burst",
        "volume": {"file": "burst_####.vdb", "preset": "embergen", "half_voxel_shift": true,
                   "grids": {"density": "density[1]", "temperature": "", "flame": null}},  /* another */
        "smoke": {"extinction_per_metre": 20, "albedo": [0.9, 0.8, 0.7], "mean_cosine": -0.3},
        "fire": {"model": "blackbody", "convention": "direct", "strength": 2.5, "threshold": 0.25, "colour": 0.5,
                 "ramp": [[0, [1, 0, 0]], [2.5, [1, 1, 0.5]]], "modulate_by_flame": true,
                 "temperature_in": [0, 3], "temperature_kelvin": [300, 2500]},
        "colour_role": "emission",
        "camera": {"eye": [1, 2, 3], "target": [0, 0, 0.5], "up": [0, 1, 0], "vertical_fov_degrees": 50.5,
                   "width": 640, "height": 480, "samples_per_axis": 4, "filter": "gaussian",
                   "filter_width_pixels": 2},
        "lighting": {"alpha": 3, "levels": 5, "shadows": "exact", "shadow_resolution": 32, "shadow_distances": 12,
                     "memory_limit_mebibytes": 512, "energy_balance": false},
        "scattering": {"bounces": 4, "remainder": 0.01, "lattice_level": 1, "alpha": 2},
        "output": {"path": "x.exr", "png": false, "statistics": false, "layers": {"cells": false, "bounces": true},
                   "exposure_stops": -1.5, "view": "srgb", "frames_per_second": 24}
    })");
    EXPECT_EQ(shot.name, "burst");
    EXPECT_EQ(shot.folder, "folder");
    EXPECT_EQ(shot.volume.file, "burst_####.vdb");
    EXPECT_EQ(shot.volume.preset, MappingPreset::EmberGen);
    EXPECT_EQ(shot.volume.grids.density, "density[1]");
    EXPECT_EQ(shot.volume.grids.temperature, "");
    EXPECT_FALSE(shot.volume.grids.flame.has_value());
    EXPECT_FALSE(shot.volume.grids.colour.has_value());
    EXPECT_TRUE(shot.volume.half_voxel_shift);
    EXPECT_EQ(shot.medium.smoke.extinction_per_metre, 20.0f);
    EXPECT_EQ(shot.medium.smoke.albedo, Rgb(0.9f, 0.8f, 0.7f));
    EXPECT_EQ(shot.medium.smoke.mean_cosine, -0.3f);
    EXPECT_EQ(shot.medium.fire.model, FireModel::Blackbody);
    EXPECT_EQ(shot.medium.fire.convention, EmissionConvention::Direct);
    EXPECT_EQ(shot.medium.fire.threshold, 0.25f);
    EXPECT_EQ(shot.medium.fire.colour, Rgb(0.5f));
    ASSERT_EQ(shot.medium.fire.ramp.size(), 2u);
    EXPECT_EQ(shot.medium.fire.ramp[1].value, 2.5f);
    EXPECT_EQ(shot.medium.fire.ramp[1].colour, Rgb(1.0f, 1.0f, 0.5f));
    EXPECT_EQ(shot.medium.fire.temperature_kelvin, vec2(300.0f, 2500.0f));
    EXPECT_EQ(shot.medium.colour_role, ColourRole::Emission);
    EXPECT_TRUE(shot.camera_given);
    EXPECT_EQ(shot.camera.target, dvec3(0.0, 0.0, 0.5));
    EXPECT_EQ(shot.camera.vertical_fov_degrees, 50.5);
    EXPECT_EQ(shot.camera.samples_per_axis, 4);
    EXPECT_EQ(shot.camera.filter, PixelFilter::Gaussian);
    EXPECT_EQ(shot.lighting.levels, 5);
    EXPECT_EQ(shot.lighting.shadows, ShadowMethod::Exact);
    EXPECT_EQ(shot.lighting.memory_limit_bytes, std::uint64_t{512} << 20);
    EXPECT_FALSE(shot.lighting.energy_balance);
    EXPECT_EQ(shot.scattering.bounces, 4);
    EXPECT_EQ(shot.scattering.lattice_level, 1);
    EXPECT_TRUE(shot.output.bounce_layers);
    EXPECT_TRUE(shot.exposure_given);
    EXPECT_EQ(shot.output.exposure_stops, -1.5f);
    EXPECT_EQ(shot.output.view, ViewTransform::Srgb);
    EXPECT_EQ(shot.output.frames_per_second, 24.0);
}

TEST(ReadShot, WhatIsNotGivenKeepsItsDefault) {
    const Shot shot = with({});
    const Shot defaults;
    EXPECT_EQ(shot.lighting.alpha, defaults.lighting.alpha);
    EXPECT_EQ(shot.scattering.bounces, -1);
    EXPECT_EQ(shot.camera.samples_per_axis, 0);
    EXPECT_FALSE(shot.camera_given);
    EXPECT_FALSE(shot.exposure_given);
}

TEST(ReadShot, SizeAndAngleAloneLeaveTheCameraFramed) {
    EXPECT_FALSE(with({"camera.width=320", "camera.up=[0,1,0]", "camera.vertical_fov_degrees=20"}).camera_given);
    EXPECT_TRUE(with({"camera.world_from_camera=[1,0,0,4, 0,1,0,5, 0,0,1,6, 0,0,0,1]"}).camera_given);
}

TEST(ReadShot, MatrixIsReadRowAfterRow) {
    const Shot shot = with({"camera.world_from_camera=[1,0,0,4, 0,0,-1,5, 0,1,0,6, 0,0,0,1]"});
    const dmat4 m = *shot.camera.world_from_camera;
    EXPECT_EQ(dvec3(m[3]), dvec3(4.0, 5.0, 6.0));
    EXPECT_EQ(dvec3(m * glm::dvec4(0, 0, -1, 0)), dvec3(0.0, 1.0, 0.0));  // looks along world +y
}

TEST(ReadShot, LaterLayersWin) {
    const std::string file = R"({"volume": {"file": "a.vdb"}, "lighting": {"alpha": 4, "levels": 3}})";
    EXPECT_EQ(parsed(file).lighting.alpha, 4.0f);
    EXPECT_EQ(parsed(file, {"final", {}}).lighting.alpha, 4.0f);
    const Shot draft = parsed(file, {"draft", {}});
    EXPECT_LT(draft.lighting.alpha, 4.0f);
    EXPECT_GT(draft.lighting.error, LightingSettings{}.error);
    EXPECT_EQ(draft.lighting.levels, 3);
    EXPECT_EQ(parsed(file, {"draft", {"lighting.alpha=5", "lighting.alpha=6"}}).lighting.alpha, 6.0f);
}

TEST(ReadShot, OverridesMayBeWholeSectionsOrPlainText) {
    const Shot shot = with({R"(smoke={"albedo": 0.5, "mean_cosine": 0.25})", "name=2024", "volume.grids.flame=fire",
                            "volume.grids.density=null", "output.path=a=b.exr"});
    EXPECT_EQ(shot.medium.smoke.albedo, Rgb(0.5f));
    EXPECT_EQ(shot.medium.smoke.mean_cosine, 0.25f);
    EXPECT_EQ(shot.name, "2024");
    EXPECT_EQ(shot.volume.grids.flame, "fire");
    EXPECT_FALSE(shot.volume.grids.density.has_value());
    EXPECT_EQ(shot.output.path, "a=b.exr");
}

TEST(ReadShot, UnknownKeysNameTheNearest) {
    EXPECT_EQ(error_message("{\"volume\": {\"file\": \"a.vdb\"},\n \"smoke\": {\n  \"albdo\": 0.9}}"),
              "a.json:3: unknown key smoke.albdo; did you mean smoke.albedo?");
    EXPECT_EQ(error_message(R"({"colour_rôle": "albedo"})"),
              "a.json:1: unknown key colour_rôle; did you mean colour_role?");
    EXPECT_EQ(message_of_overrides({"albedo=1"}), "--set albedo=1: unknown key albedo; did you mean smoke.albedo?");
    EXPECT_EQ(message_of_overrides({"lighting.bounces=1"}),
              "--set lighting.bounces=1: unknown key lighting.bounces; did you mean scattering.bounces?");
    EXPECT_EQ(message_of_overrides({"smoek.albedo=1"}),
              "--set smoek.albedo=1: unknown key smoek.albedo; did you mean smoke.albedo?");
    EXPECT_EQ(message_of_overrides({"ligting={}"}), "--set ligting={}: unknown key ligting; did you mean lighting?");
    EXPECT_NE(message_of_overrides({"smoke.albedo.r=1"}), "");
}

TEST(ReadShot, MistakesInTheTextNameTheLine) {
    EXPECT_EQ(error_message("{\n \"smoke\": {\"albedo\": 1,\n\n \"albedo\": 0}}"),
              "a.json:4: smoke.albedo is given twice; it was given first on line 2");
    EXPECT_TRUE(error_message("{\n\"name\": \"a\",\n}").starts_with("a.json:3: syntax error"));
    EXPECT_TRUE(error_message("{\n\"name\" \"a\"}").starts_with("a.json:2: syntax error"));
    EXPECT_TRUE(error_message("").starts_with("a.json:1: syntax error"));
    EXPECT_TRUE(error_message("{\"name\": \"\xff\"}").starts_with("a.json:1: "));
    EXPECT_EQ(error_message("[]"), "a.json: a shot: expected an object in braces, got [] (a list)");
    EXPECT_EQ(error_message("{\n\"smoke\": 3}"), "a.json:2: smoke: expected an object in braces, got 3 (a number)");
    EXPECT_NE(message_of_overrides({"nonsense"}), "");
    EXPECT_NE(message_of_overrides({"=3"}), "");
}

TEST(ReadShot, ContradictionsAreFound) {
    EXPECT_NE(message_of_overrides({"camera.eye=[1,2,3]"}), "");
    EXPECT_NE(message_of_overrides({"camera.target=[1,2,3]"}), "");
    EXPECT_NE(message_of_overrides({"camera.eye=[1,2,3]", "camera.target=[1,2,3]"}), "");
    EXPECT_NE(message_of_overrides({"camera.eye=[0,0,9]", "camera.target=[0,0,0]"}), "");  // along up
    EXPECT_EQ(message_of_overrides({"camera.eye=[0,0,9]", "camera.target=[0,0,0]", "camera.up=[0,1,0]"}), "");
    EXPECT_NE(message_of_overrides({"camera.up=[0,0,0]"}), "");
    const std::string rigid = "camera.world_from_camera=[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]";
    EXPECT_EQ(message_of_overrides({rigid}), "");
    EXPECT_NE(message_of_overrides({rigid, "camera.eye=[1,0,0]", "camera.target=[0,0,0]"}), "");
    EXPECT_NE(message_of_overrides({rigid, "camera.up=[0,1,0]"}), "");
    for (const char* matrix : {"2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1",   // scaled
                               "-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1",  // mirrored
                               "0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,1",   // singular
                               "1,0,0,0, 0,1,0,0, 0,0,1,0, 4,5,6,1"})  // column after column
        EXPECT_NE(message_of_overrides({"camera.world_from_camera=[" + std::string(matrix) + "]"}), "") << matrix;
    EXPECT_NE(message_of_overrides({"fire.temperature_in=[1,1]"}), "");
    EXPECT_NE(message_of_overrides({"fire.modulate_by_flame=true"}), "");
    EXPECT_EQ(message_of_overrides({"fire.modulate_by_flame=true", "fire.model=blackbody"}), "");
}

TEST(ReadShot, RendersWithoutEndAreFound) {
    EXPECT_EQ(
        message_of_overrides({"method=path", "tracing.samples=none"}),
        "--set tracing.samples=none: tracing.samples: is none: the render would never end; give tracing.seconds or "
        "tracing.error");
    for (const char* end : {"tracing.samples=2", "tracing.seconds=1", "tracing.error=0.5", "method=lighting_grid"})
        EXPECT_EQ(message_of_overrides({"method=path", "tracing.samples=none", end}), "") << end;
}

TEST(ReadShot, ScenesAreListsOfThings) {
    const Shot shot = parsed(R"({"scene": {
        "files": [{"file": "street.glb", "up": "z"}],
        "quads": [{"corners": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "colour": 0.3, "emission": [1, 2, 3]}],
        "spheres": [{"centre": [1, 2, 3], "radius": 0.5, "metallic": 1, "roughness": 0.2}],
        "lights": [{"kind": "spot", "position": [0, 0, 4], "power": 10, "outer_degrees": 30, "inner_degrees": 20},
                   {"kind": "environment", "power": 0.1}],
        "frames_per_second": 25}})");
    ASSERT_EQ(shot.scene.files.size(), 1u);
    EXPECT_EQ(shot.scene.files[0].file, "street.glb");
    EXPECT_EQ(shot.scene.files[0].up, 'z');
    ASSERT_EQ(shot.scene.quads.size(), 1u);
    EXPECT_EQ(shot.scene.quads[0].corners[2], dvec3(1, 1, 0));
    EXPECT_EQ(shot.scene.quads[0].material.colour, Rgb(0.3f));
    EXPECT_EQ(shot.scene.quads[0].material.emission, Rgb(1, 2, 3));
    ASSERT_EQ(shot.scene.spheres.size(), 1u);
    EXPECT_EQ(shot.scene.spheres[0].radius, 0.5);
    EXPECT_EQ(shot.scene.spheres[0].material.roughness, 0.2f);
    ASSERT_EQ(shot.scene.lights.size(), 2u);
    EXPECT_EQ(shot.scene.lights[0].kind, LightKind::Spot);
    EXPECT_EQ(shot.scene.lights[0].outer_degrees, 30.0);
    EXPECT_EQ(shot.scene.lights[1].power, Rgb(0.1f));
    EXPECT_EQ(shot.scene.frames_per_second, 25.0);
}

// A long list is no help unless the part that is wrong is named.
TEST(ReadShot, MistakesInListsNameTheirPosition) {
    const auto message_for = [](const std::string& scene) { return error_message(R"({"scene": )" + scene + "}"); };
    EXPECT_EQ(message_for(R"({"spheres": [{"centre": [0, 0, 0], "radius": 1}, {"centre": [0, 0, 0], "radius": -2}]})"),
              "a.json:1: scene.spheres[1].radius: expected a number in (0, 1000000000000000], got -2 (a number)");
    EXPECT_EQ(message_for(R"({"files": [{"file": "a.glb", "upp": "z"}]})"),
              "a.json:1: scene.files[0]: expected keys it knows, such as \"up\", got \"upp\" (text)");
    EXPECT_EQ(message_for(R"({"files": [{"up": "z"}]})"),
              "a.json:1: scene.files[0]: expected \"file\", which is missing: text in quotes that is not empty, got "
              "{\"up\":\"z\"} (an object)");
    EXPECT_EQ(message_for(R"({"lights": [{"kind": "lamp"}]})"),
              "a.json:1: scene.lights[0].kind: expected one of \"point\", \"spot\", \"sun\", \"quad\", "
              "\"environment\", got \"lamp\" (text)");
    EXPECT_EQ(message_for(R"({"quads": {}})"),
              "a.json:1: scene.quads: expected a list of quads [{\"corners\": ...}], got {} (an object)");
}

TEST(ReadShot, VolumesThatCannotBeAreFound) {
    const auto message_for = [](const std::string& v) { return error_message(R"({"volumes": [)" + v + "]}"); };
    EXPECT_EQ(message_for("{}"), "a.json:1: volumes: volume [0] needs either a file or a box");
    EXPECT_EQ(message_for(R"({"file": "a.vdb", "box": {"low": [0, 0, 0], "high": [1, 1, 1]}})"),
              "a.json:1: volumes: volume [0] needs either a file or a box");
    EXPECT_EQ(message_for(R"({"box": {"low": [0, 0, 0], "high": [1, 0, 1]}})"),
              "a.json:1: volumes: volume [0] is a box whose low is not below its high on every axis");
    EXPECT_EQ(message_for(R"({"box": {"low": [0, 0, 0], "high": [1, 1, 1]}, "fire_model": "flame"})"),
              "a.json:1: volumes: volume [0] is a homogeneous box, which cannot emit; remove its fire_model");
    EXPECT_EQ(message_for(R"({"file": "a.vdb", "albdo": 1})"),
              "a.json:1: volumes[0]: expected keys it knows, such as \"albedo\", got \"albdo\" (text)");
}

TEST(ReadShot, LightsThatCannotBeAreFound) {
    const auto message_for = [](const std::string& light) {
        return error_message(R"({"scene": {"lights": [)" + light + "]}}");
    };
    EXPECT_EQ(message_for(R"({"kind": "sun", "direction": [0, 0, 0]})"),
              "a.json:1: scene.lights: light [0] has a direction of no length");
    EXPECT_EQ(message_for(R"({"kind": "spot", "inner_degrees": 50, "outer_degrees": 40})"),
              "a.json:1: scene.lights: light [0] has inner_degrees above outer_degrees");
    EXPECT_EQ(message_for(R"({"kind": "environment"}, {"kind": "environment"})"),
              "a.json:1: scene.lights: light [1] is a second environment; there can be only one");
}

TEST(ReadShot, NothingToRenderIsFound) {
    EXPECT_EQ(error_message("{}"), "a.json: volume.file is missing, and so is a scene: which file to render");
    EXPECT_EQ(error_message(R"({"scene": {"lights": [{"kind": "environment"}]}})"), "");
}

TEST(ReadShot, FilesAreTakenByNameAndFolder) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "brisance-shot-test";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "burst.json") << R"({"volume": {"file": "a.vdb"}})";
    const Shot shot = read_shot(folder / "burst.json");
    std::filesystem::remove_all(folder);
    EXPECT_EQ(shot.name, "burst");
    EXPECT_EQ(shot.folder, folder);
    try {
        read_shot(folder / "burst.json");
        FAIL() << "a file that is not there was read";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::MissingInput);
    }
}

TEST(ReadShot, UnknownPresetsNameTheKnown) {
    EXPECT_NE(error_message(R"({"volume": {"file": "a.vdb"}})", {"drfat", {}}).find("draft and final"),
              std::string::npos);
}

TEST(NearestKey, CountsTheStrokesBetweenTexts) {
    EXPECT_EQ(edit_distance("", ""), 0);
    EXPECT_EQ(edit_distance("abc", ""), 3);
    EXPECT_EQ(edit_distance("albedo", "albdo"), 1);
    EXPECT_EQ(edit_distance("albedo", "abledo"), 1);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

}  // namespace
}  // namespace brisance
