// Closed rooms with a known solution, and the balance of the photons' power.
#include <gtest/gtest.h>

#include "room.h"
#include "virtual_lights/bounce_cache.h"

namespace brisance {
namespace {

using namespace testing;

// All walls alike, glowing with radiance 1: what is reflected is albedo / (1 - albedo) everywhere, and arrives as that.
SceneSettings furnace(float albedo) {
    SceneSettings scene;
    QuickMaterial material = lambert(Rgb(albedo));
    material.emission = Rgb(1.0f);
    add_walls(scene, dvec3(-1.0), dvec3(1.0), material);
    return scene;
}

double mean_of(const Room& room, const VirtualLights& lights, double& error) {
    const Estimate e = estimate(
        1, 64, [&](const dvec3& u, Rng& rng, double* out) { out[0] = room.by_lights(lights, u.x, u.y, rng).x; });
    error = e.error[0];
    return e.mean[0];
}

class Furnaces : public ::testing::TestWithParam<std::tuple<float, bool>> {};

// Without extension every ray ends at virtual lights: their interpolation must give back the constant. Photons leave
// 0.3 % of noise.
TEST_P(Furnaces, ReflectWhatTheSeriesSays) {
    const auto [albedo, extension] = GetParam();
    const Room room(furnace(albedo));
    VirtualLightSettings settings;
    settings.count = 400;
    settings.photons = 100000;
    settings.path_extension = extension;
    const VirtualLights lights = room.lights(settings);
    double error = 0.0;
    const double mean = mean_of(room, lights, error), expected = albedo * albedo / (1.0 - albedo);
    EXPECT_NEAR(mean / expected, 1.0, 0.01 + kSigmas * error / expected);
}

INSTANTIATE_TEST_SUITE_P(Of, Furnaces, ::testing::Combine(::testing::Values(0.2f, 0.5f, 0.9f), ::testing::Bool()));

// What lights gather themselves, of the share that they are trusted with, at 256 points that the camera sees. First
// directions are given, as at points that share a pixel.
BounceCache::Found gathered_in(const Room& room, int count) {
    VirtualLightSettings settings = few_lights();
    settings.count = count;
    const VirtualLights lights = room.lights(settings);
    BounceCache cache(lights, 16, 1, [&](const PathVertex& base, std::uint64_t, int path, Rng& rng) {
        const dvec3 numbers{rng.next_double(), (path % 4 + rng.next_double()) / 4.0,
                            (path / 4 + rng.next_double()) / 4.0};
        double distance = 1e9;
        VirtualLights::Shading how;
        how.numbers = &numbers;
        how.distance = &distance;
        return BounceCache::Sample{{lights.shade(base, rng, how), Rgb(0.0f)}, 1.0 / distance};
    });
    BounceCache::Found sum;
    for (int i = 0; i < 256; ++i) {
        const RaySegment segment = room.direct.segment_along(room.ray((i % 16 + 0.5) / 16.0, (i / 16 + 0.5) / 16.0));
        const LightShares at = lights.covering(*segment.hit, *segment.point);
        cache.gather(std::span(at.light.data(), std::size_t(at.count)));
        const BounceCache::Found found = cache.at(at);
        EXPECT_LE(found.share, 1.0f + 1e-5f);
        sum.light.surfaces += found.light.surfaces;
        sum.share += found.share;
    }
    return sum;
}

// The constant comes back whatever the share is, and lights that are small beside their distance to other walls are
// trusted more. A path has a standard deviation of at most what it brings; hundreds of lights gather by 16.
TEST(BounceCaches, GiveBackTheConstantOfTheFurnace) {
    const float albedo = 0.5f;
    const Room room(furnace(albedo));
    const BounceCache::Found coarse = gathered_in(room, 400), fine = gathered_in(room, 2000);
    for (const BounceCache::Found& found : {coarse, fine})
        EXPECT_NEAR(found.light.surfaces.x / found.share / (albedo / (1.0 - albedo)), 1.0,
                    0.01 + kSigmas / std::sqrt(200.0 * 16.0));
    EXPECT_GT(coarse.share, 0.25f * 256.0f);
    EXPECT_GT(fine.share, 1.5f * coarse.share);
}

// Every photon's power is shared out whole, and all arrivals add up to emitted / (1 - albedo) where nothing escapes.
TEST(Photons, ConserveEnergy) {
    const float albedo = 0.6f;
    const Room room(furnace(albedo));
    VirtualLightSettings settings = few_lights();
    const VirtualLights lights = room.lights(settings);
    const PhotonReport& photons = lights.report().photons;
    double stored = 0.0;
    for (const VirtualLight& light : lights.lights())
        stored += luminance(light.irradiance) * light.area;
    EXPECT_EQ(photons.photons, 100000u);
    EXPECT_EQ(photons.escaped, 0.0);
    EXPECT_NEAR(stored / photons.shared, 1.0, 1e-5);
    EXPECT_NEAR(photons.emitted, std::acos(-1.0) * 24.0, 1e-3 * photons.emitted);
    // Hits of a photon: geometric, variance albedo / (1 - albedo)^2.
    const double error = std::sqrt(albedo / 1e5) / (1.0 - albedo);
    EXPECT_NEAR((photons.shared + photons.unshared) / photons.emitted, 1.0 / (1.0 - albedo), kSigmas * error);
    EXPECT_LT(photons.unshared_fraction(), 0.35);  // the front wall, which the camera has at its back
}

// The areas of the lights sum to the area of the surface that they cover.
TEST(Areas, AddUpToTheSurface) {
    SceneSettings scene = furnace(0.5f);
    const Room room(scene);
    VirtualLightSettings settings = few_lights();
    settings.radius = LightRadius::Uniform;
    const VirtualLights lights = room.lights(settings);
    double area = 0.0;
    for (const VirtualLight& light : lights.lights())
        area += light.area;
    Rng rng(Stream::Path, 1);
    int covered = 0;
    constexpr int kPoints = 20000;
    const PartitionOfUnity cover(room.surroundings.intersector(), lights.lights());
    for (int i = 0; i < kPoints; ++i) {
        const int axis = static_cast<int>(rng.next_double() * 3.0);
        dvec3 p(2.0 * rng.next_double() - 1.0, 2.0 * rng.next_double() - 1.0, 2.0 * rng.next_double() - 1.0), n(0.0);
        p[axis] = rng.next() < 0.5f ? -1.0 : 1.0;
        n[axis] = -p[axis];
        const LightShares shares = cover.shares(p, n, lights.lights()[0].scene_material);
        float sum = 0.0f;
        for (int k = 0; k < shares.count; ++k)
            sum += shares.weight[k];
        if (shares.count > 0) {
            EXPECT_NEAR(sum, 1.0f, 1e-5f);
        }
        covered += shares.count > 0;
    }
    // Quads of one material each: those of the material looked up are a sixth of them.
    EXPECT_GT(covered, 0);
    EXPECT_GT(area, 0.6 * 24.0);
    EXPECT_LT(area, 1.02 * 24.0);
}

}  // namespace
}  // namespace brisance
