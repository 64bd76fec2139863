// The cell SS by virtual lights against the path tracer's, region by region.
#include <gtest/gtest.h>

#include <functional>

#include "room.h"

namespace brisance {
namespace {

using namespace testing;

constexpr std::uint64_t kInSmoke = 64;  // samples per batch: paths in smoke take long

// A picture of 4 x 4 regions, luminance.
constexpr int kRegions = 16;

int region_of(double x, double y) {
    return static_cast<int>(y * 4.0) * 4 + static_cast<int>(x * 4.0);
}

using Look = std::function<Rgb(double x, double y, Rng& rng)>;

// `allowed`: relative, of each region, and of the whole, besides four standard errors. Regions that are black for both
// agree.
void expect_same(const Look& ours_look, const Look& theirs_look, double allowed, double allowed_mean,
                 std::uint64_t per_batch) {
    const auto regions = [&](const Look& look) {
        return estimate(kRegions + 1, per_batch, [&](const dvec3& u, Rng& rng, double* out) {
            std::fill(out, out + kRegions + 1, 0.0);
            out[kRegions] = luminance(look(u.x, u.y, rng));
            out[region_of(u.x, u.y)] = kRegions * out[kRegions];
        });
    };
    const Estimate ours = regions(ours_look), theirs = regions(theirs_look);
    for (int r = 0; r <= kRegions; ++r)
        EXPECT_NEAR(ours.mean[r], theirs.mean[r],
                    (r < kRegions ? allowed : allowed_mean) * theirs.mean[r] +
                        kSigmas * std::hypot(ours.error[r], theirs.error[r]))
            << (r < kRegions ? "region " + std::to_string(r) : "mean");
    EXPECT_GT(theirs.mean[kRegions], 0.0);
}

void expect_regions(const Room& room, const VirtualLightSettings& settings, double allowed, double allowed_mean,
                    std::uint64_t per_batch = 256) {
    const VirtualLights lights = room.lights(settings);
    expect_same([&](double x, double y, Rng& rng) { return room.by_lights(lights, x, y, rng); },
                [&](double x, double y, Rng& rng) { return room.by_paths(x, y, rng); }, allowed, allowed_mean,
                per_batch);
}

VirtualLightSettings some_lights() {
    VirtualLightSettings settings;
    settings.count = 2000;
    settings.photons = 300000;
    return settings;
}

TEST(AgainstPaths, InADiffuseRoom) {
    expect_regions(Room(coloured_room()), some_lights(), 0.03, 0.01);
}

TEST(AgainstPaths, WithoutExtension) {
    VirtualLightSettings settings = some_lights();
    settings.path_extension = false;
    expect_regions(Room(coloured_room()), settings, 0.06, 0.02);
}

TEST(AgainstPaths, WithAGlossyFloorAndAMirror) {
    SceneSettings scene = coloured_room();
    scene.quads[2].material = rough_metal(Rgb(0.9f, 0.7f, 0.4f), 0.4f);
    scene.quads[4].material = rough_metal(Rgb(0.9f), 0.0f);
    expect_regions(Room(scene), some_lights(), 0.04, 0.02);
}

TEST(AgainstPaths, ByEnvironmentAndPointLight) {
    SceneSettings scene = coloured_room();
    scene.quads.erase(scene.quads.begin() + 3);  // the ceiling
    scene.quads.pop_back();                      // and the lamp
    LightSettings sky;
    sky.kind = LightKind::Environment;
    sky.power = Rgb(0.5f, 0.7f, 1.0f);
    LightSettings bulb;
    bulb.position = {0.5, 0.5, 0.3};
    scene.lights = {sky, bulb};
    expect_regions(Room(scene), some_lights(), 0.03, 0.015);
}

TEST(AgainstPaths, PlacedByLightPaths) {
    VirtualLightSettings settings = some_lights();
    settings.placement = "light_paths";
    expect_regions(Room(coloured_room()), settings, 0.03, 0.015);
}

// Balls of fixed area overlap edges, and points lose what their bound takes: near the truth, no more.
TEST(AgainstPaths, BallsAndPointsComeNear) {
    VirtualLightSettings settings = some_lights();
    settings.path_extension = false;
    settings.sampling = "light_tree";
    settings.kind = "sphere";
    expect_regions(Room(coloured_room()), settings, 0.3, 0.08);
    settings.kind = "point";
    expect_regions(Room(coloured_room()), settings, 0.3, 0.08);
}

// A fire in scattering smoke lights a room without a lamp: photons, candidates and extended paths go through smoke.
TEST(AgainstPaths, ByFireInSmoke) {
    SceneSettings scene = coloured_room();
    scene.quads.pop_back();
    const Room room(scene, smoke_ball({0.3, 0.3, -0.2}, 3.0f, Rgb(0.7f, 0.6f, 0.5f), 5.0f));
    expect_regions(room, some_lights(), 0.04, 0.015, kInSmoke);
    const VirtualLights lights = room.lights(some_lights());
    EXPECT_EQ(lights.report().photons.from_fire, lights.report().photons.photons);
    EXPECT_NEAR(lights.report().photons.emitted / room.direct.fire().power(), 1.0, 0.05);
    expect_same([&](double x, double y, Rng& rng) { return room.in_smoke_by_lights(lights, x, y, rng); },
                [&](double x, double y, Rng& rng) { return room.by_paths(x, y, rng, Cell::MS); }, 0.04, 0.015,
                kInSmoke);
}

TEST(AgainstPaths, OfSmokeUnderALamp) {
    const Room room(coloured_room(), smoke_ball({0.3, 0.3, -0.2}, 4.0f, Rgb(0.9f), 0.0f));
    expect_regions(room, some_lights(), 0.04, 0.015, kInSmoke);
    const VirtualLights lights = room.lights(some_lights());
    expect_same([&](double x, double y, Rng& rng) { return room.in_smoke_by_lights(lights, x, y, rng); },
                [&](double x, double y, Rng& rng) { return room.by_paths(x, y, rng, Cell::MS); }, 0.04, 0.015,
                kInSmoke);
}

}  // namespace
}  // namespace brisance
