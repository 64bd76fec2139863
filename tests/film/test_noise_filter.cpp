// The noise filter: it takes no light away and adds none, and leaves alone what is no noise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/parallel.h"
#include "core/rng.h"
#include "film/noise_filter.h"

namespace brisance {
namespace {

constexpr int kWidth = 37, kHeight = 29;

using Value = std::function<float(int x, int y, int channel)>;

// A picture that is the sum of two cells, as a path tracer leaves it.
Image picture(const Value& one, const Value& other, const Value& variance) {
    Image image;
    image.width = kWidth;
    image.height = kHeight;
    const auto layer = [&](const std::string& name, std::vector<std::string> channels, const Value& value) {
        image.layers.push_back({name, channels, true, {}});
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < int(channels.size()); ++c)
                    image.layers.back().pixels.push_back(value(x, y, c));
    };
    layer("", {"R", "G", "B", "A"}, [&](int x, int y, int c) { return c < 3 ? one(x, y, c) + other(x, y, c) : 1.0f; });
    layer("MV", {"R", "G", "B"}, one);
    layer("MM", {"R", "G", "B"}, other);
    layer("variance", {"R", "G", "B"}, variance);
    layer("Z", {"Z"}, [](int, int, int) { return 5.0f; });
    layer("albedo", {"R", "G", "B"}, [](int x, int, int) { return 0.01f * float(x); });
    return image;
}

Value constant(float value) {
    return [value](int, int, int) { return value; };
}

// Exponentially distributed noise about `mean`: as skewed as that of paths, never below zero.
Value noise(float mean, int salt) {
    return [=](int x, int y, int c) {
        return mean * float(Rng(stream_of("test/noise"), std::uint64_t(salt), std::uint64_t((y * kWidth + x) * 3 + c))
                                .next_exponential());
    };
}

Image filtered(Image image, int radius) {
    const NoiseFilter filter(image, radius);
    Image* const pictures[] = {&image};
    filter.apply(pictures);
    return image;
}

double sum(const Image& image, const char* name, int channel) {
    const Layer& layer = image.layer(name);
    double sum = 0.0;
    for (std::size_t i = std::size_t(channel); i < layer.pixels.size(); i += layer.channels.size())
        sum += layer.pixels[i];
    return sum;
}

double square_error(const Image& image, const std::function<float(std::size_t pixel)>& truth) {
    const Layer& beauty = image.layer("");
    double square = 0.0;
    for (std::size_t p = 0; p < beauty.pixels.size() / 4; ++p)
        for (int c = 0; c < 3; ++c)
            square += std::pow(beauty.pixels[4 * p + std::size_t(c)] - truth(p), 2);
    return square;
}

TEST(NoiseFilter, LeavesAConstantAsItIs) {
    const Image image = picture(constant(0.75f), constant(3.5f), constant(2.0f));
    for (const int radius : {1, 4, 50}) {
        const Image after = filtered(image, radius);
        for (const char* name : {"", "MV", "MM", "Z", "albedo"})
            EXPECT_EQ(after.layer(name).pixels, image.layer(name).pixels) << name << ", radius " << radius;
    }
}

TEST(NoiseFilter, KeepsTheSumOfEveryLayer) {
    // Among the noise are pixels a thousand times brighter.
    const Value sparks = [](int x, int y, int c) {
        return (x * 7 + y * 13) % 101 == 0 ? 1000.0f : noise(1.0f, 1)(x, y, c);
    };
    const Image image =
        picture(sparks, noise(0.3f, 2), [&](int x, int y, int c) { return std::pow(sparks(x, y, c), 2.0f); });
    for (const int radius : {1, 3, 9}) {
        const Image after = filtered(image, radius);
        for (const char* name : {"", "MV", "MM"})
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sum(after, name, c) / sum(image, name, c), 1.0, 1e-6) << name << ", radius " << radius;
        EXPECT_NE(after.layer("MM").pixels, image.layer("MM").pixels);
    }
}

TEST(NoiseFilter, KeepsCellsThatAddUpAndAlpha) {
    const Image after = filtered(picture(noise(1.0f, 1), noise(2.0f, 2), constant(5.0f)), 4);
    const Layer &beauty = after.layer(""), &one = after.layer("MV"), &other = after.layer("MM");
    for (std::size_t p = 0; p < std::size_t(kWidth) * kHeight; ++p) {
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(beauty.pixels[4 * p + c], one.pixels[3 * p + c] + other.pixels[3 * p + c], 1e-5);
        ASSERT_EQ(beauty.pixels[4 * p + 3], 1.0f);
    }
}

TEST(NoiseFilter, StaysWithinTheRangeOfTheNeighbours) {
    const Image image = picture(noise(1.0f, 1), constant(0.0f), constant(1.0f));
    const auto [low, high] = std::minmax_element(image.layer("MV").pixels.begin(), image.layer("MV").pixels.end());
    const Image after = filtered(image, 3);
    for (const float v : after.layer("MV").pixels) {
        ASSERT_GE(v, *low);
        ASSERT_LE(v, *high);
    }
}

// Noise of known variance about an even grey: 81 pixels at full weight would leave a ninth of it. Weights that follow
// the noise leave more, here as much as nine pixels at full weight.
TEST(NoiseFilter, AveragesNoiseAway) {
    const Image image = picture(noise(1.0f, 3), constant(0.0f), constant(1.0f));
    const auto grey = [](std::size_t) { return 1.0f; };
    const double before = square_error(image, grey), after = square_error(filtered(image, 4), grey);
    EXPECT_LT(std::sqrt(after / before), 0.36);
}

TEST(NoiseFilter, KnowsWhatVarianceIsLeft) {
    const Image image = picture(noise(1.0f, 4), constant(0.0f), constant(1.0f));
    const Image after = filtered(image, 4);
    const double left = square_error(after, [](std::size_t) { return 1.0f; });
    double said = 0.0;
    for (const float v : after.layer("variance").pixels)
        said += v;
    // The weights follow the noise a little, which a fixed filter's variance does not know.
    EXPECT_GT(said / left, 0.4);
    EXPECT_LT(said / left, 1.5);
}

TEST(NoiseFilter, DoesNotBlurWhatIsNoNoise) {
    const Value ramp = [](int x, int y, int c) { return float(1 + c) * (0.1f * float(x) + 0.03f * float(y)); };
    const Image image = picture(ramp, constant(0.5f), constant(1e-7f));
    const Image after = filtered(image, 5);
    for (std::size_t i = 0; i < image.layer("").pixels.size(); ++i)
        ASSERT_NEAR(after.layer("").pixels[i], image.layer("").pixels[i], 1e-4);
}

// Two halves with the same noise, of which one cannot be seen in the picture's noise: alpha or depth tells them apart.
TEST(NoiseFilter, DoesNotMixWhatAlphaOrDepthTellApart) {
    const auto right = [](std::size_t p) { return int(p) % kWidth >= kWidth / 2; };
    const Value halves = [](int x, int y, int c) { return noise(x >= kWidth / 2 ? 2.0f : 1.0f, 5)(x, y, c); };
    const auto sum_of_right = [&](const Image& image) {
        double sum = 0.0;
        for (std::size_t p = 0; p < std::size_t(kWidth) * kHeight; ++p)
            sum += right(p) ? image.layer("").pixels[4 * p] : 0.0f;
        return sum;
    };
    const Image plain = picture(halves, constant(0.0f), constant(4.0f));
    Image alpha = plain, depth = plain;
    for (std::size_t p = 0; p < std::size_t(kWidth) * kHeight; ++p) {
        alpha.layer("").pixels[4 * p + 3] = right(p) ? 1.0f : 0.4f;
        depth.layer("Z").pixels[p] = right(p) ? 9.0f : 5.0f;
    }
    const double before = sum_of_right(plain);
    EXPECT_LT(sum_of_right(filtered(plain, 4)) / before, 0.99);
    EXPECT_NEAR(sum_of_right(filtered(alpha, 4)) / before, 1.0, 1e-6);
    EXPECT_NEAR(sum_of_right(filtered(depth, 4)) / before, 1.0, 1e-6);
}

// Two pictures with the same weights: their mean stays their mean.
TEST(NoiseFilter, IsLinearInThePictures) {
    Image a = picture(noise(1.0f, 6), constant(0.0f), constant(2.0f)),
          b = picture(noise(1.0f, 7), constant(0.0f), constant(2.0f)), mean = a;
    for (std::size_t i = 0; i < mean.layer("").pixels.size(); ++i)
        mean.layer("").pixels[i] = 0.5f * (a.layer("").pixels[i] + b.layer("").pixels[i]);
    const NoiseFilter filter(mean, 3);
    Image* const pictures[] = {&mean, &a, &b};
    filter.apply(pictures);
    for (std::size_t i = 0; i < mean.layer("").pixels.size(); ++i)
        ASSERT_NEAR(mean.layer("").pixels[i], 0.5f * (a.layer("").pixels[i] + b.layer("").pixels[i]), 1e-5f);
}

TEST(NoiseFilter, IsTheSameOnAnyNumberOfThreadsAndInOtherUnits) {
    const Image image = picture(noise(1.0f, 8), noise(0.5f, 9), constant(1.0f));
    std::vector<Image> found;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        found.push_back(filtered(image, 4));
    }
    for (std::size_t k = 1; k < found.size(); ++k)
        EXPECT_EQ(found[k].layer("").pixels, found[0].layer("").pixels);
    // Powers of two change no bit of the mantissas.
    constexpr float kUnit = 0x1p20f;
    Image scaled = image;
    for (const char* name : {"", "MV", "MM", "variance"})
        for (std::size_t i = 0; i < scaled.layer(name).pixels.size(); ++i)
            if (const bool alpha = scaled.layer(name).channels.size() == 4 && i % 4 == 3; !alpha)
                scaled.layer(name).pixels[i] *= std::string(name) == "variance" ? kUnit * kUnit : kUnit;
    scaled = filtered(std::move(scaled), 4);
    for (std::size_t i = 0; i < found[0].layer("MV").pixels.size(); ++i)
        ASSERT_NEAR(scaled.layer("MV").pixels[i] / kUnit, found[0].layer("MV").pixels[i], 1e-4f);
}

}  // namespace
}  // namespace brisance
