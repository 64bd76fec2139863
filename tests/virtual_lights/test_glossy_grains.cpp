// What a glossy surface focuses on a matt one beside it is found without bright grains, however few photons the lights
// of the glossy surface have; and automatic numbers of photons.
#include <gtest/gtest.h>

#include "room.h"

namespace brisance {
namespace {

using namespace testing;

// A matt plinth under a ball of rough copper, in a matt room whose lamp is small.
SceneSettings ball_on_plinth() {
    SceneSettings scene;
    add_walls(scene, dvec3(-1.0), dvec3(1.0), lambert(Rgb(0.6f)));
    add_block(scene, {-0.3, -1.0, -0.5}, {0.3, -0.4, 0.1}, lambert(Rgb(0.8f)));
    add_lamp(scene, {0.5, 0.0, -0.4}, {0.6, 0.0, -0.3}, 0.9, Rgb(300.0f));
    QuickSphere ball;
    ball.centre = {0.0, -0.15, -0.2};
    ball.radius = 0.25;
    ball.material = rough_metal(Rgb(0.95f, 0.64f, 0.4f), 0.25f);
    scene.spheres.push_back(ball);
    return scene;
}

// A point of the picture where the plinth is seen, close to where the ball stands on it.
glm::dvec2 on_plinth(const dvec3& u) {
    const double z = -0.12 + 0.04 * u.y, across = 0.2 * (u.x - 0.5), distance = 1.6 * (0.98 - z);
    return {0.5 + across / distance, 0.5 + 0.4 / distance};
}

VirtualLightSettings few_photons(std::uint32_t seed) {
    VirtualLightSettings settings = few_lights();
    settings.count = 1500;
    settings.photons = 1000;
    settings.seed = seed;
    return settings;
}

// Mean of luminance and of its square there, over several sets of lights or by paths.
struct Moments {
    double mean = 0.0, mean_error = 0.0, square = 0.0;
};

Moments by_lights(const Room& room, int sets, std::uint64_t per_batch) {
    Moments out;
    std::vector<double> means;
    for (int set = 0; set < sets; ++set) {
        const VirtualLights lights = room.lights(few_photons(std::uint32_t(set)));
        const Estimate e = estimate(2, per_batch, [&](const dvec3& u, Rng& rng, double* x) {
            const glm::dvec2 p = on_plinth(u);
            x[0] = luminance(room.by_lights(lights, p.x, p.y, rng));
            x[1] = x[0] * x[0];
        });
        means.push_back(e.mean[0]);
        out.mean += e.mean[0] / sets;
        out.square += e.mean[1] / sets;
    }
    for (const double mean : means)
        out.mean_error += (mean - out.mean) * (mean - out.mean);
    out.mean_error = std::sqrt(out.mean_error / (sets - 1) / sets);
    return out;
}

Moments by_paths(const Room& room, std::uint64_t per_batch) {
    const Estimate e = estimate(2, per_batch, [&](const dvec3& u, Rng& rng, double* x) {
        const glm::dvec2 p = on_plinth(u);
        x[0] = luminance(room.by_paths(p.x, p.y, rng));
        x[1] = x[0] * x[0];
    });
    return {e.mean[0], e.error[0], e.mean[1]};
}

// One sample by virtual lights varies less than a path; and over sets of lights, each with its own photons, the mean is
// that of paths to four standard errors and 1 %, what lights blur.
TEST(GlossyGrains, AreNotLeftOnAPlinthUnderABall) {
    const Room room(ball_on_plinth());
    const Moments lights = by_lights(room, 24, 16), paths = by_paths(room, 512);
    EXPECT_LT(lights.square / (lights.mean * lights.mean), 2.5);
    EXPECT_GT(paths.square / (paths.mean * paths.mean), 4.0);
    EXPECT_NEAR(lights.mean, paths.mean, 0.02 * paths.mean + kSigmas * std::hypot(lights.mean_error, paths.mean_error));
}

// As the key says: four times the photons for half of the error, no more than four for each sample of the picture but
// for eight for each light, and never more than eight million.
TEST(AutomaticPhotons, FollowThePicture) {
    const Room room(coloured_room());
    const auto traced = [&](double error, double samples) {
        VirtualLightSettings settings = few_lights();
        settings.count = 2000;
        settings.photons = kAutomaticPhotons;
        settings.picture_error = error;
        PixelCamera camera = room.camera();
        camera.samples = samples;
        return VirtualLights(room.direct, camera, settings).report();
    };
    const VirtualLightReport coarse = traced(0.04, 1e9), fine = traced(0.02, 1e9), small = traced(0.02, 10000.0),
                             tiny = traced(0.02, 100.0), exact = traced(1e-4, 1e9);
    EXPECT_NEAR(double(fine.photons.photons) / double(coarse.photons.photons), 4.0, 0.001);
    // Noise of half of the error in 40 lights of a footprint.
    EXPECT_NEAR(double(fine.photons.arrivals) / double(fine.lights), 4.0 / (40.0 * 0.02 * 0.02), 0.05 * 250.0);
    EXPECT_NEAR(double(small.photons.arrivals), 40000.0, 0.05 * 40000.0);
    EXPECT_EQ(tiny.photons.photons, 16384u);  // as the pilot; eight for each light take less
    EXPECT_EQ(exact.photons.photons, std::uint64_t(kMostAutomaticPhotons));
    EXPECT_EQ(most_automatic_photons(10000.0), 1000000u);
    EXPECT_EQ(most_automatic_photons(250000.0), 4000000u);
}

}  // namespace
}  // namespace brisance
