// A still that is moved with its camera, or whose box is larger, shows the same picture.
#include <gtest/gtest.h>

#include "core/error.h"
#include "fixtures/media.h"
#include "make_vdb.h"
#include "metrics/differences.h"
#include "metrics/layers.h"
#include "render/input/frame_input.h"
#include "render/render_frame.h"
#include "render/still_variants.h"
#include "temp_folder.h"

namespace brisance {
namespace {

using namespace testing;

// A fire of twelve voxels over a floor, beside a lamp.
Shot fire_over_floor(const TempFolder& folder) {
    TestGrid grid;
    grid.name = "flame";
    grid.world_from_index = cubic(0.1);
    grid.voxels =
        fill_box(ivec3(-6), ivec3(5), [](const ivec3& n) { return 1.0 - 0.02 * glm::dot(vec3(n), vec3(n)) / 2; });
    TestGrid density = grid;
    density.name = "density";
    write_vdb(folder / "fire.vdb", {grid, density});
    Shot shot;
    shot.volume.file = (folder / "fire.vdb").string();
    shot.medium.smoke.extinction_per_metre = 4.0f;
    shot.medium.fire.model = FireModel::Flame;
    QuickQuad floor;
    floor.corners = {dvec3(-2, -2, -0.8), dvec3(2, -2, -0.8), dvec3(2, 2, -0.8), dvec3(-2, 2, -0.8)};
    shot.scene.quads = {floor};
    LightSettings lamp;
    lamp.position = {1.5, 0.0, 1.5};
    shot.scene.lights = {lamp};
    shot.camera_given = true;
    shot.camera.eye = {0.5, -4.0, 0.5};
    shot.camera.target = {0.0, 0.0, 0.0};
    shot.camera.width = 32;
    shot.camera.height = 24;
    shot.certify.belief = 0.0;
    shot.scattering.bounces = 1;
    shot.virtual_lights.count = 0;
    return shot;
}

Picture rendered(const Shot& shot) {
    Progress silent;
    return picture_of(render_frame(shot, shot.volume.file, 1, silent).image, {""}).picture;
}

double change(const Picture& before, const Picture& after) {
    return measure_differences(after.pixels, before.pixels).rrmse;
}

// Surfaces and lamps are sampled at the same points of the pixel: what moves is all that there is.
TEST(StillVariants, MovedWithTheCameraShowTheSamePicture) {
    const TempFolder folder;
    const Shot shot = fire_over_floor(folder);
    const Picture still = rendered(shot);
    EXPECT_EQ(rendered(shot).pixels, still.pixels);
    const Shot elsewhere = moved(shot, dvec3(0.0125));
    EXPECT_LT(change(still, rendered(elsewhere)), shot.lighting.error);
    Shot left_behind = elsewhere;
    left_behind.camera = shot.camera;
    EXPECT_GT(change(still, rendered(left_behind)), shot.lighting.error);
    left_behind = elsewhere;
    left_behind.scene = shot.scene;
    left_behind.scene.quads[0].corners[0].z -= 0.5;  // a floor that leans is seen to
    EXPECT_GT(change(still, rendered(left_behind)), shot.lighting.error);
}

TEST(StillVariants, WithALargerBoxShowTheSamePicture) {
    const TempFolder folder;
    const Shot shot = fire_over_floor(folder);
    Progress silent;
    Statistics unused;
    const FrameInput input = load_frame(shot, shot.volume.file, 1, unused, silent);
    const Shot larger = padded(shot, input.medium, 9);
    ASSERT_EQ(larger.volumes.size(), 1u);
    EXPECT_LT(larger.volumes[0].volume.box->low.x, -0.6 - 9 * 0.1);
    EXPECT_LT(change(rendered(shot), rendered(larger)), shot.lighting.error);
    // Smoke in the box would be seen.
    Shot smoky = larger;
    smoky.volumes[0].changes.extinction_per_metre = 1.0f;
    EXPECT_GT(change(rendered(shot), rendered(smoky)), shot.lighting.error);
}

TEST(StillVariants, WithoutACameraCannotBeMoved) {
    EXPECT_THROW(moved(Shot{}, dvec3(1.0)), Error);
}

}  // namespace
}  // namespace brisance
