// Pictures are corrected toward the truth, each cell by its own light, and stay as they are where nothing is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "correction/correct.h"
#include "fixtures/media.h"
#include "reference/trace_picture.h"

namespace brisance::test_corrector {
namespace {

constexpr int kSize = 24;
constexpr std::size_t kPixels = std::size_t(kSize) * kSize;
const std::vector<std::string> kLayers = {"", "V", "MV", "MM"};

Medium burning_ball() {
    testing::Recipe r;
    r.box = testing::cube(-10, 9);
    r.world_from_index = testing::cubic(0.1);
    r.density = [](const ivec3& n) { return testing::ball(n, dvec3(-0.5), 9.0); };
    r.flame = [](const ivec3& n) { return testing::ball(n, dvec3(0.5, -1.0, 1.0), 5.0); };
    r.settings = testing::black_smoke();
    r.settings.smoke.extinction_per_metre = 2.0f;
    r.settings.smoke.albedo = Rgb(0.8f, 0.7f, 0.6f);
    return testing::make_medium(r);
}

CameraSettings camera_settings() {
    CameraSettings s;
    s.eye = {0.0, -3.2, 0.6};
    s.width = s.height = kSize;
    return s;
}

struct Scene {
    Medium medium = burning_ball();
    PathTracer tracer{medium, TracingSettings{}, -1, nullptr};
    Camera camera{camera_settings(), medium};
    MomentTracers tracers{tracer, camera};
};

const Scene& scene() {
    static const Scene one;
    return one;
}

// The mean of so many samples of every pixel, by cell.
Image path_picture(std::uint64_t samples) {
    Image image{kSize, kSize, {}};
    for (const std::string& name : kLayers)
        image.layers.push_back({name, {"R", "G", "B"}, true, std::vector<float>(3 * kPixels)});
    parallel_for(kPixels, [&](std::size_t p) {
        std::array<dvec3, 4> sum{};
        PathStatistics ignored;
        for (std::uint64_t s = 0; s < samples; ++s) {
            const PathSum path = trace_sample(scene().tracer, scene().camera, p, s, ignored);
            for (int order = 0; order < kPathOrders; ++order)
                sum[1 + std::min(order, 2)] += dvec3(path[order]) / double(samples);
        }
        sum[0] = sum[1] + sum[2] + sum[3];
        for (int t = 0; t < 4; ++t)
            for (int c = 0; c < 3; ++c)
                image.layers[t].pixels[3 * p + c] = float(sum[t][c]);
    });
    return image;
}

const Image& truth() {
    static const Image image = path_picture(512);
    return image;
}

// MV three tenths too bright at the left, too dark at the right; MM a fifth too dark; V as it is.
Image spoiled() {
    Image image = truth();
    for (std::size_t p = 0; p < kPixels; ++p) {
        const float slope = 0.3f * (1.0f - 2.0f * float(p % kSize) / kSize);
        for (std::size_t i = 3 * p; i < 3 * p + 3; ++i) {
            image.layer("MV").pixels[i] *= 1.0f + slope;
            image.layer("MM").pixels[i] *= 0.8f;
            image.layer("").pixels[i] =
                image.layer("V").pixels[i] + image.layer("MV").pixels[i] + image.layer("MM").pixels[i];
        }
    }
    return image;
}

double error(const Image& image, const std::string& layer) {
    double square = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < 3 * kPixels; ++i) {
        square += std::pow(image.layer(layer).pixels[i] - truth().layer(layer).pixels[i], 2);
        norm += std::pow(truth().layer(layer).pixels[i], 2);
    }
    return std::sqrt(square / norm);
}

Correction correct(Image& image, std::size_t samples, int rounds = 1) {
    Progress silent;
    Corrector corrector(image, scene().tracers, false);
    for (int k = 0; k < rounds; ++k)
        corrector.sample(samples / std::size_t(rounds), silent);
    return corrector.correct();
}

TEST(Corrector, PutsBackWhatIsMissing) {
    Image image = spoiled();
    EXPECT_GT(error(image, "MV"), 0.06);
    EXPECT_NEAR(error(image, "MM"), 0.2, 1e-4);
    const Correction correction = correct(image, 20000);
    EXPECT_GE(correction.samples, 20000u);
    EXPECT_LT(error(image, "MV"), 0.025);
    EXPECT_LT(error(image, "MM"), 0.05);
    EXPECT_LT(error(image, ""), 0.02);
}

// With so many samples that single pixels are known, too: what they miss is a good part of what is left.
TEST(Corrector, SaysWhatItLeaves) {
    Image image = spoiled();
    const double before = error(image, "MM");
    const Correction correction = correct(image, 80000);
    ASSERT_TRUE(correction.of("MM"));
    const CorrectedLayer& layer = *correction.of("MM");
    const double left = layer.left(before);
    EXPECT_GT(error(image, "MM"), 0.5 * left);
    EXPECT_LT(error(image, "MM"), 2.0 * left);
    EXPECT_LT(layer.left(before, 4.0), left);
}

// Detail below the noise of the samples is not found, and stays: an error is not small because nothing was found of it.
TEST(Corrector, LeavesWhatItHasNotFound) {
    Image image = spoiled();
    const CorrectedLayer layer = *correct(image, 2000).of("MM");
    EXPECT_GT(layer.found(), 0.0);
    EXPECT_NEAR(std::pow(layer.left(0.5), 2.0) - std::pow(layer.left(0.4), 2.0), 0.09, 0.01);
    EXPECT_LT(layer.left(layer.found()), layer.found());
}

// Where the noise of two bands is known, and what they have of an error of 1 is not.
CorrectedLayer two_bands(ResidualEnergy first, ResidualEnergy second) {
    return {"MM", {{{first}}, {{second}}}, 1.0};
}

TEST(CorrectedLayer, KeepsAnErrorOfWhichSamplesTellNothing) {
    const ResidualEnergy chance{-3.0, 10.0, 100.0};
    EXPECT_NEAR(two_bands(chance, chance).left(1.0), 1.0, 1e-6);
    EXPECT_NEAR(two_bands(chance, chance).left(0.1), 0.1, 1e-6);
    EXPECT_LT(two_bands(chance, chance).left(1.0, 100.0), 0.5);  // a hundred times as many would
}

// Half of the error's square is in a band without noise. Of the other band Wiener's gain is 0.5 / (0.5 + 1).
TEST(CorrectedLayer, LosesWhatSamplesKnow) {
    const ResidualEnergy clear{0.5, 0.0, 0.0}, noisy{0.5, 1.0, 0.0};
    EXPECT_NEAR(std::pow(two_bands(clear, noisy).left(1.0), 2.0), 0.5 * (1.0 - 0.5 / 1.5), 1e-9);
    EXPECT_NEAR(two_bands(clear, {0.0, 1.0, 0.0}).left(1.0), 0.0, 1e-9);
}

// Of a right picture there is nothing to say: what noise does to it is far less than a path-traced picture of as many
// samples has, which is 9 % of MM (measured).
TEST(Corrector, LeavesARightPictureAlone) {
    Image image = truth();
    correct(image, 20000);
    EXPECT_LT(error(image, "V"), 0.004);
    EXPECT_LT(error(image, "MV"), 0.015);
    EXPECT_LT(error(image, "MM"), 0.03);
}

TEST(Corrector, KeepsTheSumOfCellsAndBlackPixels) {
    Image image = spoiled();
    const Image before = image;
    correct(image, 5000);
    int black = 0;
    for (std::size_t i = 0; i < 3 * kPixels; ++i) {
        double sum = 0.0;
        for (const char* cell : {"V", "MV", "MM"}) {
            const float now = image.layer(cell).pixels[i];
            EXPECT_GE(now, 0.0f);
            if (before.layer(cell).pixels[i] == 0.0f) {
                EXPECT_EQ(now, 0.0f);
                ++black;
            }
            sum += now;
        }
        EXPECT_NEAR(image.layer("").pixels[i], sum, 1e-5 + 1e-5 * sum);
    }
    EXPECT_GT(black, 0);
}

TEST(Corrector, TakesMoreSamplesAsPartsOfOneSet) {
    Image once = spoiled(), twice = spoiled();
    correct(once, 20000);
    const Correction correction = correct(twice, 20000, 2);
    EXPECT_GE(correction.samples, 20000u);
    EXPECT_LT(error(twice, "MM"), 1.5 * error(once, "MM"));
    EXPECT_LT(error(once, "MM"), 1.5 * error(twice, "MM"));
}

TEST(Corrector, HasTheSameBitsOnAnyNumberOfThreads) {
    Image all = spoiled(), one = spoiled();
    correct(all, 3000);
    const ThreadLimit limit(1);
    correct(one, 3000);
    for (const std::string& name : kLayers)
        EXPECT_EQ(all.layer(name).pixels, one.layer(name).pixels);
}

TEST(Corrector, CorrectsAPictureWithoutCellsAsOne) {
    Image image = spoiled();
    image.layers.resize(1);
    const double before = error(image, "");
    const Correction correction = correct(image, 20000);
    ASSERT_EQ(correction.layers.size(), 1u);
    EXPECT_LT(error(image, ""), 0.6 * before);
}

TEST(Corrector, TakesNoSamplesOfABlackPicture) {
    Image image = truth();
    for (Layer& layer : image.layers)
        std::ranges::fill(layer.pixels, 0.0f);
    EXPECT_EQ(correct(image, 1000).samples, 0u);
    EXPECT_EQ(*std::ranges::max_element(image.layer("").pixels), 0.0f);
}

// A pixel that is not finite is neither drawn nor changed, and spoils no other.
TEST(Corrector, LeavesPixelsOutThatAreNotFinite) {
    Image image = spoiled();
    const std::size_t middle = 3 * (kPixels / 2 + kSize / 2);
    for (const std::string& name : kLayers)
        image.layer(name).pixels[middle] = std::nanf("");
    correct(image, 5000);
    for (const std::string& name : kLayers)
        for (std::size_t i = 0; i < 3 * kPixels; ++i)
            EXPECT_EQ(std::isfinite(image.layer(name).pixels[i]), i != middle) << name << i;
}

}  // namespace
}  // namespace brisance::test_corrector
