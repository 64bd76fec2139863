// Grains among the pixels around: energy is kept, surfaces are kept apart where they are wide enough, and what several
// samples find stays where it is.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "core/rng.h"
#include "pixel_sharing/grain_finder.h"

namespace brisance {
namespace {

constexpr int kAcross = 41, kDown = 41, kFirstRow = 4, kRaysOfPixel = 4;
constexpr int kX = 20, kY = 20;
constexpr float kEven = 1.0f;

struct Surface {
    std::uint32_t mesh = 0;
    vec3 normal{0.0f, 0.0f, 1.0f};
    double depth = 100.0;  // [m]
};

// A picture of surfaces that face the camera, one to a pixel. All samples see the same light, but for what a test sets.
struct Facade {
    std::vector<SurfaceSample> samples;
    std::vector<CellSum> found;
    std::vector<float> pixels;  // after divide(), as the next
    double square_error = 0.0;
    std::vector<vec3> normals;

    explicit Facade(const std::function<Surface(int x, int y)>& surface = [](int, int) { return Surface{}; }) {
        for (int y = 0; y < kDown; ++y)
            for (int x = 0; x < kAcross; ++x)
                for (int k = 0; k < kRaysOfPixel; ++k) {
                    const Surface at = surface(x, y);
                    SurfaceSample s{};
                    s.pixel = std::uint32_t((y + kFirstRow) * kAcross + x);
                    s.number = std::uint64_t(k);
                    s.ray = {dvec3(x + 0.1 * k, y, 0.0), dvec3(0.0, 0.0, -1.0)};
                    s.hit.distance = at.depth;
                    s.hit.mesh = at.mesh;
                    s.share = 1.0f / float(kRaysOfPixel);
                    samples.push_back(s);
                    normals.push_back(at.normal);
                    found.emplace_back();
                    found.back().at(Cell::SA) = Rgb(kEven);
                }
    }

    static std::size_t at(int x, int y, int ray) {
        return (std::size_t(y) * kAcross + std::size_t(x)) * kRaysOfPixel + ray;
    }

    // Returns how many samples are grains. `stands_for`, `times`: those of GrainFinder::Sample.
    int divide(float stands_for = 1.0f, float times = 1.0f) {
        std::vector<GrainFinder::Shown> shown;
        for (std::size_t i = 0; i < samples.size(); ++i)
            shown.push_back({samples[i].share * luminance(found[i]), normals[i]});
        DividedGrains grains(kAcross, kFirstRow + kDown);
        GrainFinder finder(samples, shown, kAcross, nullptr, grains);
        int count = 0;
        pixels.assign(std::size_t(kAcross) * kDown, 0.0f);
        for (std::size_t i = 0; i < samples.size(); ++i)
            if (finder.take({i, found[i], {}, stands_for, times}))
                ++count;
            else
                pixels[i / kRaysOfPixel] += stands_for * samples[i].share * found[i].at(Cell::SA).y;
        grains.divide();
        square_error = grains.square_error(Cell::SA);
        const std::vector<Rgb> divided = grains.pixels(Cell::SA);
        for (std::size_t p = 0; p < pixels.size(); ++p)
            pixels[p] += divided[p + std::size_t(kFirstRow) * kAcross].y;
        return count;
    }

    float pixel(int x, int y) const { return pixels[std::size_t(y) * kAcross + std::size_t(x)]; }
    double all() const {
        double sum = 0.0;
        for (int y = 0; y < kDown; ++y)
            for (int x = 0; x < kAcross; ++x)
                sum += pixel(x, y);
        return sum;
    }
};

void make_bright(Facade& wall, int ray, float brightness) {
    wall.found[Facade::at(kX, kY, ray)].at(Cell::SA) = Rgb(brightness);
}

// Of eight times the others' light: no pixel shows more than a twentieth of what is around besides.
TEST(DividedGrains, OneBrightSampleIsDividedAmongThePixelsAroundAndKeepsItsEnergy) {
    Facade wall;
    make_bright(wall, 2, 8.0f);
    EXPECT_EQ(wall.divide(), 1);
    double squares = 0.0;
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) {
            const bool own = x == kX && y == kY, far = std::hypot(x - kX, y - kY) > 7.0;
            const float part = wall.pixel(x, y) - (own ? kEven * 3 / 4 : kEven);
            EXPECT_GE(part, far ? 0.0f : -1e-6f) << x << " " << y;
            EXPECT_LE(part, far ? 0.0f : 0.052f) << x << " " << y;
            squares += 3.0 * part * part;
        }
    EXPECT_NEAR(wall.square_error, squares, 1e-3 * squares);
    EXPECT_NEAR(wall.all(), kAcross * kDown * kEven + (8.0 - kEven) / kRaysOfPixel, 1e-3);
}

// As widely as can be, and no farther.
TEST(DividedGrains, TheBrightestGrainsStayNear) {
    Facade wall;
    make_bright(wall, 2, 1e6f);
    EXPECT_EQ(wall.divide(), 1);
    EXPECT_EQ(wall.pixel(kX + 17, kY), kEven);
    EXPECT_GT(wall.pixel(kX + 15, kY), kEven);
    EXPECT_NEAR(wall.all(), 0.25e6 + kAcross * kDown, 1.0);
}

// Two samples alike are no grain, nor is the brightest of three that make most of the pixel together.
TEST(DividedGrains, WhatSeveralSamplesFindStays) {
    for (const std::array<float, 3>& found :
         {std::array{1000.0f, 1000.0f, kEven}, std::array{1000.0f, 700.0f, 700.0f}}) {
        Facade wall;
        for (int ray = 0; ray < 3; ++ray)
            make_bright(wall, ray, found[std::size_t(ray)]);
        EXPECT_EQ(wall.divide(), 0);
        EXPECT_NEAR(wall.pixel(kX, kY), (found[0] + found[1] + found[2] + kEven) / kRaysOfPixel, 1e-3f);
    }
}

// One sample of each pixel may find all of its light, as where the samples divide the lamps among themselves: on an
// even wall, in a line one pixel wide, and at the edge of a shadow.
TEST(DividedGrains, WhatPixelsAroundShowTooStays) {
    struct Case {
        std::function<bool(int, int)> lit;
        int grains;  // three at each end of a line
    };
    const Case cases[] = {{[](int, int) { return true; }, 0},
                          {[](int x, int) { return x < kX; }, 0},
                          {[](int x, int) { return x == kX; }, 6},
                          {[](int x, int y) { return x == y; }, 6}};
    for (const Case& c : cases) {
        Facade wall;
        for (int y = 0; y < kDown; ++y)
            for (int x = 0; x < kAcross; ++x)
                for (int k = 0; k < kRaysOfPixel; ++k)
                    wall.found[Facade::at(x, y, k)].at(Cell::SA) = Rgb(k == 1 && c.lit(x, y) ? 10.0f : 0.1f);
        EXPECT_EQ(wall.divide(), c.grains);
    }
}

// A sample that makes less than half of its pixel stays, and so does one whose pixel does not stand out.
TEST(DividedGrains, NoiseBelowHalfOfThePixelStays) {
    Facade dim, bright, among_bright;
    make_bright(dim, 0, 2.9f);
    EXPECT_EQ(dim.divide(), 0);
    make_bright(bright, 0, 3.1f);
    EXPECT_EQ(bright.divide(), 1);
    for (std::size_t i = 0; i < among_bright.found.size(); ++i)
        if (i / kRaysOfPixel != Facade::at(kX, kY, 0) / kRaysOfPixel)
            among_bright.found[i].at(Cell::SA) = Rgb(1.1f);
    make_bright(among_bright, 0, 3.1f);
    EXPECT_EQ(among_bright.divide(), 0);
}

// The first of four passes stands for a quarter of what was shown of it; what other passes found was not.
TEST(DividedGrains, PassesDivideWhatTheyShow) {
    Facade first, further;
    make_bright(first, 0, 32.0f);
    EXPECT_EQ(first.divide(0.25f, 4.0f), 1);
    EXPECT_NEAR(first.all(), 0.25 * (kAcross * kDown * kEven + (32.0 - kEven) / kRaysOfPixel), 1e-3);
    // By a sample of even light more, a pixel that shows 1 has 1 besides.
    EXPECT_EQ(further.divide(0.25f, 0.0f), 0);
}

// Half of the picture shows another thing, the same thing turned, or the same thing farther off.
TEST(DividedGrains, AWideSurfaceKeepsItsGrains) {
    for (const Surface& other : {Surface{1, vec3(0.0f, 0.0f, 1.0f), 100.0}, Surface{0, vec3(1.0f, 0.0f, 0.0f), 100.0},
                                 Surface{0, vec3(0.0f, 0.0f, 1.0f), 110.0}}) {
        Facade wall([&](int x, int) { return x <= kX ? Surface{} : other; });
        make_bright(wall, 1, 1000.0f);
        EXPECT_EQ(wall.divide(), 1);
        EXPECT_EQ(wall.pixel(kX + 1, kY), kEven);
        EXPECT_GT(wall.pixel(kX - 1, kY), 1.2f * kEven);
        EXPECT_NEAR(wall.all(), kAcross * kDown * kEven + (1000.0 - kEven) / kRaysOfPixel, 1e-2);
    }
}

// A bolt of a pixel on a thin rail: its grain falls to the rail, and not to the wall behind. A speck before a wall
// leaves its grain to that.
TEST(DividedGrains, ThinThingsShareWithWhatIsNext) {
    const Surface bolt{1, vec3(0.0f, 1.0f, 0.0f), 50.0};
    Facade rail([&](int x, int y) {
        return x == kX && y == kY ? bolt : x == kX ? Surface{1, vec3(0.0f, 0.0f, 1.0f), 50.0} : Surface{};
    });
    make_bright(rail, 0, 1000.0f);
    EXPECT_EQ(rail.divide(), 1);
    EXPECT_EQ(rail.pixel(kX + 1, kY), kEven);
    EXPECT_GT(rail.pixel(kX, kY + 1), 5.0f * kEven);
    EXPECT_NEAR(rail.all(), kAcross * kDown * kEven + (1000.0 - kEven) / kRaysOfPixel, 1e-2);

    Facade speck([&](int x, int y) { return x == kX && y == kY ? bolt : Surface{}; });
    make_bright(speck, 0, 1000.0f);
    EXPECT_EQ(speck.divide(), 1);
    EXPECT_GT(speck.pixel(kX + 1, kY), 1.2f * kEven);
    EXPECT_NEAR(speck.all(), kAcross * kDown * kEven + (1000.0 - kEven) / kRaysOfPixel, 1e-2);
}

// Where smoke hides most of a wall, little of its light is shown, grains included.
TEST(DividedGrains, HiddenPixelsTakeLess) {
    Facade wall;
    for (std::size_t i = 0; i < wall.samples.size(); ++i)
        if (wall.samples[i].pixel % kAcross > std::uint32_t(kX))
            wall.samples[i].share *= 0.01f;
    make_bright(wall, 0, 100.0f);
    EXPECT_EQ(wall.divide(), 1);
    const float left = wall.pixel(kX - 1, kY) - kEven, right = wall.pixel(kX + 1, kY) - 0.01f * kEven;
    EXPECT_NEAR(right, 0.01f * left, 1e-3f * left);
}

// What is not finite is reported with the pixel that has it, and does not keep others from being divided.
TEST(DividedGrains, WhatIsNotANumberStays) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Facade wall;
        make_bright(wall, 0, bad);
        wall.found[Facade::at(kX + 2, kY, 0)].at(Cell::SA) = Rgb(8.0f);
        EXPECT_EQ(wall.divide(), 1);
        EXPECT_FALSE(std::isfinite(wall.pixel(kX, kY)));
        EXPECT_LT(wall.pixel(kX + 2, kY), kEven);
    }
}

// A further pass finds what the first one has not shown.
TEST(DividedGrains, WhatFurtherPassesReportIsNotDividedEither) {
    const Facade wall;
    std::vector<GrainFinder::Shown> shown;
    for (std::size_t i = 0; i < wall.samples.size(); ++i)
        shown.push_back({wall.samples[i].share * kEven, wall.normals[i]});
    DividedGrains grains(kAcross, kFirstRow + kDown);
    GrainFinder finder(wall.samples, shown, kAcross, nullptr, grains);
    CellSum bad, bright;
    bad.at(Cell::SA) = Rgb(std::numeric_limits<float>::infinity());
    bright.at(Cell::SA) = Rgb(100.0f);
    EXPECT_FALSE(finder.take({Facade::at(kX, kY, 0), bad, {}, 0.25f, 0.0f}));
    EXPECT_TRUE(finder.take({Facade::at(kX, kY, 0), bright, {}, 0.25f, 0.0f}));
}

// Light of which one sample in five hundred finds all: grains leave a fifth of its noise at most, and the mean to the
// last digits.
TEST(DividedGrains, RareLightLosesItsNoiseAndKeepsItsMean) {
    constexpr float kBright = 500.0f;
    Facade wall;
    Rng rng(Stream::Surface, 11);
    double before = 0.0, noise = 0.0, after = 0.0;
    for (CellSum& f : wall.found)
        f.at(Cell::SA) = Rgb(rng.next() < 1.0f / kBright ? kBright : 0.0f);
    for (std::size_t i = 0; i < wall.found.size(); i += kRaysOfPixel) {
        double pixel = 0.0;
        for (int k = 0; k < kRaysOfPixel; ++k)
            pixel += wall.found[i + std::size_t(k)].at(Cell::SA).y / kRaysOfPixel;
        before += pixel;
        noise += (pixel - 1.0) * (pixel - 1.0);
    }
    EXPECT_GT(wall.divide(), 5);
    for (const float pixel : wall.pixels)
        after += (pixel - 1.0) * (pixel - 1.0);
    EXPECT_NEAR(wall.all(), before, 1e-4 * before);
    EXPECT_LT(after, 0.2 * noise);
}

// A sample that leaves its light to all pixels keeps nothing there, and its cells stay apart. What many pixels share is
// no grain: their mean divides it.
TEST(DividedGrains, WhatIsLeftToFewPixelsIsDividedToo) {
    const Facade wall;
    const std::size_t grain = Facade::at(kX, kY, 0);
    SharedBounce shared(kAcross, kDown + kFirstRow, 0.1, kRaysOfPixel, {SharedBounce::Apart::SV});
    DividedGrains grains(kAcross, kDown + kFirstRow);
    const auto take = [&](SharedBounce::Sample& left) {
        std::vector<GrainFinder::Shown> shown;
        for (std::size_t i = 0; i < wall.samples.size(); ++i)
            shown.push_back({wall.samples[i].share * kEven, wall.normals[i]});
        shown[grain].luminance += luminance(left.shown());
        return GrainFinder(wall.samples, shown, kAcross, &shared, grains)
            .take({grain, wall.found[grain], {nullptr, &left}, 1.0f, 1.0f});
    };
    SharedBounce::Sample left;
    left.pixel_size = left.area = 1.0f;
    left.weight = Rgb(0.25f);
    left.light = Rgb(40.0f);
    left.of(SharedBounce::Apart::SV) = Rgb(20.0f);
    left.closeness = 1e-4f;  // many pixels share
    EXPECT_FALSE(take(left));
    EXPECT_EQ(left.light, Rgb(40.0f));
    left.closeness = 1.0f;     // none does
    EXPECT_FALSE(take(left));  // what it sees besides is no part of the grain
    EXPECT_EQ(left.shown(), Rgb(0.0f));
    grains.divide();
    const auto all = [&](Cell cell) {
        double sum = 0.0;
        for (const Rgb& p : grains.pixels(cell))
            sum += p.y;
        return sum;
    };
    EXPECT_NEAR(all(Cell::SS), 10.0, 1e-3);
    EXPECT_NEAR(all(Cell::SV), 5.0, 1e-3);
    EXPECT_EQ(all(Cell::SA), 0.0);
    EXPECT_EQ(all(Cell::SM), 0.0);
}

}  // namespace
}  // namespace brisance
