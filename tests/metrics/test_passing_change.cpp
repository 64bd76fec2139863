// Change that does not last: closed forms.

#include "metrics/passing_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "pictures.h"

namespace brisance {
namespace {

using testing::even_picture;
using testing::make_picture;

constexpr int kColumns = 24, kRows = 16;

Motion shifted(float x) {
    const auto plane = [](float value) {
        return Plane{kColumns, kRows, std::vector<float>(std::size_t(kColumns) * kRows, value)};
    };
    return motion_of_vectors(plane(x), plane(0.0f));
}

// A slope that has moved `by` pixels to the right.
Picture slope(double by) {
    return make_picture(kColumns, kRows, [&](int x, int) { return Rgb(float(1.0 + 0.1 * (x - by))); });
}

double change_of(const Picture& before, const Picture& frame, const Picture& after) {
    const Motion still = shifted(0.0f);
    return passing_change(frame, {before, still}, {after, still}).change;
}

TEST(PassingChange, IsNoneWhereLightRisesSteadily) {
    const auto even = [](float v) { return even_picture(v, kColumns, kRows); };
    EXPECT_NEAR(change_of(even(1.0f), even(1.5f), even(2.0f)), 0.0, 1e-7);
    EXPECT_NEAR(change_of(even(2.0f), even(3.0f), even(2.0f)), 1.0 / std::sqrt(17.0 / 3.0), 1e-6);
    // A frame that shows something alone stands out more than its neighbours do.
    EXPECT_NEAR(change_of(even(0.0f), even(1.0f), even(0.0f)), std::sqrt(3.0), 1e-6);
    EXPECT_NEAR(change_of(even(0.0f), even(0.0f), even(1.0f)), 0.5 * std::sqrt(3.0), 1e-6);
    EXPECT_EQ(change_of(even(0.0f), even(0.0f), even(0.0f)), 0.0);
}

TEST(PassingChange, IsNoneOfWhatMoves) {
    const Picture before = slope(0.0), frame = slope(3.0), after = slope(5.0);
    const Motion back = shifted(-3.0f), forth = shifted(2.0f);
    const PassingChange change = passing_change(frame, {before, back}, {after, forth});
    EXPECT_NEAR(change.seen, 1.0 - 5.0 / kColumns, 1e-9);
    // At either edge a few columns are compared in place.
    double expected = 0.0, norm = 0.0;
    for (int x = 0; x < kColumns; ++x) {
        const double shown = 1.0 + 0.1 * (x - 3.0), then = x < 3 ? shown + 0.3 : shown,
                     next = x >= kColumns - 2 ? shown - 0.2 : shown;
        expected += std::pow(shown - 0.5 * (then + next), 2);
        norm += (then * then + shown * shown + next * next) / 3.0;
    }
    EXPECT_NEAR(change.change, std::sqrt(expected / norm), 1e-5);
}

// Noise of deviation s that is new in each frame: root of 3/2 times s.
TEST(PassingChange, OfNewNoise) {
    const auto noisy = [](int seed) {
        return make_picture(kColumns * 8, kRows * 8, [&](int x, int y) {
            const unsigned h =
                (unsigned(x) * 73856093u ^ unsigned(y) * 19349663u ^ unsigned(seed) * 83492791u) * 2654435761u;
            return Rgb(1.0f + ((h >> 16 & 1) ? 0.1f : -0.1f));
        });
    };
    const std::vector<float> none(std::size_t(kColumns) * kRows * 64, 0.0f);
    const Plane still{kColumns * 8, kRows * 8, none};
    const Motion motion = motion_of_vectors(still, still);
    const Picture before = noisy(1), frame = noisy(2), after = noisy(3);
    EXPECT_NEAR(passing_change(frame, {before, motion}, {after, motion}).change, 0.1 * std::sqrt(1.5), 0.005);
}

TEST(PassingChange, PixelsThatAreNotFiniteDoNotCount) {
    const Picture even = even_picture(1.0f, kColumns, kRows);
    Picture damaged = even;
    damaged.pixels[7].y = std::numeric_limits<float>::quiet_NaN();
    const Motion still = shifted(0.0f);
    const PassingChange change = passing_change(damaged, {even, still}, {even, still});
    EXPECT_EQ(change.change, 0.0);
    EXPECT_NEAR(change.seen, 1.0 - 1.0 / (kColumns * kRows), 1e-9);
}

TEST(PassingChange, NeedsPicturesOfOneSize) {
    const Picture even = even_picture(1.0f, kColumns, kRows), other = even_picture(1.0f, kColumns + 1, kRows);
    const Motion still = shifted(0.0f);
    EXPECT_THROW(passing_change(even, {other, still}, {even, still}), Error);
}

}  // namespace
}  // namespace brisance
