// The table of keys: ranges and types hold for every key, in the code as in the schema.

#include "shot/keys/keys.h"
#include "shot/renamed_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "shot/write_shot.h"
#include "shot_errors.h"

namespace brisance {
namespace {

using testing::message_of_overrides;
using testing::with;

TEST(Keys, HaveDistinctNamesKnownSectionsAndHelp) {
    std::set<std::string> names;
    for (const Key& key : shot_keys()) {
        EXPECT_TRUE(names.insert(key.path).second) << key.path;
        EXPECT_FALSE(key.help.empty()) << key.path;
        EXPECT_FALSE(key.expected.empty()) << key.path;
        const std::size_t point = key.path.rfind('.');
        if (point != std::string::npos) {
            const std::string section = key.path.substr(0, point);
            EXPECT_TRUE(std::any_of(shot_sections().begin(), shot_sections().end(), [&](const auto& known) {
                return known.first == section;
            })) << key.path;
        }
    }
}

TEST(Keys, RefuseEveryOtherTypeAndLeaveTheShotAlone) {
    const std::vector<Json> samples = {nullptr,       true, -7777777777.0, "no such word", Json::array({"a"}),
                                       Json::object()};
    for (const Key& key : shot_keys()) {
        int accepted = 0;
        for (const Json& sample : samples) {
            Shot shot;
            if (key.set(shot, sample))
                ++accepted;
            else
                EXPECT_EQ(to_json(shot), to_json(Shot{})) << key.path << " " << sample.dump();
        }
        EXPECT_LE(accepted, 2) << key.path;  // text, and null beside it for grids
    }
}

TEST(Keys, TellWhatWasGivenAndWhatIsExpected) {
    EXPECT_EQ(message_of_overrides({"smoke.albedo=1.5"}),
              "--set smoke.albedo=1.5: smoke.albedo: expected a number in [0, 1] or three of them [r, g, b], got 1.5 "
              "(a number)");
    EXPECT_EQ(message_of_overrides({"smoke.mean_cosine=1"}),
              "--set smoke.mean_cosine=1: smoke.mean_cosine: expected a number in (-1, 1), got 1 (a number)");
    EXPECT_EQ(message_of_overrides({"lighting.shadows=soft"}),
              "--set lighting.shadows=soft: lighting.shadows: expected one of \"maps\", \"exact\", \"none\", got "
              "\"soft\" (text)");
    EXPECT_EQ(message_of_overrides({"output.png=1"}),
              "--set output.png=1: output.png: expected true or false, got 1 (a number)");
    EXPECT_EQ(message_of_overrides({"lighting.levels=many"}),
              "--set lighting.levels=many: lighting.levels: expected \"auto\" or a whole number in [1, 24], got "
              "\"many\" (text)");
}

TEST(Keys, ValuesOutOfBoundsAreRefused) {
    const std::vector<std::string> wrong = {
        "smoke.extinction_per_metre=-1",
        "smoke.albedo=-0.1",
        "smoke.albedo=[0.5,0.5]",
        "smoke.albedo=[0.5,0.5,1.01]",
        "smoke.mean_cosine=-1",
        "fire.strength=-1",
        "fire.strength=1e39",
        "fire.colour=-1",
        "fire.ramp=[[1,1],[1,1]]",
        "fire.ramp=[[0,-1]]",
        "fire.ramp=[[0]]",
        "fire.temperature_kelvin=[-1,5]",
        "camera.vertical_fov_degrees=0",
        "camera.width=0",
        "camera.vertical_fov_degrees=180",
        "camera.width=20000",
        "camera.height=7.5",
        "camera.samples_per_axis=0",
        "camera.edge_refinement=0",
        "camera.filter_width_pixels=0",
        "camera.up=[0,1]",
        "lighting.alpha=0.9",
        "lighting.levels=0",
        "lighting.shadow_resolution=1",
        "lighting.memory_limit_mebibytes=0",
        "scattering.bounces=-1",
        "scattering.remainder=0",
        "scattering.remainder=1",
        "scattering.lattice_level=-1",
        "scattering.escape=-0.1",
        "scattering.escape=1.1",
        "scattering.alpha=0",
        "scattering.solver=cascades",
        "scattering.cascade_side=1",
        "scattering.cascade_side=33",
        "scattering.cascade_side=auto",
        "scattering.flux_limiter=2",
        "output.exposure_stops=1000",
        "output.frames_per_second=0",
        "certify.samples=1023",
        "certify.seed=-1",
        "tracing.seed=-1",
        "tracing.seed=1.5",
        "volume.file=",
        "colour_role=smoke",
    };
    for (const std::string& setting : wrong)
        EXPECT_NE(message_of_overrides({setting}), "") << setting;
}

TEST(Keys, ValuesAtTheBoundsAreAccepted) {
    const std::vector<std::string> right = {
        "smoke.extinction_per_metre=0",
        "smoke.albedo=0",
        "smoke.albedo=1",
        "smoke.mean_cosine=-0.999",
        "fire.ramp=[]",
        "camera.width=16384",
        "camera.width=640.0",
        "lighting.alpha=1",
        "certify.samples=1024",
        "tracing.seed=1073741824",
        "lighting.levels=auto",
        "scattering.bounces=0",
        "scattering.bounces=all",
        "scattering.lattice_level=0",
        "scattering.escape=0",
        "scattering.escape=auto",
        "scattering.solver=hierarchy",
        "scattering.solver=radiance_cascades",
        "scattering.solver=diffusion",
        "scattering.flux_limiter=false",
        "scattering.cascade_side=2",
        "scattering.cascade_side=32",
        "output.exposure_stops=auto",
        "volume.preset=auto",
        "volume.preset=automatic",
        "$schema=x.json",
    };
    for (const std::string& setting : right)
        EXPECT_EQ(message_of_overrides({setting}), "") << setting;
}

// Diffusion solves for all bounces together.
TEST(Keys, DiffusionRefusesANumberOfBounces) {
    EXPECT_NE(message_of_overrides({"scattering.solver=diffusion", "scattering.bounces=3"}), "");
    EXPECT_EQ(message_of_overrides({"scattering.solver=diffusion", "scattering.bounces=2"}), "");
    EXPECT_EQ(message_of_overrides({"scattering.solver=hierarchy", "scattering.bounces=3"}), "");
}

// Nobody has to guess what an old key has become.
TEST(Keys, OldNamesAreErrorsThatNameTheNew) {
    const std::vector<std::pair<std::string, std::string>> renamed = {
        {"point_lights.paths=9", "point_lights.paths is now called volumetric_vpls.paths"},
        {"particles.neighbours=9", "particles.neighbours is now called volumetric_photons.neighbours"},
        {"particles={}", "particles is now called volumetric_photons"},
        {"ray_lights.shrink=0.5", "ray_lights.shrink is now called ray_lights.radius_reduction"},
        {"virtual_lights.extension=false", "virtual_lights.extension is now called virtual_lights.path_extension"},
        {"scattering.method=point_lights", "is now called \"volumetric_vpls\""},
        {"scattering.method=particles", "is now called \"volumetric_photons\""},
        {"lighting.gather=cache", "lighting.gather is no longer there"}};
    for (const auto& [setting, message] : renamed)
        EXPECT_NE(message_of_overrides({setting}).find(message), std::string::npos) << message_of_overrides({setting});
}

// Where the error says to go there is something to find.
TEST(Keys, NewNamesOfOldKeysAreKnown) {
    for (const Key& key : shot_keys())
        EXPECT_FALSE(renamed_key(key.path)) << key.path;
    EXPECT_EQ(message_of_overrides({"volumetric_vpls.paths=9", "volumetric_photons.neighbours=9",
                                    "ray_lights.radius_reduction=0.5", "virtual_lights.path_extension=false",
                                    "scattering.method=volumetric_vpls"}),
              "");
}

TEST(Keys, FloatsAreWrittenAsTheyWereMeant) {
    const std::string json = to_json(with({"smoke.albedo=0.1", "scattering.remainder=0.0001"}));
    EXPECT_NE(json.find("\"albedo\": [0.1, 0.1, 0.1]"), std::string::npos) << json;
    EXPECT_NE(json.find("\"remainder\": 0.0001,"), std::string::npos) << json;
}

}  // namespace
}  // namespace brisance
