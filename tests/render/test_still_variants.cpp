// A still that is moved with its camera, or whose box is larger, shows the same picture.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "fixtures/correlation.h"
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
    shot.correction.samples = 0;  // by lights alone
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

// Two walls and a floor under a lamp with an area.
Shot lit_corner() {
    Shot shot;
    const auto quad = [](const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
        QuickQuad made;
        made.corners = {a, b, c, d};
        made.material.colour = Rgb(0.6f);
        return made;
    };
    shot.scene.quads = {quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}),
                        quad({-1, 1, 0}, {1, 1, 0}, {1, 1, 2}, {-1, 1, 2}),
                        quad({-1, -1, 0}, {-1, 1, 0}, {-1, 1, 2}, {-1, -1, 2})};
    LightSettings lamp;
    lamp.kind = LightKind::Quad;
    lamp.corners = {dvec3(0, 0, 1.9), dvec3(0, 0.8, 1.9), dvec3(0.8, 0.8, 1.9), dvec3(0.8, 0, 1.9)};
    shot.scene.lights = {lamp};
    shot.camera_given = true;
    shot.camera.eye = {2.5, -2.5, 1.5};
    shot.camera.target = {-0.2, 0.2, 0.7};
    shot.camera.width = 32;
    shot.camera.height = 24;
    shot.camera.samples_per_axis = 1;
    shot.certify.belief = 0.0;
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights.count = 300;
    shot.virtual_lights.photons = 20000;
    shot.virtual_lights.sharing_radius = 0.0;  // its blur is the same with all seeds
    return shot;
}

// Error bars of repeats and the flicker of film strips rest on it. Deviations from the mean of 12 other pictures have a
// correlation of 1/13 by that mean's own noise. Of 500 pixels that see something, 0.25 more is five standard
// deviations.
TEST(StillVariants, ReseededShareNoNoise) {
    const Shot shot = lit_corner();
    Progress silent;
    const auto image = [&](int by) { return render_frame(by ? reseeded(shot, by) : shot, {}, 1, silent).image; };
    const Image one = image(0), other = image(1);
    for (const char* const cell : {"SS", "SA"}) {
        const Picture first = picture_of(one, {cell}).picture, second = picture_of(other, {cell}).picture;
        Picture mean = first;
        mean.pixels.assign(mean.pixels.size(), Rgb(0.0f));
        for (int k = 0; k < 12; ++k) {
            const Picture more = picture_of(image(100 + k), {cell}).picture;
            for (std::size_t i = 0; i < mean.pixels.size(); ++i)
                mean.pixels[i] += more.pixels[i] / 12.0f;
        }
        EXPECT_GT(change(mean, first), 0.02) << cell << " has noise";
        EXPECT_NEAR(correlation(first, second, mean), 1.0 / 13.0, 0.25) << cell;
    }
}

TEST(StillVariants, WithoutACameraCannotBeMoved) {
    EXPECT_THROW(moved(Shot{}, dvec3(1.0)), Error);
}

}  // namespace
}  // namespace brisance
