// The film of the path tracer stores its samples, and accepts only its own checkpoints.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/rng.h"
#include "reference/path_film.h"

namespace brisance {
namespace {

PathSum some_path(std::uint64_t pixel, std::uint64_t number) {
    PathSum sum;
    Rng rng(Stream::Path, pixel, number);
    for (Rgb& order : sum) {
        const float r = rng.next(), g = rng.next(), b = rng.next();
        order = Rgb(r, g, b) * (rng.next() < 0.1f ? 1e6f : 1.0f);
    }
    return sum;
}

void add_paths(PathFilm& film, int begin, int end) {
    for (int number = begin; number < end; ++number)
        for (std::size_t pixel = 0; pixel < std::size_t(film.width()) * film.height(); ++pixel)
            EXPECT_TRUE(film.add(pixel, number & 1, some_path(pixel, number)));
    film.work.passes = end / 2;
}

bool same(const PathFilm& a, const PathFilm& b) {
    return a.serialise("") == b.serialise("");
}

TEST(PathFilm, KeepsOrdersAndHalvesApart) {
    PathFilm film(3, 2, true);
    ASSERT_EQ(film.sums(), kPathOrders);
    const PathSum a = some_path(4, 0), b = some_path(4, 1), c = some_path(4, 2);
    film.add(4, 0, a);
    film.add(4, 1, b);
    film.add(4, 0, c);
    for (int order = 0; order < kPathOrders; ++order)
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(film.sum(4, 0, order, k), double(a[order][k]) + double(c[order][k]));
            EXPECT_EQ(film.sum(4, 1, order, k), double(b[order][k]));
            EXPECT_EQ(film.sum(3, 0, order, k), 0.0);
        }
}

TEST(PathFilm, WithoutOrdersKeepsTheCellsOfTheLedger) {
    PathFilm cells(1, 1, false), orders(1, 1, true);
    ASSERT_EQ(cells.sums(), 3);
    add_paths(cells, 0, 10);
    add_paths(orders, 0, 10);
    for (int half = 0; half < 2; ++half)
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(cells.sum(0, half, 0, k), orders.sum(0, half, 0, k));
            EXPECT_EQ(cells.sum(0, half, 1, k), orders.sum(0, half, 1, k));
            double more = 0.0;
            for (int order = 2; order < kPathOrders; ++order)
                more += orders.sum(0, half, order, k);
            EXPECT_NEAR(cells.sum(0, half, 2, k), more, 1e-12 * more);
        }
}

TEST(PathFilm, SquaresAreOfWholePaths) {
    PathFilm film(1, 1, false);
    double expected = 0.0;
    for (int number = 0; number < 6; ++number) {
        const PathSum path = some_path(0, number);
        Rgb all(0.0f);
        for (const Rgb& order : path)
            all += order;
        expected += double(all.y) * all.y;
        film.add(0, number & 1, path);
    }
    EXPECT_NEAR(film.square(0, 1), expected, 1e-6 * expected);
}

TEST(PathFilm, LeavesOutWhatIsNotFinite) {
    PathFilm film(2, 1, true);
    add_paths(film, 0, 4);
    const PathFilm before = film;
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()})
        for (const int order : {0, 5, kPathOrders - 1})
            for (int k = 0; k < 3; ++k) {
                PathSum path = some_path(1, 9);
                path[order][k] = bad;
                EXPECT_FALSE(film.add(1, 0, path));
            }
    EXPECT_TRUE(same(film, before));
}

TEST(PathFilm, ComesBackFromItsCheckpointBitByBit) {
    for (const bool orders : {false, true}) {
        PathFilm film(5, 3, orders);
        add_paths(film, 0, 6);
        film.work.passes = 3;
        film.work.rows = 2;
        film.work.scatterings = 12345678901234u;
        film.work.not_finite = 7;
        film.work.bad_pixel = 8;
        film.work.bad_sample = 9;
        film.work.seconds = 1.25;
        PathFilm back(5, 3, orders);
        EXPECT_EQ(back.restore(film.serialise("the shot"), "the shot"), "");
        EXPECT_TRUE(same(film, back));
        EXPECT_EQ(back.work.passes, 3u);
        EXPECT_EQ(back.work.rows, 2u);
        EXPECT_EQ(back.work.scatterings, 12345678901234u);
        EXPECT_EQ(back.work.not_finite, 7u);
        EXPECT_EQ(back.work.bad_pixel, 8u);
        EXPECT_EQ(back.work.bad_sample, 9u);
        EXPECT_EQ(back.work.seconds, 1.25);
    }
}

TEST(PathFilm, AddingInTwoGoesIsAddingInOne) {
    PathFilm once(4, 3, true), first(4, 3, true), second(4, 3, true);
    add_paths(once, 0, 20);
    add_paths(first, 0, 8);
    ASSERT_EQ(second.restore(first.serialise("k"), "k"), "");
    add_paths(second, 8, 20);
    EXPECT_TRUE(same(once, second));
}

// Every refusal leaves the film as it was.
class Refusals : public ::testing::Test {
protected:
    Refusals() : film_(4, 3, true) {
        add_paths(film_, 0, 4);
        bytes_ = film_.serialise("the shot");
        add_paths(film_, 4, 6);
        before_ = film_.serialise("");
    }

    void expect_refused(const std::string& bytes, const std::string& key, const std::string& why) {
        const std::string trouble = film_.restore(bytes, key);
        EXPECT_NE(trouble.find(why), std::string::npos) << '"' << trouble << '"';
        EXPECT_EQ(film_.serialise(""), before_);
    }

    PathFilm film_;
    std::string bytes_, before_;
};

TEST_F(Refusals, OfAnotherShotsCheckpoint) {
    expect_refused(bytes_, "another shot", "another shot");
    expect_refused(bytes_, "", "another shot");
}

TEST_F(Refusals, OfAnotherPicturesCheckpoint) {
    for (const PathFilm& other :
         {PathFilm(3, 4, true), PathFilm(4, 3, false), PathFilm(12, 1, true), PathFilm(4, 4, true)})
        expect_refused(other.serialise("the shot"), "the shot", "another picture size");
}

TEST_F(Refusals, OfWhatIsNoCheckpoint) {
    expect_refused("", "the shot", "no checkpoint");
    expect_refused("v/1\x01", "the shot", "no checkpoint");
    expect_refused(std::string(1000, 'x'), "the shot", "no checkpoint");
}

TEST_F(Refusals, OfEveryFlippedBit) {
    for (std::size_t at = 0; at < bytes_.size(); at += at < 200 ? 1 : 97) {
        std::string damaged = bytes_;
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << at % 8));
        expect_refused(damaged, "the shot", "is ");
    }
}

TEST_F(Refusals, OfEveryLengthButTheRightOne) {
    for (std::size_t length = 0; length < bytes_.size(); length += length < 200 ? 1 : 61)
        expect_refused(bytes_.substr(0, length), "the shot", "is ");
    expect_refused(bytes_ + "x", "the shot", "damaged");
    expect_refused(bytes_ + bytes_, "the shot", "damaged");
}

}  // namespace
}  // namespace brisance
