// Grains among the pixels around: energy is kept, surfaces are kept apart where they are wide enough, and what several
// samples find stays where it is.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/rng.h"
#include "pixel_sharing/divided_grains.h"

namespace brisance {
namespace {

constexpr int kAcross = 15, kDown = 15, kFirstRow = 4, kRaysOfPixel = 4;
constexpr int kX = 7, kY = 7;
constexpr float kEven = 1.0f;

struct Surface {
    std::uint32_t mesh = 0;
    vec3 normal{0.0f, 0.0f, 1.0f};
    double depth = 100.0;  // [m]
};

// A picture of surfaces that face the camera, one to a pixel. All samples see the same light, but for what a test sets.
struct Facade {
    std::vector<SurfaceSample> samples;
    std::vector<CellSum> found, light;
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
        light.resize(samples.size());
    }

    static std::size_t at(int x, int y, int ray) {
        return (std::size_t(y) * kAcross + std::size_t(x)) * kRaysOfPixel + ray;
    }

    // Returns how many samples are grains.
    int divide() {
        std::vector<DividedGrains::Shown> shown;
        for (std::size_t i = 0; i < samples.size(); ++i)
            shown.push_back({samples[i].share * luminance(found[i]), normals[i]});
        const DividedGrains grains(samples, shown, kAcross, nullptr);
        int count = 0;
        for (std::size_t i = 0; i < samples.size(); ++i)
            if (grains.divide(i, 1.0f, found[i], {}, light))
                ++count;
            else
                light[i].add(found[i], Rgb(1.0f));
        return count;
    }

    float pixel(int x, int y) const {
        float sum = 0.0f;
        for (int k = 0; k < kRaysOfPixel; ++k)
            sum += samples[at(x, y, k)].share * light[at(x, y, k)].at(Cell::SA).y;
        return sum;
    }
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

TEST(DividedGrains, OneBrightSampleIsDividedAmongThePixelsAroundAndKeepsItsEnergy) {
    Facade wall;
    make_bright(wall, 2, 1000.0f);
    EXPECT_EQ(wall.divide(), 1);
    const float part = 1000.0f / kRaysOfPixel / 49.0f;
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) {
            const float own = x == kX && y == kY ? kEven * (kRaysOfPixel - 1) / kRaysOfPixel : kEven;
            const bool near = std::abs(x - kX) <= 3 && std::abs(y - kY) <= 3;
            EXPECT_NEAR(wall.pixel(x, y), own + (near ? part : 0.0f), 1e-5f) << x << " " << y;
        }
    EXPECT_NEAR(wall.all(), kAcross * kDown * kEven + (1000.0 - kEven) / kRaysOfPixel, 1e-3);
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
        EXPECT_NEAR(wall.pixel(kX, kY), kEven * 3 / 4 + 1000.0f / kRaysOfPixel / 28.0f, 1e-4f);
    }
}

// A rail one pixel wide, of which half shows another side: its grains fall to both sides of it, and not to the wall
// behind. A speck of one pixel leaves its grain to that.
TEST(DividedGrains, ThinThingsShareWithWhatIsNext) {
    const auto rail = [](int x, int y) {
        return x != kX ? Surface{} : Surface{1, y < kY ? vec3(0.0f, 0.0f, 1.0f) : vec3(0.0f, 1.0f, 0.0f), 50.0};
    };
    Facade railing([&](int x, int y) {
        return std::abs(x - kX) == 1 ? Surface{1, vec3(1.0f, 0.0f, 0.0f), 50.0} : rail(x, y);
    });
    make_bright(railing, 0, 1000.0f);
    EXPECT_EQ(railing.divide(), 1);
    EXPECT_EQ(railing.pixel(kX + 2, kY), kEven);
    EXPECT_NEAR(railing.pixel(kX + 1, kY), kEven + 1000.0f / kRaysOfPixel / 21.0f, 1e-4f);

    Facade speck([](int x, int y) {
        return x == kX && y == kY ? Surface{1, vec3(0.0f, 1.0f, 0.0f), 50.0} : Surface{};
    });
    make_bright(speck, 0, 1000.0f);
    EXPECT_EQ(speck.divide(), 1);
    EXPECT_NEAR(speck.pixel(kX + 1, kY), kEven + 1000.0f / kRaysOfPixel / 49.0f, 1e-4f);
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
    std::vector<DividedGrains::Shown> shown;
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
    const DividedGrains grains(wall.samples, shown, kAcross, &shared);
    std::vector<CellSum> light(wall.samples.size());
    SharedBounce::Sample* const of_sample[] = {nullptr, &left};
    ASSERT_TRUE(grains.divide(grain, 1.0f, wall.found[grain], of_sample, light));
    EXPECT_EQ(left.shown(), Rgb(0.0f));
    CellSum all;
    for (std::size_t i = 0; i < light.size(); ++i)
        all.add(light[i], Rgb(wall.samples[i].share));
    EXPECT_NEAR(all.at(Cell::SS).y, 200.0f, 1e-3f);
    EXPECT_NEAR(all.at(Cell::SV).y, 100.0f, 1e-3f);
    EXPECT_NEAR(all.at(Cell::SA).y, kEven / kRaysOfPixel, 1e-5f);
}

}  // namespace
}  // namespace brisance
