// The cell SS by virtual lights against the path tracer's, region by region.
#include <gtest/gtest.h>

#include "fixtures/media.h"
#include "room.h"

namespace brisance {
namespace {

using namespace testing;

// A picture of 4 x 4 regions, luminance.
constexpr int kRegions = 16;

int region_of(double x, double y) {
    return static_cast<int>(y * 4.0) * 4 + static_cast<int>(x * 4.0);
}

// `allowed`: relative, of each region, besides four standard errors.
void expect_regions(const Room& room, const VirtualLightSettings& settings, double allowed, double allowed_mean) {
    const VirtualLights lights = room.lights(settings);
    const auto regions = [&](const auto& look) {
        return estimate(kRegions + 1, 256, [&](const dvec3& place, Rng& rng, double* out) {
            std::fill(out, out + kRegions + 1, 0.0);
            out[kRegions] = luminance(look(place, rng));
            out[region_of(place.x, place.y)] = kRegions * out[kRegions];
        });
    };
    const Estimate ours = regions([&](const dvec3& p, Rng& rng) { return room.by_lights(lights, p.x, p.y, rng); });
    const Estimate theirs = regions([&](const dvec3& p, Rng& rng) { return room.by_paths(p.x, p.y, rng); });
    for (int r = 0; r <= kRegions; ++r)
        EXPECT_NEAR(ours.mean[r] / theirs.mean[r], 1.0,
                    (r < kRegions ? allowed : allowed_mean) +
                        kSigmas * std::hypot(ours.error[r], theirs.error[r]) / theirs.mean[r])
            << (r < kRegions ? "region " + std::to_string(r) : "mean");
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
    settings.extension = false;
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

}  // namespace
}  // namespace brisance
