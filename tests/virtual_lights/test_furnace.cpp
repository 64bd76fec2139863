// Closed rooms with a known solution, and the balance of the photons' power.
#include <gtest/gtest.h>

#include "room.h"

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
