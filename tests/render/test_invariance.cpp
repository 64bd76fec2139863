// The lighting depends on what is at each point of space, not on the voxels that say so: pictures of one scene in two
// representations differ by less than the stated error, lighting.error, in every cell, and the same stages light both.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "same_picture.h"

namespace brisance::test_invariance {
namespace {

using namespace testing;

std::vector<SameScene> scenes() {
    return {smoke_ball(0.6f), burst_in_haze(0.0f)};
}

class Invariance : public ::testing::TestWithParam<SameScene> {};

INSTANTIATE_TEST_SUITE_P(Of, Invariance, ::testing::ValuesIn(scenes()),
                         [](const auto& scene) { return scene.param.name; });

// One test, so that the picture that all others are compared with is lit once. Lattices are anchored to the world's
// origin: only a move shifts bricks and the levels of hierarchies. Changes that leave every node's light where it is
// come together, and so do both turns: neither undoes what the other gets wrong.
TEST_P(Invariance, NoOtherVoxelsOfTheSceneChangeThePicture) {
    const SameScene scene = cropped(GetParam());
    const LitPicture picture = light(scene);
    const SameScene more_voxels = padded(scene, {29, 0, 0}, {3, 13, 7});
    const std::pair<const char*, SameScene> others[] = {
        {"29 zeros in -x; 3, 13 and 7 in +x, +y, +z; moved by an eighth of a voxel; split at x = 1",
         split(moved(more_voxels, dvec3(0.125)), 1)},
        {"moved by (3, 5, 7) voxels", moved(scene, {3, 5, 7})},
        {"moved by half a voxel", moved(scene, dvec3(0.5))},
        {"voxels turned about x, transform about z", turned_by_transform(turned(scene))}};
    for (const auto& [what, other] : others)
        expect_same_light(picture, light(other), {"V", "MV", "MM"}, scene.shot.lighting.error,
                          scene.name + ", " + what);
}

class Resampling : public ::testing::TestWithParam<SameScene> {};

INSTANTIATE_TEST_SUITE_P(Of, Resampling, ::testing::Values(smoke_ball(0.0f), smoke_ball(0.6f), fire_in_haze()),
                         [](const auto& scene) { return scene.param.name; });

TEST_P(Resampling, HalfTheVoxelsEdgeChangesNothing) {
    expect_same_picture(GetParam(), finer(GetParam()), "voxels of half the edge");
}

// Seven eighths of the volume are smoke then that nobody can see, of an optical depth of a millionth per metre.
SameScene among_invisible_smoke(const SameScene& scene) {
    const NodeBox box = scene.volumes.front().box;
    const ivec3 more((box.high.x - box.low.x) / 2);
    SameScene out = padded(scene, more, more);
    for (Recipe& r : out.volumes)
        r.density = [density = r.density, invisible = 1e-6f / r.settings.smoke.extinction_per_metre](const ivec3& n) {
            return std::max(density(n), invisible);
        };
    return out;
}

// Whether lights are made for receivers outside, and on which lattice the series is solved, goes by what is seen.
TEST(InvisibleSmoke, ChangesNeitherThePictureNorWhatLightsIt) {
    for (const SameScene& scene : {smoke_ball(0.0f), burst_in_veil()}) {
        const LitPicture picture = light(scene), among = light(among_invisible_smoke(scene));
        expect_near_light(picture, among, {"V", "MV", "MM"}, 0.5 * scene.shot.lighting.error,
                          scene.name + ", among invisible smoke");
        EXPECT_EQ(picture.mechanism.haze_nodes.empty(), among.mechanism.haze_nodes.empty()) << scene.name;
    }
}

// What haze shows of a burst came through its skin, and the lights that stand for the skin are those of the voxels:
// the error is the one that the limits state, and which levels light the haze depends on the voxels.
TEST(ResamplingOfHaze, HalfTheVoxelsEdgeStaysWithinTheLimit) {
    constexpr double kLimit = 0.08;
    for (const SameScene& scene : {burst_in_haze(0.0f), burst_in_veil()})
        expect_near_light(light(scene), light(finer(scene)), {"V", "MV", "MM"}, kLimit, scene.name);
}

}  // namespace
}  // namespace brisance::test_invariance
