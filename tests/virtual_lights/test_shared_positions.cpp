// Lights at positions that several frames share.
#include <gtest/gtest.h>

#include "room.h"

namespace brisance {
namespace {

using namespace testing;

std::shared_ptr<const PlacedLights> placed(const Room& room, const VirtualLightSettings& settings) {
    const PixelCamera camera = room.camera();
    return std::make_shared<PlacedLights>(place_lights(room.direct, std::span(&camera, 1), settings));
}

// Two sets of different positions, one of which fades.
VirtualLights two_sets(const Room& room, const VirtualLightSettings& settings, double share) {
    VirtualLightSettings other = settings;
    other.seed = settings.seed + 1;
    const std::vector<SharedPositions> sets = {{placed(room, settings), 1.0 - share, 0},
                                               {placed(room, other), share, 1}};
    return VirtualLights(room.direct, room.camera(), settings, sets);
}

TEST(SharedPositions, OfTheFrameItselfChangeNoBit) {
    const Room room(coloured_room());
    const VirtualLightSettings settings = few_lights();
    const std::vector<SharedPositions> own = {{placed(room, settings)}};
    const VirtualLights shared(room.direct, room.camera(), settings, own), alone = room.lights(settings);
    ASSERT_EQ(shared.lights().size(), alone.lights().size());
    for (std::size_t i = 0; i < alone.lights().size(); ++i) {
        EXPECT_EQ(shared.lights()[i].position, alone.lights()[i].position);
        EXPECT_EQ(shared.lights()[i].area, alone.lights()[i].area);
        EXPECT_EQ(shared.lights()[i].irradiance, alone.lights()[i].irradiance);
    }
}

TEST(SharedPositions, GoThroughBytes) {
    const Room room(coloured_room());
    const std::shared_ptr<const PlacedLights> lights = placed(room, few_lights());
    const std::string bytes = to_bytes(*lights);
    const std::optional<PlacedLights> back = placed_lights_of(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(to_bytes(*back), bytes);
    EXPECT_GT(back->deposits.size(), 100u);
    EXPECT_FALSE(placed_lights_of(bytes.substr(0, bytes.size() - 1)));
    EXPECT_FALSE(placed_lights_of(""));
}

// Paths of two cameras: the room's own, and one that sees nothing. Half of the candidates are left.
TEST(SharedPositions, AreThoseOfAllCameras) {
    const Room room(coloured_room());
    const PixelCamera away{64, 64, [](double, double) { return Ray{dvec3(0.0, 0.0, 50.0), dvec3(0.0, 0.0, 1.0)}; }};
    const std::vector<PixelCamera> cameras = {room.camera(), away};
    const PlacedLights both = place_lights(room.direct, cameras, few_lights());
    const double alone = double(placed(room, few_lights())->candidates);
    EXPECT_NEAR(double(both.candidates), 0.5 * alone, 5.0 * std::sqrt(alone));
}

// Weights of sets that fade sum up to 1 as those of one do: a constant comes back as a constant.
TEST(SharedPositions, ReflectAConstantWhileTheyFade) {
    constexpr float albedo = 0.5f;
    SceneSettings scene;
    QuickMaterial material = lambert(Rgb(albedo));
    material.emission = Rgb(1.0f);
    add_walls(scene, dvec3(-1.0), dvec3(1.0), material);
    const Room room(scene);
    VirtualLightSettings settings;
    settings.count = 400;
    settings.photons = 100000;
    settings.path_extension = false;
    for (const double share : {0.03, 0.5}) {
        const VirtualLights lights = two_sets(room, settings, share);
        const Estimate e = estimate(
            1, 64, [&](const dvec3& u, Rng& rng, double* out) { out[0] = room.by_lights(lights, u.x, u.y, rng).x; });
        const double expected = albedo * albedo / (1.0 - albedo);
        EXPECT_NEAR(e.mean[0] / expected, 1.0, 0.01 + kSigmas * e.error[0] / expected) << share;
    }
}

// Of the surface that both sets cover, a set whose share goes to 0 covers a part that goes to 0 with it. What it covers
// alone stays its own until it is gone, and then paths continue there: little (docs/limits.md).
TEST(SharedPositions, FadeContinuously) {
    const Room room(coloured_room());
    const auto area_of_second = [&](double share) {
        const VirtualLights lights = two_sets(room, few_lights(), share);
        double area = 0.0;
        for (const VirtualLight& light : lights.lights())
            area += light.number >> 32 == 1 ? light.area : 0.0;
        return area;
    };
    const double half = area_of_second(0.5), alone = area_of_second(1e-6);
    EXPECT_LT(alone / half, 0.03);
    EXPECT_NEAR((area_of_second(0.05) - alone) / (half - alone), 0.1, 0.05);
    EXPECT_NEAR((area_of_second(0.001) - alone) / (half - alone), 0.002, 0.002);
}

TEST(SharedPositions, AgreeWithPathsWhileTheyFade) {
    const Room room(coloured_room());
    const VirtualLights lights = two_sets(room, few_lights(), 0.4);
    const Estimate e = estimate(2, 128, [&](const dvec3& u, Rng& rng, double* out) {
        out[0] = room.by_lights(lights, u.x, u.y, rng).y;
        out[1] = room.by_paths(u.x, u.y, rng).y;
    });
    EXPECT_NEAR(e.mean[0], e.mean[1], kSigmas * std::hypot(e.error[0], e.error[1]));
}

}  // namespace
}  // namespace brisance
