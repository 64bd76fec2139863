// Spots of virtual lights: where on a light its photons have landed.
#include <gtest/gtest.h>

#include <cmath>

#include "room.h"

namespace brisance {
namespace {

using namespace testing;

constexpr double kHeight = 0.9, kHalfAngle = 4.0;  // of a spot lamp over the floor [m, degrees]

// White walls around thin smoke, and a narrow beam on the middle of the floor.
SceneSettings beam_on_floor() {
    SceneSettings scene;
    add_walls(scene, dvec3(-1.0), dvec3(1.0), lambert(Rgb(0.6f, 0.5f, 0.4f)));
    LightSettings lamp;
    lamp.kind = LightKind::Spot;
    lamp.position = dvec3(0.03, -1.0 + kHeight, -0.02);
    lamp.direction = dvec3(0.0, -1.0, 0.0);
    lamp.inner_degrees = lamp.outer_degrees = kHalfAngle;
    lamp.power = Rgb(40.0f, 30.0f, 20.0f);
    scene.lights.push_back(lamp);
    return scene;
}

VirtualLightSettings for_smoke(int count) {
    VirtualLightSettings settings = few_lights();
    settings.count = count;
    settings.photons = 100000;
    settings.light_smoke = true;
    return settings;
}

// Mean distance of light that leaves the floor from the middle of the beam, weighted by power [m].
double mean_distance(const Room& room, const VirtualLights& lights, bool by_spots) {
    const dvec3 middle = dvec3(0.03, -1.0, -0.02) - room.origin;
    double sum = 0.0, power = 0.0;
    const auto add = [&](const dvec3& position, double watts) {
        if (std::abs(position.y - middle.y) > 1e-3)
            return;
        sum += watts * glm::length(position - middle);
        power += watts;
    };
    for (std::size_t i = 0; i < lights.lights().size(); ++i) {
        const VirtualLight& light = lights.lights()[i];
        if (!by_spots || lights.spots().of(i).empty())
            add(light.position, luminance(light.base_flux));
        else
            for (const FluxSpot& spot : lights.spots().of(i))
                add(position_of(spot, light), luminance(spot.part * light.base_flux));
    }
    return sum / power;
}

// The disc that the beam lights has a radius of 6.3 cm, and lights are four times as wide. Some light comes from walls.
TEST(FluxSpots, LieWherePhotonsLand) {
    const Room room(beam_on_floor(), smoke_ball(dvec3(0.0, -0.7, 0.0), 1e-3f, Rgb(0.5f), 0.0f));
    const VirtualLights lights = room.lights(for_smoke(150));
    const double by_lights = mean_distance(room, lights, false), by_spots = mean_distance(room, lights, true);
    std::printf("mean distance from the beam %.3f m by lights, %.3f m by spots\n", by_lights, by_spots);
    EXPECT_LT(by_spots, 0.6 * by_lights);
    EXPECT_LT(by_spots, 0.12);
}

TEST(FluxSpots, AreAllOfTheirLight) {
    const Room room(beam_on_floor(), smoke_ball(dvec3(0.0, -0.7, 0.0), 1e-3f, Rgb(0.5f), 0.0f));
    const VirtualLights lights = room.lights(for_smoke(150));
    ASSERT_GT(lights.spots().size(), 100u);
    std::size_t divided = 0;
    for (std::size_t i = 0; i < lights.lights().size(); ++i) {
        if (lights.spots().of(i).empty())
            continue;
        ++divided;
        Rgb sum(0.0f);
        for (const FluxSpot& spot : lights.spots().of(i)) {
            sum += spot.part;
            for (const float place : {spot.place.x, spot.place.y}) {
                EXPECT_GE(place, 0.0f);
                EXPECT_LE(place, 1.0f);
            }
        }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c], 1.0f, 1e-4f);
    }
    EXPECT_GT(divided, 10u);
}

// Memory for spots is no more than photons can ask for.
TEST(FluxSpots, AreFewerThanPhotons) {
    const Room room(beam_on_floor(), smoke_ball(dvec3(0.0, -0.7, 0.0), 1e-3f, Rgb(0.5f), 0.0f));
    VirtualLightSettings settings = for_smoke(150);
    const std::size_t many = room.lights(settings).spots().size();
    settings.photons = 1000;
    const std::size_t few = room.lights(settings).spots().size();
    EXPECT_LE(few, std::size_t{1000});
    EXPECT_LT(few, many);
}

// Far smoke sees points, and without smoke to be lit nobody asks.
TEST(FluxSpots, AreNotMadeWhereTheyDoNotShow) {
    const Room room(beam_on_floor(), smoke_ball(dvec3(0.0, -0.7, 0.0), 1e-3f, Rgb(0.5f), 0.0f));
    VirtualLightSettings settings = for_smoke(150);
    settings.light_smoke = false;
    EXPECT_EQ(room.lights(settings).spots().size(), 0u);
    const Room far(beam_on_floor(), smoke_ball(dvec3(0.0, 500.0, 0.0), 1e-3f, Rgb(0.5f), 0.0f));
    EXPECT_EQ(far.lights(for_smoke(150)).spots().size(), 0u);
}

}  // namespace
}  // namespace brisance
