// Placements that ask what the camera sees of a light.
#include <gtest/gtest.h>

#include <functional>

#include "room.h"
#include "virtual_lights/placement/bidirectional.h"
#include "virtual_lights/placement/camera_receivers.h"
#include "virtual_lights/placement/metropolis.h"
#include "virtual_lights/placement/rejection.h"

namespace brisance {
namespace {

using namespace testing;

// Beside the room another one, closed and with a brighter lamp, that nobody sees.
SceneSettings room_beside_another() {
    SceneSettings scene = coloured_room();
    add_walls(scene, dvec3(3.0, -1.0, -1.0), dvec3(5.0, 1.0, 1.0), lambert(Rgb(0.7f)));
    add_lamp(scene, {3.7, 0.0, -0.3}, {4.3, 0.0, 0.3}, 0.95, Rgb(60.0f));
    return scene;
}

VirtualLightSettings placed_by(const std::string& placement) {
    VirtualLightSettings s;
    s.count = 500;
    s.photons = 20000;
    s.placement = placement;
    s.flux = "own";
    s.kind = "point";
    s.sampling = "power";
    s.path_extension = false;
    s.point_bound = 3.0;
    return s;
}

// The standard deviation over sets of lights of the mean of many pixels, all lights at each.
struct OverSets {
    double mean = 0.0, deviation = 0.0;
};
OverSets over_sets(const Room& room, VirtualLightSettings s) {
    constexpr int kSets = 24;
    s.sampling = "all";
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < kSets; ++i) {
        s.seed = static_cast<std::uint32_t>(i);
        const VirtualLights lights = room.lights(s);
        double mean = 0.0;
        for (std::uint64_t k = 0; k < 64; ++k) {
            Rng rng(Stream::Path, k);
            const double x = rng.next_double(), y = rng.next_double();
            mean += luminance(room.by_lights(lights, x, y, rng)) / 64.0;
        }
        sum += mean / kSets;
        squares += mean * mean / kSets;
    }
    return {sum, std::sqrt(squares - sum * sum)};
}

// Four fifths of the photons land next door, and so do their deposits: those are rejected, and their place is
// taken by lights that serve the picture.
TEST(Rejection, LeavesOutWhatNobodySees) {
    const Room room(room_beside_another());
    const VirtualLights plain = room.lights(placed_by("light_paths")), kept = room.lights(placed_by("rejection"));
    const auto next_door = [](const VirtualLights& lights) {
        const auto& all = lights.lights();
        return double(std::count_if(all.begin(), all.end(), [](const VirtualLight& l) { return l.position.x > 2.0; })) /
               double(all.size());
    };
    EXPECT_GT(next_door(plain), 0.5);
    EXPECT_LT(next_door(kept), 0.3);
    EXPECT_LT(kept.report().acceptance, 0.4);
    EXPECT_GT(kept.report().acceptance, 0.02);
    EXPECT_EQ(plain.report().acceptance, 1.0);
    EXPECT_NEAR(double(kept.lights().size()), 500.0, 150.0);
}

TEST(Importance, MakesSetsOfLightsAgree) {
    const Room room(room_beside_another());
    const OverSets plain = over_sets(room, placed_by("light_paths"));
    for (const char* placement : {"rejection", "metropolis"}) {
        const OverSets by_importance = over_sets(room, placed_by(placement));
        EXPECT_LT(by_importance.deviation, 0.7 * plain.deviation) << placement;
        EXPECT_NEAR(by_importance.mean, plain.mean,
                    kSigmas * std::hypot(by_importance.deviation, plain.deviation) / std::sqrt(24.0))
            << placement;
    }
}

// The spread of what lights bring to the camera, over their mean.
double spread_of(const Room& room, const std::function<PhotonArrivals(const PlacementInput&)>& place,
                 const std::string& placement) {
    const VirtualLightSettings s = placed_by(placement);
    const PixelCamera camera = room.camera();
    PlacementReport report;
    const PlacementInput input{room.direct, std::span(&camera, 1), s, report};
    const CameraReceivers receivers(input);
    double sum = 0.0, squares = 0.0;
    const std::vector<Deposit> lights = place(input).arrivals;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        double mean = 0.0;
        for (std::uint64_t k = 0; k < 64; ++k) {
            Rng rng(Stream::Points, i, k);
            mean += receivers.contribution(lights[i], rng) / 64.0;
        }
        sum += mean / double(lights.size());
        squares += mean * mean / double(lights.size());
    }
    return std::sqrt(squares - sum * sum) / sum;
}

// Photons bring little or much to the camera; of those that were mutated most bring about the same.
TEST(Metropolis, LightsBringEqualPowerToTheCamera) {
    const Room room(room_beside_another());
    EXPECT_LT(spread_of(room, metropolis_flux, "metropolis"), 0.6 * spread_of(room, light_path_flux, "light_paths"));
}

// The deposits of a camera in a dark closed room, and a lamp outside of it.
TEST(Importance, BehindWallsIsBlack) {
    SceneSettings scene;
    add_walls(scene, dvec3(-1.0), dvec3(1.0), lambert(Rgb(0.7f)));
    add_walls(scene, dvec3(3.0, -1.0, -1.0), dvec3(5.0, 1.0, 1.0), lambert(Rgb(0.7f)));
    add_lamp(scene, {3.7, 0.0, -0.3}, {4.3, 0.0, 0.3}, 0.95, Rgb(20.0f));
    const Room room(scene);
    for (const char* placement : {"rejection", "metropolis", "bidirectional"}) {
        VirtualLightSettings s = placed_by(placement);
        if (s.placement == "bidirectional")
            s.flux = "gathered";
        const VirtualLights lights = room.lights(s);
        EXPECT_FALSE(lights.lights().empty()) << placement;
        Rng rng(Stream::Path, 0);
        EXPECT_EQ(room.by_lights(lights, 0.5, 0.5, rng), Rgb(0.0f)) << placement;
    }
}

// Light arrives on the floor of this room alone, and so do the lights: half of the candidates come from either side.
TEST(Bidirectional, LiesWhereLightIsAndIsSeen) {
    const Room room(room_beside_another());
    VirtualLightSettings s = few_lights();
    const PixelCamera camera = room.camera();
    PlacementReport report;
    const std::vector<Deposit> deposits = bidirectional_deposits({room.direct, std::span(&camera, 1), s, report});
    EXPECT_NEAR(double(deposits.size()), double(s.count), 2.0);
    const auto unseen =
        std::count_if(deposits.begin(), deposits.end(), [](const Deposit& d) { return d.position.x > 2.0f; });
    EXPECT_LT(double(unseen), 0.15 * s.count);
    EXPECT_LT(report.acceptance, 0.5);
}

TEST(Survival, IsAsGeorgievAndSlusallekSay) {
    EXPECT_DOUBLE_EQ(survival_probability(0.5, 2.0, 0.1), 0.35);
    EXPECT_DOUBLE_EQ(survival_probability(0.0, 2.0, 0.1), 0.1);
    EXPECT_DOUBLE_EQ(survival_probability(5.0, 2.0, 0.1), 1.0);
    EXPECT_DOUBLE_EQ(survival_probability(0.0, 0.0, 0.1), 1.0);
}

}  // namespace
}  // namespace brisance
