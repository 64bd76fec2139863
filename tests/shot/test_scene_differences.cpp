// Shots that have the same true picture, however it is computed.

#include "shot/scene_differences.h"

#include <gtest/gtest.h>

#include "shot/keys/keys.h"
#include "shot/write_shot.h"
#include "shot_errors.h"

namespace brisance {
namespace {

using testing::with;
using Lines = std::vector<std::string>;

Lines differences(const std::vector<std::string>& a, const std::vector<std::string>& b) {
    return scene_differences(to_json(with(a)), to_json(with(b)));
}

TEST(SceneDifferences, OfAShotFromItselfAreNone) {
    const std::vector<std::string> unusual = {"smoke.albedo=[0.1,0.2,0.3]", "camera.eye=[1,2,3]",
                                              "camera.target=[0,0,0]", "fire.ramp=[[0,0],[1.5,[1,0.5,0.25]]]",
                                              "volume.grids.flame=null"};
    EXPECT_EQ(differences(unusual, unusual), Lines{});
}

TEST(SceneDifferences, NameTheKeyAndBothValues) {
    EXPECT_EQ(differences({"smoke.mean_cosine=0.4"}, {}), Lines{"smoke.mean_cosine: 0.4 against 0.0"});
    EXPECT_EQ(differences({"smoke.albedo=0.5"}, {"smoke.albedo=[0.5,0.25,0.5]"}),
              Lines{"smoke.albedo: [0.5, 0.5, 0.5] against [0.5, 0.25, 0.5]"});
    EXPECT_EQ(differences({"scattering.bounces=1"}, {}), Lines{"scattering.bounces: 1 against \"all\""});
}

TEST(SceneDifferences, AllAreTold) {
    EXPECT_EQ(differences({"camera.width=64", "fire.strength=2", "camera.filter=gaussian"}, {}).size(), 3u);
}

TEST(SceneDifferences, AreNotInTheMethodNorInWhatIsWritten) {
    EXPECT_EQ(differences({"name=other",
                           "lighting.alpha=3",
                           "lighting.shadows=exact",
                           "scattering.remainder=0.1",
                           "scattering.alpha=4",
                           "scattering.method=ray_lights",
                           "ray_lights.samples=9",
                           "ray_lights.sampling=tabulated",
                           "ray_lights.length=long",
                           "ray_lights.radius=auto",
                           "ray_lights.passes=3",
                           "ray_lights.radius_reduction=0.5",
                           "volumetric_vpls.paths=9",
                           "volumetric_vpls.count=9",
                           "volumetric_vpls.samples=9",
                           "volumetric_vpls.bound_per_metre2=3",
                           "volumetric_vpls.compensation=local",
                           "volumetric_vpls.compensation_samples=2",
                           "volumetric_vpls.seed=5",
                           "volumetric_photons.paths=9",
                           "volumetric_photons.neighbours=9",
                           "volumetric_photons.seed=5",
                           "photon_density.estimator=point_beam",
                           "photon_density.paths=9",
                           "photon_density.radius=0.3",
                           "photon_density.passes=3",
                           "photon_density.alpha=0.5",
                           "photon_density.neighbours=9",
                           "photon_density.seed=5",
                           "camera.samples_per_axis=2",
                           "camera.edge_refinement=2",
                           "output.png=false",
                           "output.layers.bounces=true",
                           "output.virtual_lights=true",
                           "output.exposure_stops=1",
                           "$schema=x.json"},
                          {}),
              Lines{});
}

TEST(SceneDifferences, VolumesCountByFileNotByFolder) {
    EXPECT_EQ(differences({"volume.file=../volumes/a.vdb"}, {"volume.file=/data/a.vdb"}), Lines{});
    EXPECT_EQ(differences({"volume.file=../volumes/a.vdb"}, {"volume.file=../volumes/b.vdb"}),
              Lines{"volume.file: \"a.vdb\" against \"b.vdb\""});
}

TEST(SceneDifferences, ACameraThatIsFramedIsNotOneThatIsGiven) {
    EXPECT_EQ(
        differences({"camera.eye=[1,2,3]", "camera.target=[0,0,0]"}, {}),
        (Lines{"camera.eye: [1.0, 2.0, 3.0] against not given", "camera.target: [0.0, 0.0, 0.0] against not given"}));
}

// An image of an older version lacks the keys that came later.
TEST(SceneDifferences, KeysThatOneShotLacksHaveTheirDefaultThere) {
    const std::string older = R"({"volume": {"file": "a.vdb"}})";
    EXPECT_EQ(scene_differences(older, to_json(with({}))), Lines{});
    EXPECT_EQ(scene_differences(older, to_json(with({"camera.width=64"}))).size(), 1u);
}

TEST(SceneDifferences, KeysOfALaterVersionCountByTheirSection) {
    const std::string later = R"({"volume": {"file": "a.vdb"}, "smoke": {"wind": [1, 2]}, "lighting": {"zeal": 3}})";
    EXPECT_EQ(scene_differences(later, to_json(with({}))), Lines{"smoke.wind: [1, 2] against not given"});
    EXPECT_EQ(scene_differences(to_json(with({})), later), Lines{"smoke.wind: not given against [1, 2]"});
    EXPECT_EQ(scene_differences(later, later), Lines{});
}

TEST(SceneDifferences, DamagedShotsAreAnError) {
    for (const char* text : {"", "{", "[]", "3"})
        EXPECT_THROW(scene_differences(text, to_json(with({}))), Error) << text;
}

// A key that is neither would be compared by mistake, or mistaken for the same: decide it here when one is added.
TEST(SceneDifferences, EveryKeyIsOfThePictureOrOfTheMethod) {
    for (const Key& key : shot_keys()) {
        const std::string section = key.path.substr(0, key.path.find('.'));
        const bool picture =
            section == "volume" || section == "volumes" || section == "scene" || section == "smoke" ||
            section == "fire" || section == "time" || section == "velocity" || section == "colour_role" ||
            key.path == "scattering.bounces" ||
            (section == "shutter" && key.path != "shutter.most_moments" && key.path != "shutter.lighting_times") ||
            (section == "camera" && key.path != "camera.samples_per_axis" && key.path != "camera.edge_refinement");
        EXPECT_EQ(key.affects == Affects::Picture, picture) << key.path;
    }
}

}  // namespace
}  // namespace brisance
