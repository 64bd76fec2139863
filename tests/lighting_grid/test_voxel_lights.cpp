// Lights carry the energy of the field the camera sees.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fixtures/media.h"
#include "medium/coarse_medium.h"

namespace brisance {
namespace {

using testing::black_smoke;
using testing::cube;
using testing::cubic;
using testing::make_medium;
using testing::noise;
using testing::Recipe;
using testing::transform;

struct Integral {
    dvec3 total{0.0};  // of j dV, per colour
    dvec3 first{0.0};  // of j_red x dV, local [m]
};

template <class T>
T node_value(const Medium& medium, const std::vector<T>& field, const ivec3& node) {
    const std::int64_t i = field.empty() ? -1 : medium.lattice.find_node(node);
    return i < 0 ? T(0.0f) : field[i];
}

// Four Gauss points per axis and cell: exact to degree seven, where three would do for x times j.
Integral integral_of_emission(const Medium& medium, const ivec3& low, const ivec3& high) {
    constexpr std::array<double, 4> point = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                             0.93056815579702629};
    constexpr std::array<double, 4> weight = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                              0.17392742256872693};
    Integral sum;
    const double volume = medium.voxel_volume;
    for (int x = low.x; x < high.x; ++x)
        for (int y = low.y; y < high.y; ++y)
            for (int z = low.z; z < high.z; ++z)
                for (int g = 0; g < 64; ++g) {
                    const dvec3 t(point[g & 3], point[g >> 2 & 3], point[g >> 4]);
                    double sigma = 0.0;
                    dvec3 source(0.0), emission(0.0);
                    for (int k = 0; k < 8; ++k) {
                        const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
                        const double w = (d.x ? t.x : 1 - t.x) * (d.y ? t.y : 1 - t.y) * (d.z ? t.z : 1 - t.z);
                        const ivec3 node = ivec3(x, y, z) + d;
                        sigma += w * node_value(medium, medium.extinction, node);
                        source += w * dvec3(node_value(medium, medium.source, node));
                        emission += w * dvec3(node_value(medium, medium.emission, node));
                    }
                    const dvec3 j =
                        (sigma * source + emission) * volume * weight[g & 3] * weight[g >> 2 & 3] * weight[g >> 4];
                    const dvec3 p =
                        dmat3(medium.world_from_index) * (dvec3(ivec3(x, y, z) - medium.reference_node) + t);
                    sum.total += j;
                    sum.first += j.x * p;
                }
    return sum;
}

// Everything random, with holes: neighbouring nodes have nothing in common.
Recipe noisy_fire(EmissionConvention convention) {
    Recipe r;
    r.box = cube(-5, 10);
    r.world_from_index = transform(testing::some_linear_map(), {3.0, -2.0, 1.0});
    r.density = [](const ivec3& n) { return noise(n, 1) > 0.3f ? noise(n, 2) : 0.0f; };
    r.flame = [](const ivec3& n) { return noise(n, 3) > 0.5f ? 4.0f * noise(n, 4) : 0.0f; };
    r.colour = [](const ivec3& n) { return Rgb(noise(n, 5), noise(n, 6), noise(n, 7)); };
    r.settings = black_smoke();
    r.settings.colour_role = ColourRole::Emission;
    r.settings.fire.convention = convention;
    return r;
}

ivec3 lowest_cell(const Medium& medium) {
    return medium.lattice.min_brick() * 8 - 1;
}
ivec3 cells_end(const Medium& medium) {
    return lowest_cell(medium) + medium.lattice.brick_extent() * 8 + 2;
}

dvec3 first_moment(const Medium& medium, const std::vector<Rgb>& lights) {
    dvec3 sum(0.0);
    for (std::size_t i = 0; i < lights.size(); ++i)
        sum +=
            double(lights[i].x) *
            dvec3(medium.local_of_node(medium.lattice.first_node(i / 512) + BrickLattice::node_in_brick(int(i % 512))));
    return sum;
}

TEST(VoxelLights, SumToTheExactIntegralOfTheInterpolatedEmission) {
    for (const auto convention : {EmissionConvention::TimesAbsorption, EmissionConvention::Direct}) {
        const Medium medium = make_medium(noisy_fire(convention));
        const std::vector<Rgb> lights = voxel_lights(medium);
        const Integral expected = integral_of_emission(medium, lowest_cell(medium), cells_end(medium));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(total(lights)[c] / expected.total[c], 1.0, 1e-5);
        for (const Rgb& light : lights)
            ASSERT_TRUE(light.x >= 0.0f && light.y >= 0.0f && light.z >= 0.0f);
    }
}

TEST(VoxelLights, TheProjectionKeepsTheFirstMomentOfEvenTheNoisiestField) {
    const Medium medium = make_medium(noisy_fire(EmissionConvention::TimesAbsorption));
    const Integral expected = integral_of_emission(medium, lowest_cell(medium), cells_end(medium));
    const std::vector<Rgb> lights = project_extinction_times(medium, medium.source);
    EXPECT_NEAR(total(lights).x / expected.total.x, 1.0, 1e-5);
    const dvec3 centre = expected.first / expected.total.x;
    EXPECT_LT(glm::length(first_moment(medium, lights) / total(lights).x - centre), 1e-5 * medium.spacing);
}

// Smooth fire: sharpening has nothing to limit and moves no light on the whole.
TEST(VoxelLights, AreCentredWhereTheFireIs) {
    Recipe r = noisy_fire(EmissionConvention::Direct);
    r.box = cube(-20, 28);
    r.flame = [](const ivec3& n) { return std::exp(-0.02f * glm::dot(vec3(n - 3), vec3(n - 3)) - 0.01f * n.x); };
    r.colour = nullptr;
    const Medium medium = make_medium(r);
    const Integral expected = integral_of_emission(medium, lowest_cell(medium), cells_end(medium));
    const std::vector<Rgb> lights = voxel_lights(medium);
    const dvec3 centre = expected.first / expected.total.x;
    EXPECT_LT(glm::length(first_moment(medium, lights) / total(lights).x - centre), 1e-4 * medium.spacing);
}

TEST(Sharpening, MakesNoLightAndNoDarkness) {
    const Medium medium = make_medium(noisy_fire(EmissionConvention::TimesAbsorption));
    const std::vector<Rgb> before = project_extinction_times(medium, medium.source);
    std::vector<Rgb> after = before;
    sharpen_lights(medium.lattice, after);
    EXPECT_NE(before, after);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(total(after)[c] / total(before)[c], 1.0, 1e-6);
    for (const Rgb& light : after)
        ASSERT_TRUE(light.x >= 0.0f && light.y >= 0.0f && light.z >= 0.0f);
}

// Fire on a lattice, as lights on it and on coarser ones. Lights that were sharpened before they were splatted down are
// sharpened by what that left.
TEST(Sharpening, UndoesTheSpreadOfTheSplat) {
    Recipe r;
    r.box = cube(-24, 24);
    r.flame = [](const ivec3& n) { return std::exp(-0.01f * glm::dot(vec3(n), vec3(n))); };
    r.settings = black_smoke();
    r.settings.fire.convention = EmissionConvention::Direct;
    const Medium medium = make_medium(r);
    const auto variance = [&](const std::vector<Rgb>& lights, const BrickLattice& lattice, int level) {
        double second = 0.0;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const int x = (lattice.first_node(i / 512).x + BrickLattice::node_in_brick(int(i % 512)).x) << level;
            second += double(lights[i].x) * x * x;
        }
        return second / total(lights).x;
    };
    // Node values spread by the camera's own hats: variance 1/6 more; the splat's second spread is what must go.
    const double of_the_field = variance(medium.emission, medium.lattice, 0) + 1.0 / 6.0;
    EXPECT_NEAR(variance(voxel_lights(medium), medium.lattice, 0), of_the_field, 2e-3);
    for (const int level : {1, 2})
        for (const int sharpened_below : {0, level}) {
            const std::vector<Rgb> fine = sharpened_below > 0 ? voxel_lights(medium) : voxel_lights_unsharpened(medium);
            const Averages means = averaged_down(medium.lattice, flattened(fine), 3, level);
            std::vector<Rgb> lights(means.values.size() / 3);
            for (std::size_t i = 0; i < lights.size(); ++i)
                lights[i] = {means.values[3 * i], means.values[3 * i + 1], means.values[3 * i + 2]};
            sharpen_lights(means.lattice, lights, sharpened_below);
            const double spread = std::exp2(2.0 * level) / 6.0;
            EXPECT_NEAR(variance(lights, means.lattice, level), of_the_field, 0.01 * spread)
                << level << ' ' << sharpened_below;
        }
}

TEST(Sharpening, GivesAnInterpolantTheAveragesOfASmoothField) {
    Recipe r;
    r.box = cube(0, 15);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    const Medium medium = make_medium(r);
    const BrickLattice& lattice = medium.lattice;
    std::vector<float> values(lattice.node_count());
    std::vector<std::uint8_t> mask(lattice.node_count(), 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const ivec3 n = lattice.first_node(i / 512) + BrickLattice::node_in_brick(int(i % 512));
        mask[i] = glm::all(glm::greaterThanEqual(n, ivec3(0))) && glm::all(glm::lessThanEqual(n, ivec3(15)));
        values[i] = 100.0f + float(n.x * n.x) - 0.5f * float(n.y * n.y);
    }
    const std::vector<float> before = values;
    sharpen_interpolant(lattice, mask, values);
    for (int x = 2; x < 13; ++x)
        for (int y = 2; y < 13; ++y) {
            // Along x the mean of t^2 over [x, x+1] is x^2 + x + 1/3; a trilinear cell's mean is its corners' mean.
            const auto mean = [](double t) { return t * t + t + 1.0 / 3.0; };
            double corners = 0.0;
            for (int k = 0; k < 8; ++k)
                corners += 0.125 * values[lattice.find_node({x + (k >> 2), y + (k >> 1 & 1), 5 + (k & 1)})];
            ASSERT_NEAR(corners, 100.0 + mean(x) - 0.5 * mean(y), 1e-4);
        }
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!mask[i]) {
            ASSERT_EQ(values[i], before[i]);
        }
}

TEST(VoxelLights, OfOneNodeStayWithinItsHat) {
    Recipe r;
    r.box = cube(0, 15);
    r.flame = [](const ivec3& n) { return n == ivec3(8) ? 1.0f : 0.0f; };
    r.settings = black_smoke();
    r.settings.fire.convention = EmissionConvention::Direct;
    const Medium medium = make_medium(r);
    const std::vector<Rgb> lights = voxel_lights(medium);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const ivec3 n = medium.lattice.first_node(i / 512) + BrickLattice::node_in_brick(int(i % 512));
        const ivec3 away = glm::abs(n - 8);
        if (std::max({away.x, away.y, away.z}) > 1) {
            ASSERT_EQ(lights[i].x, 0.0f);
        }
    }
    EXPECT_GT(lights[medium.lattice.find_node(ivec3(8))].x, 8.0f / 27.0f);  // the mass matrix alone: (2/3)^3
    EXPECT_NEAR(total(lights).x, 1.0, 1e-6);
}

TEST(VoxelLights, OfAThinBallRadiateWhatTheClosedFormSays) {
    const Medium medium = make_medium(testing::glowing_ball(16, 1e-3f));
    const double pi = 3.14159265358979;
    const double power = 4.0 * pi * total(voxel_lights(medium)).x;
    EXPECT_NEAR(power / (4.0 * pi * 1e-3 * 4.0 / 3.0 * pi), 1.0, 2e-3);
}

TEST(VoxelLights, ExtinctionTimesOneIsTheSmokeItself) {
    // Nodes around the smoke are stored as well: a hat that reached beyond them would find a factor of 0.
    Recipe padded = noisy_fire(EmissionConvention::TimesAbsorption);
    padded.box = cube(-20, 25);
    padded.density = [](const ivec3& n) {
        return glm::any(glm::greaterThan(glm::abs(n - 3), ivec3(6))) ? 0.0f : noise(n, 2);
    };
    const Medium inner = make_medium(padded);
    double expected = 0.0;
    for (const float e : inner.extinction)
        expected += double(e) * inner.voxel_volume;
    const std::vector<Rgb> factor(inner.lattice.node_count(), Rgb(1.0f, 2.0f, 0.0f));
    const dvec3 sum = total(project_extinction_times(inner, factor));
    EXPECT_NEAR(sum.x / expected, 1.0, 1e-5);
    EXPECT_NEAR(sum.y / expected, 2.0, 1e-5);
    EXPECT_EQ(sum.z, 0.0);
}

TEST(VoxelLights, NothingBurnsNothingShines) {
    Recipe r;
    r.box = cube(0, 7);
    r.density = [](const ivec3&) { return 1.0f; };
    EXPECT_TRUE(voxel_lights(make_medium(r)).empty());
}

}  // namespace
}  // namespace brisance
