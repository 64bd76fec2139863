// Light of the sky on matt surfaces, which pixels share: the same energy, less noise, and shadows of the sun as sharp.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"

namespace brisance {
namespace {

using namespace testing;

const Medium& thin_smoke() {
    static const Medium thin = [] {
        Recipe recipe = glowing_ball(8, 0.02f);
        recipe.settings.smoke.albedo = Rgb(0.8f);
        return make_medium(recipe);
    }();
    return thin;
}

// Paths of a pixel: the mean of all is known well by few of them, its pixels are not.
constexpr int kPathsForMean = 64, kPathsForPixels = 200;

// A floor and a wall that hides a part of the sky from it. `sun`: besides, from the side; its disc is 2 degrees wide.
Surroundings yard(bool sky, bool sun) {
    Scene scene;
    scene.origin = thin_smoke().world_of_local(vec3(0.0f));
    add_quad(scene, {-6, -6, -1}, {12, 0, 0}, {0, 12, 0}, lambert(0.6f));
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, lambert(0.6f));
    std::vector<LightSettings> lights(2);
    lights[0].kind = LightKind::Environment;
    lights[0].power = Rgb(1.0f);
    lights[1].kind = LightKind::Sun;
    lights[1].direction = {0.3, 1.0, -1.0};
    lights[1].angle_degrees = 2.0;
    lights[1].power = Rgb(2.0f);
    if (!sun)
        lights.pop_back();
    if (!sky)
        lights.erase(lights.begin());
    return Surroundings(std::move(scene), std::move(lights));
}

Image picture(const Surroundings& set, double radius, RenderMethod method = RenderMethod::LightingGrid,
              std::uint32_t seed = 0, int paths = kPathsForPixels) {
    Shot shot;
    shot.method = method;
    shot.virtual_lights.seed = seed;
    shot.camera_given = true;
    shot.camera.eye = {0.0, -9.0, 4.0};
    shot.camera.target = {0.0, 0.5, -0.5};
    shot.camera.vertical_fov_degrees = 40.0;
    shot.camera.width = 48;
    shot.camera.height = 36;
    shot.camera.samples_per_axis = 4;
    shot.tracing.samples = paths;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights.count = 500;
    shot.virtual_lights.photons = 50000;
    shot.virtual_lights.sharing_radius = radius;
    Progress silent;
    return render_medium(shot, thin_smoke(), silent, &set).image;
}

struct Compared {
    double bias, rms;  // over the mean
};

Compared compare(const Image& ours, const Image& truth) {
    const std::vector<float>&a = ours.layer("SA").pixels, &b = truth.layer("SA").pixels;
    double bias = 0.0, squares = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += b[i];
        bias += double(a[i]) - b[i];
        squares += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
    }
    return {bias / sum, std::sqrt(squares / double(a.size())) / (sum / double(a.size()))};
}

TEST(SharedSky, HasTheEnergyOfPathsAndLessNoiseThanPixelsAlone) {
    const Surroundings set = yard(true, false);
    const Image truth = picture(set, 0.0, RenderMethod::Path, 0, kPathsForMean);
    double noise[2];
    for (const double radius : {0.0, 0.2}) {
        const Image one = picture(set, radius), other = picture(set, radius, RenderMethod::LightingGrid, 1);
        EXPECT_NEAR(compare(one, truth).bias, 0.0, 0.01);
        noise[radius > 0.0] = compare(one, other).rms;
    }
    std::printf("noise alone %.2f %%, shared %.2f %%\n", 100.0 * noise[0], 100.0 * noise[1]);
    EXPECT_GT(noise[0], 0.0);
    EXPECT_LT(noise[1], 0.5 * noise[0]);
}

TEST(SharedSky, LeavesTheSunToEachPixel) {
    const Surroundings sun = yard(false, true);
    EXPECT_EQ(picture(sun, 0.0).layer("SA").pixels, picture(sun, 0.2).layer("SA").pixels);
    // With a sky about, what the sun adds to the picture is the same with and without sharing, but for noise.
    const Surroundings both = yard(true, true);
    const Compared shared = compare(picture(both, 0.2), picture(both, 0.0, RenderMethod::Path));
    std::printf("sun and sky: %+.2f %%, %.2f %%\n", 100.0 * shared.bias, 100.0 * shared.rms);
    EXPECT_NEAR(shared.bias, 0.0, 0.01);
    EXPECT_LT(shared.rms, 0.08);
}

}  // namespace
}  // namespace brisance
