// Scenes without surfaces or light, and settings that leave nothing to build.
#include <gtest/gtest.h>

#include "core/error.h"
#include "room.h"

namespace brisance {
namespace {

using namespace testing;

bool agrees_with_paths(const Room& room, const VirtualLights& lights) {
    const Estimate e = estimate(2, 128, [&](const dvec3& u, Rng& rng, double* out) {
        out[0] = room.by_lights(lights, u.x, u.y, rng).y;
        out[1] = room.by_paths(u.x, u.y, rng).y;
    });
    return std::abs(e.mean[0] - e.mean[1]) <= kSigmas * std::hypot(e.error[0], e.error[1]) && e.mean[0] > 0.0;
}

TEST(NothingToDo, WithoutSurroundings) {
    const Medium nothing;
    const DirectLight direct(nothing, {}, nullptr);
    const PixelCamera camera{64, 64, [](double, double) { return Ray{dvec3(0.0), dvec3(0.0, 0.0, 1.0)}; }};
    const VirtualLights lights(direct, camera, {});
    Rng rng(Stream::Path, 0);
    EXPECT_EQ(lights.report().candidates, 0u);
    EXPECT_EQ(lights.report().bytes, 0u);
    EXPECT_EQ(lights.shade(PathVertex(dvec3(0.0), dvec3(0, 0, 1), 0.0f), rng), Rgb(0.0f));
}

TEST(NothingToDo, WithoutSurfaces) {
    SceneSettings scene;
    scene.lights.emplace_back();
    const Room room(scene);
    const VirtualLights lights = room.lights({});
    EXPECT_TRUE(lights.lights().empty());
    EXPECT_EQ(lights.report().photons.photons, 0u);
}

TEST(NothingToDo, InTheDark) {
    SceneSettings scene;
    add_walls(scene, dvec3(-1.0), dvec3(1.0), lambert(Rgb(0.5f)));
    const Room room(scene);
    const VirtualLights lights = room.lights({});
    Rng rng(Stream::Path, 0);
    EXPECT_EQ(lights.report().candidates, 0u);
    EXPECT_EQ(room.by_lights(lights, 0.5, 0.5, rng), Rgb(0.0f));
}

// Paths do all of the work.
TEST(NothingToDo, WithoutLightsIsPathTracing) {
    const Room room(coloured_room());
    VirtualLightSettings settings = few_lights();
    settings.count = 0;
    EXPECT_TRUE(agrees_with_paths(room, room.lights(settings)));
    settings.count = 1;
    EXPECT_TRUE(agrees_with_paths(room, room.lights(settings)));
    settings = few_lights();
    settings.photons = 0;
    EXPECT_TRUE(agrees_with_paths(room, room.lights(settings)));
}

TEST(NothingToDo, WhereTheCameraSeesNothing) {
    const Room room(coloured_room());
    const PixelCamera away{64, 64, [](double, double) { return Ray{dvec3(0.0, 0.0, 50.0), dvec3(0.0, 0.0, 1.0)}; }};
    const VirtualLights lights(room.direct, away, few_lights());
    EXPECT_TRUE(lights.lights().empty());
    EXPECT_EQ(lights.report().photons.unshared_fraction(), 1.0);
    EXPECT_TRUE(agrees_with_paths(room, lights));
    const VirtualLights none(room.direct, {0, 0, away.ray}, few_lights());
    EXPECT_TRUE(agrees_with_paths(room, none));
}

// All camera paths find the same point, as a mirror's reflection of a tiny quad: here by a camera of one ray onto it.
TEST(NothingToDo, WhereAllCandidatesAreOnePoint) {
    SceneSettings scene;
    const double e = 1e-7;
    QuickQuad quad;
    quad.material = lambert(Rgb(0.8f));
    quad.corners = {dvec3(-1, -1, -1), dvec3(1, -1, -1), dvec3(1, 1, -1), dvec3(-1, 1, -1)};
    scene.quads.push_back(quad);
    quad.corners = {dvec3(-e, e, 0.9), dvec3(e, e, 0.9), dvec3(e, -e, 0.9), dvec3(-e, -e, 0.9)};
    scene.quads.push_back(quad);
    add_lamp(scene, {-0.3, 0.0, -0.3}, {0.3, 0.0, 0.3}, 0.95, Rgb(10.0f));
    const Room room(scene);
    const VirtualLights lights = room.lights(few_lights());
    Rng rng(Stream::Path, 0);
    const Rgb seen = room.by_lights(lights, 0.5, 0.5, rng);
    EXPECT_TRUE(std::isfinite(seen.x));
}

TEST(Settings, OutOfRangeAreRefused) {
    const Room room(coloured_room());
    const auto refused = [&](auto change) {
        VirtualLightSettings settings = few_lights();
        change(settings);
        EXPECT_THROW(room.lights(settings), Error);
    };
    refused([](VirtualLightSettings& s) { s.count = -1; });
    refused([](VirtualLightSettings& s) { s.photons = -2; });
    refused([](VirtualLightSettings& s) { s.candidates_per_pixel = -1.0; });
    refused([](VirtualLightSettings& s) { s.neighbours = 0; });
    refused([](VirtualLightSettings& s) { s.radius_factor = 0.0; });
    refused([](VirtualLightSettings& s) { s.profile_resolution = 1; });
    refused([](VirtualLightSettings& s) { s.n_max = 1.0; });
    refused([](VirtualLightSettings& s) { s.point_bound = 0.0; });
    refused([](VirtualLightSettings& s) {
        s.kind = "point";
        s.sampling = "power";  // and extension
    });
    refused([](VirtualLightSettings& s) {
        s.kind = "sphere";
        s.path_extension = false;
        s.sampling = "bsdf";
    });
}

}  // namespace
}  // namespace brisance
