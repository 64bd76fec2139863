// Differences that FLIP must detect, and those that it must not.

#include "metrics/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/error.h"
#include "metrics/separable_filter.h"
#include "pictures.h"

namespace brisance {
namespace {

using testing::at;
using testing::even_picture;
using testing::make_picture;
using testing::rearranged;

Picture random_picture(unsigned seed, int width, int height) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    return make_picture(width, height, [&](int, int) {
        const float r = uniform(generator), g = uniform(generator), b = uniform(generator);
        return Rgb(r, g, b);
    });
}

double mean_error(const Picture& a, const Picture& b, double pixels_per_degree = kPixelsPerDegree) {
    return mean_of(flip_errors(a, b, pixels_per_degree));
}

TEST(SeparableFilter, IsTheTwoDimensionalOneWithItsEdgesContinued) {
    const Taps across = {0.1f, 0.5f, -0.2f, 0.3f, 0.7f}, down = {0.4f, -1.0f, 0.6f};
    Plane plane{7, 4, {}};
    for (int i = 0; i < 28; ++i)
        plane.values.push_back(static_cast<float>((i * 37) % 11));
    const Plane result = filtered(plane, across, down);
    for (int y = 0; y < plane.height; ++y) {
        for (int x = 0; x < plane.width; ++x) {
            double sum = 0.0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -2; i <= 2; ++i)
                    sum += double(across[static_cast<std::size_t>(i + 2)]) * down[static_cast<std::size_t>(j + 1)] *
                           at(plane, std::clamp(x + i, 0, 6), std::clamp(y + j, 0, 3));
            EXPECT_NEAR(at(result, x, y), sum, 1e-5) << x << " " << y;
        }
    }
}

TEST(Flip, SeesNothingBetweenEqualPictures) {
    const Picture picture = random_picture(1, 40, 30);
    for (const float error : flip_errors(picture, picture).values)
        EXPECT_EQ(error, 0.0f);
}

// Without edges only colour counts: HyAB is 100, and pure green and pure blue, the largest difference a display can
// show, are apart by |87.735 - 32.297| + |(-75.612, 72.977) - (25.575, -34.836)| after Hunt.
TEST(Flip, OfBlackAndWhiteIsWhatTheFormulasGive) {
    const double largest = std::pow(87.735 - 32.297 + std::hypot(-75.612 - 25.575, 72.977 + 34.836), 0.7),
                 knee = 0.4 * largest;
    const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - knee) / (largest - knee);
    for (const float error : flip_errors(even_picture(0.0f), even_picture(1.0f)).values)
        EXPECT_NEAR(error, expected, 1e-4);
    for (const float error : flip_errors(make_picture(8, 8, [](int, int) { return Rgb(0.0f, 1.0f, 0.0f); }),
                                         make_picture(8, 8, [](int, int) { return Rgb(0.0f, 0.0f, 1.0f); }))
                                 .values)
        EXPECT_NEAR(error, 1.0, 1e-4);
    // Lightness 116 Y^(1/3) - 16, below the knee.
    const double step = 116.0 * (std::cbrt(0.5) - std::cbrt(0.25));
    EXPECT_NEAR(mean_error(even_picture(0.5f), even_picture(0.25f)), 0.95 * std::pow(step, 0.7) / knee, 1e-4);
}

// Both pictures of this test, and the figures, come from a two-dimensional implementation in Python written from [1]
// for this comparison alone.
TEST(Flip, AgreesWithAnotherImplementation) {
    const auto pattern = [](bool changed) {
        return make_picture(24, 16, [changed](int x, int y) {
            Rgb colour;
            for (int c = 0; c < 3; ++c) {
                double v = 0.5 + 0.35 * std::sin(0.6 * x + 0.9 * c) * std::cos(0.45 * y - 0.3 * c);
                if (changed)
                    v += 0.15 * std::sin(1.7 * x + 0.2 * y + c);
                if (changed && x >= 10 && x < 14 && y >= 5 && y < 9)
                    v = c != 2 ? 0.9 : 0.05;
                colour[c] = static_cast<float>(std::clamp(v, 0.0, 1.0));
            }
            return colour;
        });
    };
    const Plane at_67 = flip_errors(pattern(true), pattern(false), 67.0);
    EXPECT_NEAR(mean_of(at_67), 0.252298, 1e-4);
    EXPECT_NEAR(at(at_67, 0, 0), 0.308934, 2e-4);
    EXPECT_NEAR(at(at_67, 12, 7), 0.962210, 2e-4);
    EXPECT_NEAR(at(at_67, 23, 15), 0.334012, 2e-4);
    EXPECT_NEAR(at(at_67, 9, 5), 0.496026, 2e-4);
    EXPECT_NEAR(at(at_67, 5, 12), 0.108260, 2e-4);
    const Plane at_25 = flip_errors(pattern(true), pattern(false), 25.0);
    EXPECT_NEAR(mean_of(at_25), 0.420079, 1e-4);
    EXPECT_NEAR(at(at_25, 12, 7), 0.978814, 2e-4);
    EXPECT_NEAR(at(at_25, 5, 12), 0.400939, 2e-4);
}

TEST(Flip, StaysWithinZeroAndOne) {
    for (unsigned seed = 0; seed < 4; ++seed)
        for (const float error :
             flip_errors(random_picture(seed, 31, 17), random_picture(seed + 100, 31, 17), 20.0).values) {
            EXPECT_GE(error, 0.0f);
            EXPECT_LE(error, 1.0f);
        }
}

TEST(Flip, IsTheSameBothWays) {
    const Picture a = random_picture(1, 40, 30), b = random_picture(2, 40, 30);
    EXPECT_EQ(flip_errors(a, b).values, flip_errors(b, a).values);
}

TEST(Flip, TurnsWithThePictures) {
    const Picture a = random_picture(1, 20, 14), b = random_picture(2, 20, 14);
    const Plane errors = flip_errors(a, b);
    const auto mirror = [](int x, int y) { return std::pair{19 - x, y}; };
    const auto transpose = [](int x, int y) { return std::pair{y, x}; };
    const Plane mirrored = flip_errors(rearranged(a, 20, 14, mirror), rearranged(b, 20, 14, mirror));
    const Plane transposed = flip_errors(rearranged(a, 14, 20, transpose), rearranged(b, 14, 20, transpose));
    for (int y = 0; y < 14; ++y)
        for (int x = 0; x < 20; ++x) {
            EXPECT_NEAR(at(mirrored, 19 - x, y), at(errors, x, y), 1e-4);
            EXPECT_NEAR(at(transposed, y, x), at(errors, x, y), 1e-4);
        }
}

TEST(Flip, GrowsWithTheDifference) {
    double before = 0.0;
    for (const float level : {0.31f, 0.35f, 0.45f, 0.6f, 0.8f, 1.0f}) {
        const auto spot = [&](int x, int y) { return Rgb(x > 12 && x < 20 && y > 8 && y < 16 ? level : 0.3f); };
        const double error = mean_error(make_picture(32, 24, spot), even_picture(0.3f));
        EXPECT_GT(error, before) << level;
        before = error;
    }
}

TEST(Flip, DoesNotSeeDetailTooFineForTheEye) {
    const auto stripes = [](int period) {
        return make_picture(96, 64, [period](int x, int) { return Rgb(2 * (x % period) < period ? 0.6f : 0.4f); });
    };
    const double fine = mean_error(stripes(2), even_picture(0.5f, 96, 64));  // 33 periods per degree
    const double coarse = mean_error(stripes(32), even_picture(0.5f, 96, 64));
    EXPECT_LT(fine, 0.03);
    EXPECT_GT(coarse, 0.2);
    // From nearer by, the same stripes are seen.
    EXPECT_GT(mean_error(stripes(2), even_picture(0.5f, 96, 64), 8.0), 0.2);
}

// Lighter by as much everywhere, or lighter on one side of an edge and darker on the other: beside the edge, on the
// lighter side, the second is no farther off in colour, but its edge is stronger.
TEST(Flip, CountsAChangedEdgeForMoreThanItsColour) {
    const auto edge = [](float left, float right) {
        return make_picture(64, 48, [=](int x, int) { return Rgb(x < 32 ? left : right); });
    };
    const Plane lighter = flip_errors(edge(0.33f, 0.63f), edge(0.3f, 0.6f));
    const Plane stronger = flip_errors(edge(0.27f, 0.63f), edge(0.3f, 0.6f));
    EXPECT_GT(at(stronger, 34, 24), 1.3f * at(lighter, 34, 24));
    EXPECT_NEAR(at(stronger, 60, 24), at(lighter, 60, 24), 1e-4);  // far from it all is the same
}

TEST(Flip, ClipsWhatADisplayCannotShow) {
    EXPECT_EQ(mean_error(even_picture(3.0f), even_picture(1.0f)), 0.0);
    EXPECT_EQ(mean_error(even_picture(-1.0f), even_picture(0.0f)), 0.0);
}

TEST(Flip, RefusesWhatItCannotCompare) {
    const auto code = [](const Picture& a, const Picture& b, double pixels_per_degree) {
        try {
            flip_errors(a, b, pixels_per_degree);
        } catch (const Error& error) {
            return error.code();
        }
        return ExitCode::Success;
    };
    EXPECT_EQ(code(even_picture(1.0f, 8, 8), even_picture(1.0f, 8, 9), 67.0), ExitCode::BadData);
    for (const double wrong : {0.0, -67.0, 1e6, std::nan("")})
        EXPECT_EQ(code(even_picture(1.0f, 8, 8), even_picture(1.0f, 8, 8), wrong), ExitCode::Usage);
}

}  // namespace
}  // namespace brisance
