// The transmittance in a light's map, in every direction and at every distance.
#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "core/rng.h"
#include "fixtures/media.h"
#include "medium/lattice/local_bounds.h"
#include "shadows/octahedral_directions.h"
#include "shadows/shadow_maps.h"

namespace brisance {
namespace {

using testing::black_smoke;
using testing::cube;
using testing::cubic;
using testing::Lit;
using testing::make_medium;
using testing::noise;
using testing::Recipe;

Recipe block(float extinction) {
    Recipe r;
    r.box = cube(-32, 32);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = extinction;
    return r;
}

ShadowMapLayout layout_of(const GridLevel& level) {
    ShadowMapLayout layout;
    layout.resolution = 16;
    layout.distances = 8;
    layout.near_distance = 0.5f * level.spacing;
    layout.far_distance = 2.0f * level.spacing;
    return layout;
}

LargeVector<std::uint16_t> maps_of(const Lit& lit, const GridLevel& level, const ShadowMapLayout& layout) {
    LargeVector<std::uint16_t> maps;
    build_shadow_maps(lit.pyramid, level, lit.weight, nullptr, layout, 0, level.size(), maps);
    return maps;
}

float distance_of(const ShadowMapLayout& layout, int k) {
    return glm::mix(layout.near_distance, layout.far_distance, float(k) / float(layout.distances - 1));
}

// Transmittance of a texel; interior texels are 0 .. resolution - 1, the border lies at -1 and at resolution.
float stored(const LargeVector<std::uint16_t>& maps, const ShadowMapLayout& layout, std::size_t light, int u, int v,
             int k) {
    const std::size_t texel = std::size_t(u + 1) * layout.side() + (v + 1);
    return float(maps[light * layout.stride() + texel * layout.distances + k]) / 65535.0f;
}

vec3 direction_of(const ShadowMapLayout& layout, int u, int v) {
    const auto at = [&](int i) { return (2.0f * float(i) + 1.0f) / float(layout.resolution) - 1.0f; };
    return octahedral_direction(at(u), at(v));
}

void expect_beers_law(const Lit& lit, const GridLevel& level, float extinction) {
    const ShadowMapLayout layout = layout_of(level);
    const LargeVector<std::uint16_t> maps = maps_of(lit, level, layout);
    for (std::size_t light = 0; light < level.size(); ++light)
        for (int u = -1; u <= layout.resolution; ++u)
            for (int v = -1; v <= layout.resolution; ++v)
                for (int k = 0; k < layout.distances; ++k)
                    ASSERT_NEAR(stored(maps, layout, light, u, v, k), std::exp(-extinction * distance_of(layout, k)),
                                1e-3f);
}

TEST(ShadowMaps, UniformSmokeDimsByBeersLaw) {
    for (const float extinction : {0.01f, 1.0f, 4.0f}) {
        const auto lit = testing::single_light(make_medium(block(extinction)), ivec3(0));
        for (int l = 0; l < 3; ++l)  // level 3 reaches 1.6 m, half way to the block's walls
            expect_beers_law(*lit, lit->grid.levels[l], extinction);
    }
}

TEST(ShadowMaps, UniformSmokeDimsByBeersLawOnASkewLatticeToo) {
    Recipe r = block(1.0f);
    r.world_from_index = testing::transform(testing::some_linear_map(), dvec3(0.0));
    const auto lit = testing::single_light(make_medium(r), ivec3(0));
    for (int l = 0; l < 2; ++l)
        expect_beers_law(*lit, lit->grid.levels[l], 1.0f);
}

TEST(ShadowMaps, EmptySpaceDimsNothing) {
    Recipe r = block(1.0f);
    r.density = nullptr;
    r.flame = [](const ivec3& n) { return testing::ball(n, dvec3(0.0), 4.0); };
    r.settings.fire.convention = EmissionConvention::Direct;
    const Lit lit(make_medium(r));
    const GridLevel& level = lit.grid.levels[0];
    const ShadowMapLayout layout = layout_of(level);
    const LargeVector<std::uint16_t> maps = maps_of(lit, level, layout);
    for (std::size_t light = 0; light < level.size(); ++light)
        for (int i = 0; i < layout.resolution; ++i)
            for (int k = 0; k < layout.distances; ++k)
                ASSERT_EQ(stored(maps, layout, light, i, 3, k), 1.0f);
}

TEST(ShadowMaps, AWallDarkensOnlyWhatLiesBehindIt) {
    Recipe r = block(20.0f);
    r.density = [](const ivec3& n) { return n.x >= 4 ? 1.0f : 1e-6f; };
    const auto lit = testing::single_light(make_medium(r), ivec3(0));
    const GridLevel& level = lit->grid.levels[2];
    const ShadowMapLayout layout = layout_of(level);
    const LargeVector<std::uint16_t> maps = maps_of(*lit, level, layout);
    for (int u = 0; u < layout.resolution; ++u)
        for (int v = 0; v < layout.resolution; ++v) {
            const vec3 w = direction_of(layout, u, v);
            const float last = stored(maps, layout, 0, u, v, layout.distances - 1);
            if (w.x < -0.05f) {
                ASSERT_GT(last, 0.999f);
            }
            if (w.x > 0.8f) {
                ASSERT_LT(last, 1e-4f);
            }
        }
}

// The texels between which a receiver at `p` is interpolated.
template <class Visit>
void for_texels_read(const ShadowMapLayout& layout, const vec3& light, const vec3& p, const Visit& visit) {
    const vec3 w = p - light;
    const float sum = std::abs(w.x) + std::abs(w.y) + std::abs(w.z);
    const vec2 front = vec2(w.x, w.y) / sum;
    const vec2 at =
        w.z >= 0.0f ? front
                    : vec2(std::copysign(1.0f - std::abs(front.y), w.x), std::copysign(1.0f - std::abs(front.x), w.y));
    const vec2 texel = glm::floor(0.5f * float(layout.resolution) * (at + 1.0f) - 0.5f);
    for (int k = 0; k < 4; ++k)
        visit(int(texel.x) + (k & 1), int(texel.y) + (k >> 1));
}

// Beside the medium a light's map is made where receivers in the medium read it, at all its distances, and nowhere
// else.
TEST(ShadowMaps, OfALightOutsideAreMadeWhereTheMediumIs) {
    const auto lit = testing::single_light(make_medium(block(1e-3f)), ivec3(0));
    const LocalBounds bounds = local_bounds(lit->medium);
    const float radius = 0.5f * bounds.diagonal();
    Rng rng(Stream::Surface, 7);
    for (const float distance : {1.05f, 1.5f, 4.0f, 20.0f})
        for (const int resolution : {8, 16, 60})
            for (int k = 0; k < 20; ++k) {
                GridLevel level = lit->grid.levels[0];
                const vec3 aside = glm::normalize(vec3(rng.next(), rng.next(), rng.next()) - 0.5f);
                level.position = {bounds.middle() + distance * radius * aside};
                ShadowMapLayout layout = layout_of(level);
                layout.resolution = resolution;
                layout.far_distance = (distance + 1.0f) * radius;
                const LargeVector<std::uint16_t> maps = maps_of(*lit, level, layout);
                for (int i = 0; i < 500; ++i) {
                    vec3 p = glm::mix(bounds.low, bounds.high, vec3(rng.next(), rng.next(), rng.next()));
                    if (i < 8)
                        p = glm::mix(bounds.low, bounds.high, vec3(i & 1, i >> 1 & 1, i >> 2));
                    for_texels_read(layout, level.position[0], p, [&](int u, int v) {
                        for (int n = 0; n < layout.distances; ++n)
                            ASSERT_GT(stored(maps, layout, 0, u, v, n), 0.9f) << distance << " " << resolution;
                    });
                }
                if (distance == 20.0f && resolution == 60)
                    for_texels_read(layout, level.position[0], level.position[0] + aside, [&](int u, int v) {
                        ASSERT_EQ(stored(maps, layout, 0, u, v, 0), 0.0f) << "nobody reads it";
                    });
            }
}

TEST(ShadowMaps, LightFadesMonotonicallyWithDistance) {
    Recipe r = block(3.0f);
    r.density = [](const ivec3& n) { return noise(n, 1); };
    r.flame = [](const ivec3& n) { return noise(n, 2); };
    const Lit lit(make_medium(r));
    const GridLevel& level = lit.grid.levels[2];
    const ShadowMapLayout layout = layout_of(level);
    const LargeVector<std::uint16_t> maps = maps_of(lit, level, layout);
    for (std::size_t light = 0; light < level.size(); light += 11)
        for (int u = 0; u < layout.resolution; ++u)
            for (int v = 0; v < layout.resolution; ++v)
                for (int k = 1; k < layout.distances; ++k)
                    ASSERT_LE(stored(maps, layout, light, u, v, k), stored(maps, layout, light, u, v, k - 1));
}

// The border continues the map over the edges of the octahedron's square: same texel, seen from the other side.
TEST(ShadowMaps, TheBorderIsTheOtherSideOfTheSeam) {
    for (const float v : {-0.9f, -0.2f, 0.0f, 0.4f, 0.8f}) {
        for (const float side : {-1.0f, 1.0f}) {
            EXPECT_LT(glm::length(octahedral_direction(side, v) - octahedral_direction(side, -v)), 1e-6f);
            EXPECT_LT(glm::length(octahedral_direction(v, side) - octahedral_direction(-v, side)), 1e-6f);
        }
    }
    Recipe r = block(2.0f);
    r.density = [](const ivec3& n) { return noise(n >> 2, 1); };
    const auto lit = testing::single_light(make_medium(r), ivec3(0));
    const GridLevel& level = lit->grid.levels[1];
    const ShadowMapLayout layout = layout_of(level);
    const LargeVector<std::uint16_t> maps = maps_of(*lit, level, layout);
    const int end = layout.resolution, last = end - 1;
    bool varies = false;
    for (int i = 0; i < layout.resolution; ++i)
        for (int k = 0; k < layout.distances; ++k) {
            EXPECT_EQ(stored(maps, layout, 0, -1, i, k), stored(maps, layout, 0, 0, last - i, k));
            EXPECT_EQ(stored(maps, layout, 0, end, i, k), stored(maps, layout, 0, last, last - i, k));
            EXPECT_EQ(stored(maps, layout, 0, i, -1, k), stored(maps, layout, 0, last - i, 0, k));
            EXPECT_EQ(stored(maps, layout, 0, i, end, k), stored(maps, layout, 0, last - i, last, k));
            varies = varies || stored(maps, layout, 0, 0, i, k) != stored(maps, layout, 0, 0, last - i, k);
        }
    for (int k = 0; k < layout.distances; ++k) {  // all four corners are the downward pole
        EXPECT_EQ(stored(maps, layout, 0, -1, -1, k), stored(maps, layout, 0, last, last, k));
        EXPECT_EQ(stored(maps, layout, 0, end, -1, k), stored(maps, layout, 0, 0, last, k));
    }
    EXPECT_TRUE(varies);
}

TEST(ShadowMaps, TransmittanceAgreesWithAPlainMarch) {
    Recipe r = block(1.5f);
    r.density = [](const ivec3& n) { return 0.5f + 0.5f * std::sin(0.2f * n.x) * std::cos(0.15f * (n.y + n.z)); };
    const auto lit = testing::single_light(make_medium(r), ivec3(2, -3, 5));
    const GridLevel& level = lit->grid.levels[1];
    const ShadowMapLayout layout = layout_of(level);
    const LargeVector<std::uint16_t> maps = maps_of(*lit, level, layout);
    const vec3 light = lit->medium.local_of_node({2, -3, 5});
    for (int u = 0; u < layout.resolution; ++u)
        for (int v = 0; v < layout.resolution; ++v)
            for (int k = 0; k < layout.distances; ++k) {
                const vec3 to = light + direction_of(layout, u, v) * distance_of(layout, k);
                ASSERT_NEAR(stored(maps, layout, 0, u, v, k), std::exp(-lit->pyramid.optical_depth(light, to)), 0.01f);
            }
}

TEST(ShadowMaps, APartOfTheLevelHasTheMapsOfTheWholeWhateverTheThreads) {
    Recipe r = block(3.0f);
    r.density = [](const ivec3& n) { return noise(n, 1); };
    r.flame = [](const ivec3& n) { return noise(n, 2); };
    const Lit lit(make_medium(r));
    const GridLevel& level = lit.grid.levels[2];
    const ShadowMapLayout layout = layout_of(level);
    const LargeVector<std::uint16_t> whole = maps_of(lit, level, layout);
    for (const int threads : {1, 8}) {
        const ThreadLimit limit(threads);
        LargeVector<std::uint16_t> part;
        build_shadow_maps(lit.pyramid, level, lit.weight, nullptr, layout, 5, 20, part);
        ASSERT_EQ(part.size(), 20 * layout.stride());
        for (std::size_t i = 0; i < part.size(); ++i) {
            const std::size_t texel = i % layout.stride();
            if (texel + 2 < layout.stride()) {
                ASSERT_EQ(part[i], whole[5 * layout.stride() + i]);
            }
        }
    }
}

// Rays that stride through even parts.
TEST(ShadowMaps, StridesThroughEvenSmokeLoseNothing) {
    Medium medium = make_medium(block(0.1f));
    const std::size_t nodes = medium.lattice.node_count();
    Lit lit(std::move(medium), std::vector<Rgb>(nodes, Rgb(1.0f)));
    const GridLevel& level = lit.grid.levels[1];
    ShadowMapLayout layout = layout_of(level);
    layout.for_outside = true;
    layout.far_distance = 8.0f;
    const NodeWeights escape(lit.weight.size(), 1.0f);
    LargeVector<std::uint16_t> steps, strides, nowhere;
    const auto build = [&](LargeVector<std::uint16_t>& maps) {
        build_shadow_maps(lit.pyramid, level, lit.weight, &escape, layout, 0, std::min<std::size_t>(level.size(), 64),
                          maps);
    };
    build(steps);
    const HomogeneousBricks everywhere(lit.medium.lattice, lit.medium.reference_node,
                                       std::vector<std::uint8_t>(lit.medium.lattice.brick_count(), 1));
    const HomogeneousBricks none(lit.medium.lattice, lit.medium.reference_node,
                                 std::vector<std::uint8_t>(lit.medium.lattice.brick_count(), 0));
    lit.pyramid.set_homogeneous_bricks(&everywhere);
    build(strides);
    lit.pyramid.set_homogeneous_bricks(&none);
    build(nowhere);
    ASSERT_EQ(steps.size(), strides.size());
    double sum = 0.0, square = 0.0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const double difference = (double(strides[i]) - double(steps[i])) / 65535.0;
        sum += difference;
        square += difference * difference;
    }
    // Most of it where rays graze the faces of the block, from beside which a light's voxels look past it.
    EXPECT_LT(std::sqrt(square / double(steps.size())), 0.015);
    EXPECT_NEAR(sum / double(steps.size()), 0.0, 1.5e-3);
    EXPECT_NE(steps, strides);
    // Beyond the medium all is even: what lies in it is seen as before.
    ASSERT_EQ(steps.size(), nowhere.size());
    for (std::size_t i = 0; i < steps.size(); ++i)
        EXPECT_NEAR(nowhere[i], steps[i], 1);
}

// Lights of very different power.
GridLevel with_powers(GridLevel level) {
    for (std::size_t i = 0; i < level.size(); ++i)
        level.escaping.push_back(std::exp(8.0f * noise(ivec3(int(i), 0, 0), 5)));
    return level;
}

TEST(ParallelRays, AreInProportionToWhatLightsSend) {
    GridLevel level;
    EXPECT_EQ(ParallelRays(level).of(0), ParallelRays::kSame);
    level.escaping = {1.0f, 1.0f, 1.0f};
    EXPECT_EQ(ParallelRays(level).of(2), ParallelRays::kTypical);
    // The light that brings the mean unit of power has (64 + 16 + 1 + 0) / 13 of it.
    level.escaping = {8.0f, 4.0f, 1.0f, 0.0f};
    const ParallelRays rays(level);
    EXPECT_EQ(rays.of(0), 16);
    EXPECT_EQ(rays.of(1), 10);
    EXPECT_EQ(rays.of(2), 3);
    EXPECT_EQ(rays.of(3), ParallelRays::kLeast);
}

// Where rays follow power, fewer of them give a better sum than the same number for every light.
TEST(ParallelRays, ThatFollowPowerGiveABetterSumOfFewerRays) {
    Recipe recipe = block(4.0f);
    recipe.density = [](const ivec3& n) { return noise(n, 1); };
    Medium medium = make_medium(recipe);
    const std::size_t nodes = medium.lattice.node_count();
    const Lit lit(std::move(medium), std::vector<Rgb>(nodes, Rgb(1.0f)));
    const GridLevel& same = lit.grid.levels[2];
    const GridLevel by_power = with_powers(same);
    GridLevel most = same;  // rays
    most.escaping.assign(same.size(), 1.0f);
    ShadowMapLayout layout = layout_of(same);
    layout.for_outside = true;
    layout.range = 1.0f / FootprintPicker::kLeastShare;
    const NodeWeights escape(nodes, 1.0f);
    const auto sums = [&](const GridLevel& level) {
        LargeVector<std::uint16_t> maps;
        build_shadow_maps(lit.pyramid, level, lit.weight, &escape, layout, 0, level.size(), maps);
        std::vector<double> sum(layout.stride() - 2, 0.0);
        for (std::size_t i = 0; i < level.size(); ++i)
            for (std::size_t k = 0; k < sum.size(); ++k)
                sum[k] += double(by_power.escaping[i]) * maps[i * layout.stride() + k];
        return sum;
    };
    const std::vector<double> truth = sums(most), even = sums(same), powers = sums(by_power);
    double error_of_even = 0.0, error = 0.0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
        error_of_even += (even[k] - truth[k]) * (even[k] - truth[k]);
        error += (powers[k] - truth[k]) * (powers[k] - truth[k]);
    }
    EXPECT_LT(error, 0.8 * error_of_even);
    const ParallelRays rays(by_power);
    double count = 0.0;
    for (std::size_t i = 0; i < by_power.size(); ++i)
        count += rays.of(i);
    EXPECT_LT(count, 0.8 * ParallelRays::kSame * double(by_power.size()));
}

}  // namespace
}  // namespace brisance
