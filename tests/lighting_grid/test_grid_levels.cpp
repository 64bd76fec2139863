// Operations on a finished hierarchy: other lights, look-ups, many lights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/rng.h"
#include "fixtures/media.h"

namespace brisance {
namespace {

using testing::black_smoke;
using testing::cube;
using testing::Lit;
using testing::make_medium;
using testing::noise;
using testing::Recipe;

Recipe haze() {
    Recipe r;
    r.box = cube(-13, 26);
    r.density = [](const ivec3& n) { return noise(n, 1) > 0.7f ? 1.0f : 0.0f; };
    r.flame = [](const ivec3& n) { return noise(n, 2); };
    r.settings = black_smoke();
    return r;
}

TEST(GridLevels, SettingTheSameLightsChangesNothing) {
    Lit lit(make_medium(haze()));
    const LightingGrid built = lit.grid;
    for (GridLevel& level : lit.grid.levels)
        level.intensity.assign(level.size(), Rgb(-1.0f));
    set_intensity(lit.grid, lit.medium.lattice, lit.intensity, nullptr);
    for (std::size_t l = 0; l < built.levels.size(); ++l) {
        const GridLevel &a = built.levels[l], &b = lit.grid.levels[l];
        EXPECT_EQ(a.position, b.position);
        for (std::size_t i = 0; i < a.size(); ++i)
            ASSERT_NEAR(b.intensity[i].x / a.intensity[i].x, 1.0f, 1e-5f);
    }
}

TEST(GridLevels, OtherLightsAreCarriedWhole) {
    Lit lit(make_medium(haze()));
    std::vector<Rgb> other(lit.intensity.size());
    std::vector<float> directional(lit.intensity.size() * 24, 0.0f);
    std::vector<double> sums(24, 0.0);
    for (std::size_t i = 0; i < other.size(); ++i) {
        if (lit.intensity[i].x <= 0.0f)
            continue;
        other[i] = Rgb(float(i % 5), 1.0f, float(i % 3));
        for (int m = 0; m < 24; ++m)
            sums[m] += directional[i * 24 + m] = float(i % (m + 2)) - 0.3f * m;
    }
    set_intensity(lit.grid, lit.medium.lattice, other, &directional);
    for (const GridLevel& level : lit.grid.levels) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(total(level.intensity)[c] / total(other)[c], 1.0, 1e-5);
        for (int m = 0; m < 24; ++m) {
            double sum = 0.0;
            for (std::size_t i = 0; i < level.size(); ++i)
                sum += level.directional[i * 24 + m];
            EXPECT_NEAR(sum, sums[m], 1e-5 * std::abs(sums[m]) + 0.05);
        }
    }
    set_intensity(lit.grid, lit.medium.lattice, other, nullptr);
    EXPECT_TRUE(lit.grid.levels[0].directional.empty());
}

TEST(GridLevels, ABoxFindsItsLightsAndNoOthers) {
    const Lit lit(make_medium(haze()));
    Rng rng(Stream::EscapeRay, 3);
    for (const GridLevel& level : lit.grid.levels)
        for (int trial = 0; trial < 200; ++trial) {
            ivec3 low(0), high(0);
            for (int a = 0; a < 3; ++a) {
                low[a] = static_cast<int>(rng.next() * 60.0f) - 30;
                high[a] = low[a] + static_cast<int>(rng.next() * 20.0f) - 2;  // sometimes empty
            }
            std::vector<std::uint32_t> found, expected;
            level.find_in_box(low, high, found);
            for (std::uint32_t i = 0; i < level.size(); ++i)
                if (glm::all(glm::greaterThanEqual(level.vertex[i], low)) &&
                    glm::all(glm::lessThanEqual(level.vertex[i], high)))
                    expected.push_back(i);
            ASSERT_EQ(found, expected);
        }
}

TEST(GridLevels, ALookUpAppendsToWhatWasFoundBefore) {
    const Lit lit(make_medium(haze()));
    std::vector<std::uint32_t> found = {7u};
    lit.grid.levels[0].find_in_box(ivec3(-100), ivec3(100), found);
    EXPECT_EQ(found.size(), lit.grid.levels[0].size() + 1);
    EXPECT_EQ(found.front(), 7u);
}

TEST(GridLevels, TheTopLevelHasAHandfulOfLights) {
    const Lit lit(make_medium(haze()));
    EXPECT_LE(lit.grid.levels.back().size(), 343u);
    Recipe tiny = haze();
    tiny.box = cube(1, 3);
    EXPECT_GE(automatic_levels(make_medium(tiny)), 1);
}

TEST(GridLevels, AMillionLightsAreNoTrouble) {
    Recipe r = haze();
    r.box = cube(0, 99);
    r.density = r.flame = [](const ivec3&) { return 1.0f; };
    Lit lit(make_medium(r));
    const auto lights = std::count_if(lit.intensity.begin(), lit.intensity.end(), [](const Rgb& i) { return i.x > 0; });
    EXPECT_GE(lights, 1000000);
    for (const GridLevel& level : lit.grid.levels)
        EXPECT_NEAR(total(level.intensity).x / total(lit.intensity).x, 1.0, 1e-5);
}

TEST(GridLevels, WithoutLightsThereAreNoLevels) {
    Recipe r = haze();
    r.flame = nullptr;
    const Medium medium = make_medium(r);
    EXPECT_TRUE(build_lighting_grid(medium, {}, nullptr, 4).levels.empty());
}

}  // namespace
}  // namespace brisance
