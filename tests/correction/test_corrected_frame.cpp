// Frames by the lighting grid are corrected, with a set or without, and drafts are not.
#include <gtest/gtest.h>

#include <algorithm>

#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/choice/time_budget.h"
#include "render/render_frame.h"

namespace brisance::test_corrected_frame {
namespace {

using namespace testing;

// Voxels of an optical depth of two: the lighting grid errs by some percent.
Medium glow() {
    Recipe r = glowing_ball(8, 30.0f);
    r.settings.smoke.albedo = Rgb(0.8f);
    return make_medium(r);
}

Shot shot_of(float error) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = {0.3, -5.0, 1.5};
    shot.camera.target = {0.0, 0.0, 0.0};
    shot.camera.vertical_fov_degrees = 32.0;
    shot.camera.width = shot.camera.height = 64;
    shot.lighting.error = error;
    shot.certify.belief = 0.0;
    shot.certify.samples = 1 << 17;
    return shot;
}

RenderedFrame render(const Shot& shot, const Surroundings* set = nullptr) {
    Progress silent;
    return render_medium(shot, glow(), silent, set);
}

double samples_of(const RenderedFrame& frame) {
    for (const StageCost& stage : frame.statistics.stages)
        if (stage.name == "correction")
            return stage.detail["samples"];
    return 0.0;
}

double certified(const RenderedFrame& frame) {
    return frame.statistics.certificate["picture"]["error"];
}

Shot by_lights_alone(Shot shot) {
    shot.correction.samples = 0;
    return shot;
}

TEST(CorrectedFrames, ErrLessWhenLessIsAskedFor) {
    Shot usual = shot_of(0.02f), fine = shot_of(0.01f);
    usual.certify.enabled = fine.certify.enabled = true;
    fine.certify.belief = 0.03;
    const RenderedFrame plain = render(by_lights_alone(usual)), some = render(usual), corrected = render(fine);
    EXPECT_EQ(samples_of(plain), 0.0);
    EXPECT_GT(samples_of(some), 0.0);
    EXPECT_GT(samples_of(corrected), 4096.0);
    std::printf("certified: %.4f, corrected %.4f and %.4f\n", certified(plain), certified(some), certified(corrected));
    EXPECT_LT(certified(some), certified(plain));
    EXPECT_LT(certified(corrected), 0.6 * certified(plain));
    // What it believes of its own error comes from the samples that corrected it.
    const auto& believed = corrected.statistics.believed_error;
    EXPECT_EQ(believed["samples"], 0);
    EXPECT_GT(believed["picture"]["error"].get<double>(), 0.5 * certified(corrected));
    EXPECT_LT(believed["picture"]["error"].get<double>(), 2.0 * certified(corrected));
}

TEST(CorrectedFrames, DraftsAreNot) {
    EXPECT_EQ(samples_of(render(shot_of(0.05f))), 0.0);
}

TEST(CorrectedFrames, TakeAsManySamplesAsTheShotStates) {
    Shot shot = shot_of(0.02f);
    shot.correction.samples = 5000;
    EXPECT_EQ(samples_of(render(shot)), 5000.0);
    shot = shot_of(0.01f);
    shot.correction.samples = 0;
    EXPECT_EQ(samples_of(render(shot)), 0.0);
    shot.method = RenderMethod::Path;
    shot.tracing.samples = 4;
    shot.correction.samples = 5000;
    EXPECT_EQ(samples_of(render(shot)), 0.0);
}

// Whether layers are written does not change the picture.
TEST(CorrectedFrames, AreTheSameWithoutLayersOfCells) {
    Shot with = shot_of(0.02f);
    with.correction.samples = 5000;
    Shot without = with;
    without.output.cell_layers = false;
    const RenderedFrame layered = render(with), bare = render(without);
    EXPECT_EQ(layered.image.layer("").pixels, bare.image.layer("").pixels);
    EXPECT_GT(layered.image.layers.size(), bare.image.layers.size());
    EXPECT_TRUE(std::ranges::none_of(bare.image.layers, [](const Layer& layer) { return layer.name == "MV"; }));
}

// Layers of bounces still add up to the cells.
TEST(CorrectedFrames, KeepTheSumsOfBounces) {
    Shot shot = shot_of(0.02f);
    shot.correction.samples = 5000;
    shot.output.bounce_layers = true;
    const Image image = render(shot).image;
    std::vector<double> multiple(image.layer("MM").pixels.size(), 0.0);
    int bounces = 0;
    for (const Layer& layer : image.layers)
        if (layer.name.starts_with("bounce") && layer.name != "bounce1") {
            ++bounces;
            for (std::size_t i = 0; i < multiple.size(); ++i)
                multiple[i] += layer.pixels[i];
        }
    EXPECT_GT(bounces, 2);
    for (std::size_t i = 0; i < multiple.size(); ++i) {
        EXPECT_NEAR(image.layer("bounce1").pixels[i], image.layer("MV").pixels[i],
                    1e-4 * image.layer("MV").pixels[i] + 1e-9);
        EXPECT_NEAR(multiple[i], image.layer("MM").pixels[i], 1e-3 * image.layer("MM").pixels[i] + 1e-7);
    }
}

// A floor under the ball, and a wall behind it.
Surroundings floor_under(bool wall = false) {
    Scene scene;
    add_quad(scene, {-4, -4, -1.1f}, {8, 0, 0}, {0, 8, 0}, lambert(0.7f));
    if (wall)
        add_quad(scene, {-4, 3, -1.1f}, {8, 0, 0}, {0, 0, 4}, lambert(0.7f));
    return Surroundings(std::move(scene), {});
}

Shot shot_over_floor(float error) {
    Shot shot = shot_of(error);
    shot.camera.width = shot.camera.height = 32;
    shot.virtual_lights.count = 200;
    shot.virtual_lights.photons = 20000;
    return shot;
}

// Of sets, too: every cell by its own light.
TEST(CorrectedFrames, OfSetsStillAddUp) {
    const Surroundings set = floor_under(true);
    Shot shot = shot_over_floor(0.02f);
    shot.correction.samples = 5000;
    const RenderedFrame frame = render(shot, &set);
    EXPECT_EQ(samples_of(frame), 5000.0);
    for (std::size_t p = 0; p < 32 * 32; ++p) {
        double sum = 0.0;
        for (const char* cell : {"V", "MV", "MM", "MS", "SV", "SM", "SS"})
            sum += frame.image.layer(cell).pixels[3 * p];
        EXPECT_NEAR(frame.image.layer("").pixels[4 * p], sum, 1e-4 * (1.0 + sum));
    }
}

// Fire that is seen directly is exact but for the edges of pixels, and light between surfaces has noise and rare bright
// paths: neither misses anything that samples could find.
TEST(CorrectedFrames, KeepWhatLatticesDoNotLight) {
    const Surroundings set = floor_under(true);
    Shot shot = shot_over_floor(0.02f);
    shot.correction.samples = 5000;
    const Image corrected = render(shot, &set).image, plain = render(by_lights_alone(shot), &set).image;
    for (const char* cell : {"V", "SS"})
        EXPECT_EQ(corrected.layer(cell).pixels, plain.layer(cell).pixels) << cell;
    for (const char* cell : {"MV", "MM"})
        EXPECT_NE(corrected.layer(cell).pixels, plain.layer(cell).pixels) << cell;
}

TEST(CorrectedFrames, OfSetsErrLessThanByLightsAlone) {
    const Surroundings set = floor_under();
    Shot shot = shot_over_floor(0.02f);
    shot.certify.enabled = true;
    const RenderedFrame plain = render(by_lights_alone(shot), &set), corrected = render(shot, &set);
    EXPECT_EQ(samples_of(plain), 0.0);
    EXPECT_GE(samples_of(corrected), 4096.0);
    std::printf("certified: %.4f, corrected %.4f\n", certified(plain), certified(corrected));
    EXPECT_LT(certified(corrected), 0.7 * certified(plain));
}

}  // namespace
}  // namespace brisance::test_corrected_frame
