// Haze is lit by the same stages and looks the same, whether the shot calls it a box or a file has its voxels.
#include <gtest/gtest.h>

#include "make_vdb.h"
#include "render/input/load_medium.h"
#include "same_picture.h"
#include "temp_folder.h"

namespace brisance::test_box_and_file {
namespace {

using namespace testing;

constexpr double kVoxel = 1.0 / 6.0;
constexpr int kHalfWidth = 11;  // voxels
constexpr float kError = LightingSettings{}.error;

TestGrid grid_of(const std::string& name, const NodeScalar& value) {
    TestGrid grid;
    grid.name = name;
    grid.world_from_index = cubic(kVoxel);
    grid.voxels = fill_box(ivec3(-kHalfWidth), ivec3(kHalfWidth), [&](const ivec3& n) { return double(value(n)); });
    return grid;
}

TestGrid haze() {
    return grid_of("density", [](const ivec3&) { return 1.0f; });
}

TestGrid fire() {
    return grid_of("flame", fire_in_haze().volumes.front().flame);
}

FurtherVolume haze_box() {
    FurtherVolume volume;
    volume.volume.box = FogBox{dvec3(-kHalfWidth * kVoxel), dvec3(kHalfWidth * kVoxel), kVoxel};
    return volume;
}

FurtherVolume further_file(const std::filesystem::path& file) {
    FurtherVolume volume;
    volume.volume.file = file.string();
    return volume;
}

LitPicture light_files(Shot shot, const std::filesystem::path& file, const std::vector<FurtherVolume>& further) {
    shot.volume.file = file.string();
    shot.volumes = further;
    Progress silent;
    Statistics unused;
    const Medium medium = load_medium(shot, file, 1, unused, silent);
    LitPicture out{render_frame(shot, file, 1, silent), {}};
    out.mechanism = mechanism_of(out.frame.statistics, medium);
    return out;
}

TEST(BoxAndFile, AroundAFireAreTheSame) {
    const TempFolder folder;
    write_vdb(folder / "fire.vdb", {fire()});
    write_vdb(folder / "haze.vdb", {haze()});
    write_vdb(folder / "both.vdb", {haze(), fire()});
    const Shot shot = fire_in_haze().shot;
    const std::vector<std::string> cells = {"V", "MV", "MM"};
    const LitPicture box = light_files(shot, folder / "fire.vdb", {haze_box()});
    expect_same_light(box, light_files(shot, folder / "both.vdb", {}), cells, kError, "box, one file");
    expect_same_light(box, light_files(shot, folder / "fire.vdb", {further_file(folder / "haze.vdb")}), cells, kError,
                      "box, two files");
    expect_same_light(box, light(fire_in_haze()), cells, kError, "box, voxels in memory");
}

// The lamp stands beside the haze: within it, its light is finer than voxels.
Shot lamp_beside_haze(float mean_cosine) {
    Shot shot = fire_in_haze().shot;
    shot.medium.fire.model = FireModel::None;
    shot.medium.smoke.mean_cosine = mean_cosine;
    LightSettings lamp;
    lamp.position = {-3.0, 1.0, 1.5};
    lamp.power = Rgb(10.0f);
    shot.scene.lights = {lamp};
    return shot;
}

void expect_same_by_lamp(float mean_cosine) {
    const TempFolder folder;
    write_vdb(folder / "haze.vdb", {haze()});
    const Shot shot = lamp_beside_haze(mean_cosine);
    expect_same_light(light_files(shot, {}, {haze_box()}), light_files(shot, folder / "haze.vdb", {}), {"MA", "MM"},
                      kError, "lamp, g = " + std::to_string(mean_cosine).substr(0, 3));
}

TEST(BoxAndFile, BesideALampAreTheSame) {
    expect_same_by_lamp(0.0f);
}

TEST(BoxAndFile, OfForwardScatteringHazeAreTheSame) {
    expect_same_by_lamp(0.5f);
}

TEST(BoxAndFile, OfSharplyScatteringHazeAreTheSame) {
    expect_same_by_lamp(0.8f);
}

}  // namespace
}  // namespace brisance::test_box_and_file
