// Pictures that are means over passes of virtual lights.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "fixtures/instant_radiosity.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"

namespace brisance {
namespace {

using namespace testing;

// A floor and a wall beside a fire, lit by few spheres.
struct CornerWithFire {
    CornerWithFire() : medium(smoke_with_fire()), set(floor_and_wall(), {}) {
        shot.camera_given = true;
        shot.camera.eye = {0.3, -5.0, 1.5};
        shot.camera.target = {0.0, 1.0, -1.0};
        shot.camera.vertical_fov_degrees = 40.0;
        shot.camera.width = shot.camera.height = 12;
        shot.camera.samples_per_axis = 2;
        shot.certify.belief = 0.0;
        shot.correction.samples = 0;  // by lights alone
        shot.scattering_methods.method = kLightingGridMethod;
        shot.virtual_lights = instant_radiosity("sphere", 60, 3000);
    }

    static Medium smoke_with_fire() {
        Recipe r = glowing_ball(4, 2.0f);
        r.settings.smoke.albedo = Rgb(0.8f);
        return make_medium(r);
    }
    static Scene floor_and_wall() {
        Scene scene;
        add_quad(scene, {-4, -4, -1.4f}, {8, 0, 0}, {0, 8, 0}, lambert(0.7f));
        add_quad(scene, {-4, 2, -1.4f}, {8, 0, 0}, {0, 0, 4}, lambert(0.6f));
        return scene;
    }
    RenderedFrame rendered(int passes, std::uint32_t seed) const {
        Shot then = shot;
        then.virtual_lights.passes = passes;
        then.virtual_lights.seed = seed;
        Progress silent;
        return render_medium(then, medium, silent, &set);
    }
    // Relative to its mean, over the picture, from two seeds: what SS of a pixel varies by.
    double noise(int passes) const {
        const RenderedFrame one = rendered(passes, 1), other = rendered(passes, 2);
        const std::vector<float>&a = one.image.layer("SS").pixels, &b = other.image.layer("SS").pixels;
        double sum = 0.0, squares = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            sum += 0.5 * (double(a[i]) + b[i]);
            squares += 0.5 * (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
        }
        const double n = double(a.size());
        return std::sqrt(squares / n) / (sum / n);
    }

    Medium medium;
    Surroundings set;
    Shot shot;
};

// Eight passes have lights of their own: an eighth of the variance, and half of the noise is far from chance.
TEST(LightPasses, LowerTheNoise) {
    const CornerWithFire corner;
    const double one = corner.noise(1), eight = corner.noise(8);
    std::printf("noise of one pass %.3g, of eight %.3g\n", one, eight);
    EXPECT_GT(eight, 0.0);
    EXPECT_LT(eight, 0.6 * one);
}

TEST(LightPasses, PlaceTheirLightsAndKeepAllOtherCells) {
    const CornerWithFire corner;
    const RenderedFrame one = corner.rendered(1, 0), three = corner.rendered(3, 0);
    int placed = 0;
    for (const StageCost& stage : three.statistics.stages)
        placed += stage.name.starts_with("virtual lights") ? 1 : 0;
    EXPECT_EQ(placed, 3);
    EXPECT_EQ(three.metadata.samples_per_pixel, 3.0 * one.metadata.samples_per_pixel);
    for (const char* cell : {"V", "MV", "MM", "SV"}) {
        const std::vector<float>&a = one.image.layer(cell).pixels, &b = three.image.layer(cell).pixels;
        for (std::size_t i = 0; i < a.size(); ++i)
            EXPECT_NEAR(b[i], a[i], 1e-5f * std::abs(a[i])) << cell;
    }
}

TEST(LightPasses, AreRefusedWhereTheyMeanNothing) {
    const auto refused = [](auto change, const std::string& word) {
        CornerWithFire corner;
        change(corner.shot);
        try {
            corner.rendered(2, 0);
            ADD_FAILURE() << word;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::Usage);
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    };
    refused([](Shot& s) { s.scattering_methods.method = "ray_lights"; }, "scattering.method=lighting_grid");
    refused([](Shot& s) { s.unified_lights.sampling = "stochastic_lightcuts"; }, "unified_lights.sampling=none");
    refused([](Shot& s) { s.virtual_lights.window = 4; }, "window");
}

}  // namespace
}  // namespace brisance
