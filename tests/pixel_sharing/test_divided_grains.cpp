// Grains among the pixels around: energy is kept, surfaces are kept apart where they are wide enough, and what several
// samples find stays where it is.
#include <gtest/gtest.h>

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
    std::vector<float> pixels;  // after divide()
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

    // Returns how many samples are grains.
    int divide() {
        std::vector<GrainFinder::Shown> shown;
        for (std::size_t i = 0; i < samples.size(); ++i)
            shown.push_back({samples[i].share * luminance(found[i]), normals[i]});
        DividedGrains grains(kAcross, kFirstRow + kDown);
        GrainFinder finder(samples, shown, kAcross, nullptr, grains);
        int count = 0;
        pixels.assign(std::size_t(kAcross) * kDown, 0.0f);
        for (std::size_t i = 0; i < samples.size(); ++i)
            if (finder.take(i, 1.0f, found[i], {}))
                ++count;
            else
                pixels[i / kRaysOfPixel] += samples[i].share * found[i].at(Cell::SA).y;
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

// Twice the light of its pixel by one sample: no pixel shows more than a twentieth of that besides.
TEST(DividedGrains, OneBrightSampleIsDividedAmongThePixelsAroundAndKeepsItsEnergy) {
    Facade wall;
    make_bright(wall, 2, 8.0f);
    EXPECT_EQ(wall.divide(), 1);
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) {
            const bool own = x == kX && y == kY, far = std::hypot(x - kX, y - kY) > 7.0;
            const float part = wall.pixel(x, y) - (own ? kEven * 3 / 4 : kEven);
            EXPECT_GE(part, far ? 0.0f : -1e-6f) << x << " " << y;
            EXPECT_LE(part, far ? 0.0f : 0.052f) << x << " " << y;
        }
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

TEST(DividedGrains, WhatSeveralSamplesFindStays) {
    Facade wall;
    for (int ray = 0; ray < 3; ++ray)
        make_bright(wall, ray, 1000.0f);
    EXPECT_EQ(wall.divide(), 0);
    EXPECT_NEAR(wall.pixel(kX, kY), (3.0f * 1000.0f + kEven) / kRaysOfPixel, 1e-3f);
}

// Of four samples, one that is 1.4 times as bright as the others brings less than half of what they do. One that is
// three times as bright brings as much, and stands out where the pixels around are no brighter.
TEST(DividedGrains, NoiseBelowHalfOfThePixelStays) {
    Facade dim, bright, among_bright;
    make_bright(dim, 0, 1.4f);
    EXPECT_EQ(dim.divide(), 0);
    make_bright(bright, 0, 3.0f);
    EXPECT_EQ(bright.divide(), 1);
    for (std::size_t i = 0; i < among_bright.found.size(); ++i)
        if (i / kRaysOfPixel != Facade::at(kX, kY, 0) / kRaysOfPixel)
            among_bright.found[i].at(Cell::SA) = Rgb(10.0f);
    make_bright(among_bright, 0, 3.0f);
    EXPECT_EQ(among_bright.divide(), 0);
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

// What the caller reports as not finite must stay in the pixel that has it.
TEST(DividedGrains, WhatIsNotANumberStays) {
    Facade wall;
    make_bright(wall, 0, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(wall.divide(), 0);
    EXPECT_EQ(wall.pixel(kX + 1, kY), kEven);
}

// Light of which one sample in fifty finds all: grains leave a fifth of its noise at most, and the mean to the last
// digits.
TEST(DividedGrains, RareLightLosesItsNoiseAndKeepsItsMean) {
    Facade wall;
    Rng rng(Stream::Surface, 11);
    double sum = 0.0, squares = 0.0, before = 0.0;
    for (CellSum& f : wall.found)
        f.at(Cell::SA) = Rgb(rng.next() < 0.02f ? 50.0f : 0.0f);
    for (const CellSum& f : wall.found)
        before += f.at(Cell::SA).y / kRaysOfPixel;
    double noise = 0.0;
    for (std::size_t i = 0; i < wall.found.size(); i += kRaysOfPixel) {
        double pixel = 0.0;
        for (int k = 0; k < kRaysOfPixel; ++k)
            pixel += wall.found[i + std::size_t(k)].at(Cell::SA).y / kRaysOfPixel;
        noise += (pixel - 1.0) * (pixel - 1.0);
    }
    EXPECT_GT(wall.divide(), 5);
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) {
            sum += wall.pixel(x, y);
            squares += (wall.pixel(x, y) - 1.0) * (wall.pixel(x, y) - 1.0);
        }
    EXPECT_NEAR(sum, before, 1e-4 * before);
    EXPECT_LT(squares, 0.2 * noise);
}

// A sample that leaves its light to all pixels keeps nothing there, and its cells stay apart.
TEST(DividedGrains, WhatIsLeftToAllPixelsIsDividedToo) {
    const Facade wall;
    SharedBounce shared(kAcross, kDown + kFirstRow, 0.1, kRaysOfPixel, {SharedBounce::Apart::SV});
    std::vector<GrainFinder::Shown> shown;
    for (std::size_t i = 0; i < wall.samples.size(); ++i)
        shown.push_back({wall.samples[i].share * kEven, wall.normals[i]});
    SharedBounce::Sample left;
    left.pixel_size = left.area = 1.0f;
    left.closeness = 1.0f;  // no two pixels share
    left.weight = Rgb(0.25f);
    left.light = Rgb(800.0f);
    left.of(SharedBounce::Apart::SV) = Rgb(400.0f);
    const std::size_t grain = Facade::at(kX, kY, 0);
    shown[grain].luminance += luminance(left.shown());
    DividedGrains grains(kAcross, kDown + kFirstRow);
    GrainFinder finder(wall.samples, shown, kAcross, &shared, grains);
    SharedBounce::Sample* const of_sample[] = {nullptr, &left};
    ASSERT_TRUE(finder.take(grain, 1.0f, wall.found[grain], of_sample));
    EXPECT_EQ(left.shown(), Rgb(0.0f));
    const auto all = [&](Cell cell) {
        double sum = 0.0;
        for (const Rgb& p : grains.pixels(cell))
            sum += p.y;
        return sum;
    };
    EXPECT_NEAR(all(Cell::SS), 200.0, 1e-2);
    EXPECT_NEAR(all(Cell::SV), 100.0, 1e-2);
    EXPECT_NEAR(all(Cell::SA), kEven / kRaysOfPixel, 1e-4);
    EXPECT_EQ(all(Cell::SM), 0.0);
}

}  // namespace
}  // namespace brisance
