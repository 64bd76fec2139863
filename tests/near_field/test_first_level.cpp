// The first level of lights by the separations of nodes: depths of shifted lights, and the light that arrives.
#include "near_field/first_level.h"

#include <gtest/gtest.h>

#include <functional>

#include "fixtures/plane_occluder.h"
#include "gathering/gather_fixture.h"
#include "gathering/node_receivers.h"
#include "medium/coarse_medium.h"

namespace brisance {
namespace {

using namespace testing;

double depth_of(const std::vector<ShiftedTap>& taps, const vec3& shift, const std::function<double(const ivec3&)>& at) {
    double depth = 0.0;
    for (const ShiftedTap& t : taps)
        depth += at(t.node) * (t.length + glm::dot(t.change, shift));
    return depth;
}

// In uniform smoke the depth is the distance from the light, wherever near its vertex it stands.
TEST(ShiftedTaps, InUniformSmokeTheDepthIsTheDistance) {
    const mat3 lattice(some_linear_map());
    const float h = std::cbrt(std::abs(glm::determinant(lattice)));
    for (const ivec3& node : {ivec3(4, 0, 0), ivec3(-3, 5, 2), ivec3(6, 6, -5), ivec3(1, -2, 8)}) {
        const std::vector<ShiftedTap> taps = shifted_taps(node, lattice);
        for (const vec3& s : {vec3(0.0f), vec3(0.4f, -0.2f, 0.1f), vec3(-0.3f, 0.3f, 0.4f)}) {
            const double distance = glm::length(lattice * vec3(node) + h * s);
            EXPECT_NEAR(depth_of(taps, h * s, [](const ivec3&) { return 1.0; }), distance, 0.02 * distance);
        }
    }
}

// Of smoke whose nodes know nothing of each other, and lights up to half a node per axis from their vertex: the errors
// of depths are less than half as large as those of lights left at their vertex.
TEST(ShiftedTaps, FollowTheDepthOfAShiftedLight) {
    Recipe r;
    r.box = cube(-16, 15);
    r.density = [](const ivec3& n) { return noise(n, 9); };
    r.settings = black_smoke();
    const Medium medium = make_medium(r);
    const ExtinctionPyramid pyramid(medium, 1);
    const auto extinction = [&](const ivec3& n) { return double(medium.extinction[medium.lattice.find_node(n)]); };
    const float h = medium.spacing;
    double at_vertex = 0.0, followed = 0.0, lights = 0.0;
    for (int k = 0; k < 400; ++k) {
        const ivec3 node(int(16.0f * noise(ivec3(k), 1)) - 8, int(16.0f * noise(ivec3(k), 2)) - 8,
                         int(16.0f * noise(ivec3(k), 3)) - 8);
        if (glm::length(vec3(node)) < 3.0f)
            continue;
        const vec3 shift = h * (vec3(noise(ivec3(k), 4), noise(ivec3(k), 5), noise(ivec3(k), 6)) - 0.5f);
        const double exact = pyramid.optical_depth(medium.local_of_node(ivec3(0)), medium.local_of_node(node) + shift);
        const std::vector<ShiftedTap> taps = shifted_taps(node, medium.local_from_index);
        at_vertex += std::pow(depth_of(taps, vec3(0.0f), extinction) - exact, 2);
        followed += std::pow(depth_of(taps, shift, extinction) - exact, 2);
        lights += 1.0;
    }
    EXPECT_GT(lights, 300.0);
    EXPECT_LT(followed, 0.25 * at_vertex);
}

Recipe skewed_fire() {
    Recipe r = glowing_ball(12, 1.0f);
    r.world_from_index = transform(some_linear_map(), dvec3(0.0));
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 12.0) * (0.3f + noise(n >> 1, 1)); };
    r.flame = [](const ivec3& n) { return noise(n >> 2, 2) > 0.5f ? noise(n, 3) : 0.0f; };
    r.settings.smoke.extinction_per_metre = 3.0f;
    return r;
}

double root_mean_square(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0.0, square = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += b[i];
        square += std::pow(double(a[i]) - b[i], 2);
    }
    return std::sqrt(square * double(a.size())) / sum;
}

FirstLevel first_level(const Lit& lit) {
    return FirstLevel(lit.medium.local_from_index, 2.0f * lit.grid.levels.front().spacing);
}

FirstLevel::Input input_of(const Lit& lit) {
    return {&lit.pyramid, &lit.medium.extinction, &lit.grid.levels.front(), std::nullopt, 0.0f};
}

// The level alone, against rays from its lights through the smoke; on a lattice of skewed axes.
TEST(FirstLevel, SendsWhatExactShadowsLetThrough) {
    const Lit lit(make_medium(skewed_fire()));
    ASSERT_GE(lit.grid.levels.size(), 2u);
    const std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 1);
    Gathered by_separations, by_rays;
    by_separations.resize(needed.size(), false, false);
    first_level(lit).gather(input_of(lit), {&lit.medium.lattice, &needed, false}, by_separations);

    const GridLevel& level = lit.grid.levels.front();
    const float r = 2.0f * level.spacing;
    by_rays.resize(needed.size(), false, false);
    for (std::size_t i = 0; i < needed.size(); ++i)
        if (lit.medium.extinction[i] > 0.0f)
            for (std::size_t k = 0; k < level.size(); ++k) {
                const vec3 p = lit.medium.local_of_node(node_at(lit.medium, i));
                const float d = glm::length(level.position[k] - p);
                const float blend = std::clamp(std::min(2.0f * d / r - 1.0f, 2.0f - d / r), 0.0f, 1.0f);
                if (blend > 0.0f)
                    by_rays.fluence[i] += level.intensity[k].x * blend / (d * d) *
                                          std::exp(-lit.pyramid.optical_depth(level.position[k], p));
            }
    std::vector<float> a, b;
    for (std::size_t i = 0; i < needed.size(); ++i)
        if (lit.medium.extinction[i] > 0.0f) {
            a.push_back(by_separations.fluence[i]);
            b.push_back(by_rays.fluence[i]);
        }
    EXPECT_LT(root_mean_square(a, b), 0.02);
}

// One voxel between eight vertices sends from where it is to all nodes around, those vertices among them.
TEST(FirstLevel, ALightAWholeNodeFromItsVertexIsSeenThere) {
    Recipe r = glowing_ball(12, 1.0f);
    r.density = [](const ivec3&) { return 1.0f; };
    r.flame = [](const ivec3& n) { return n == ivec3(1) ? 1.0f : 0.0f; };
    r.settings.smoke.extinction_per_metre = 0.2f;
    const Medium medium = make_medium(r);
    std::vector<Rgb> intensity(medium.lattice.node_count(), Rgb(0.0f));
    intensity[std::size_t(medium.lattice.find_node(ivec3(1)))] = Rgb(1.0f);
    const Lit lit(medium, intensity);
    const std::vector<std::uint8_t> needed(intensity.size(), 1);
    const float radius = lit.grid.levels.front().spacing;
    Gathered g;
    g.resize(needed.size(), false, false);
    FirstLevel(lit.medium.local_from_index, radius).gather(input_of(lit), {&lit.medium.lattice, &needed, false}, g);
    for (int k = 0; k < 8; ++k) {
        const std::int64_t i = lit.medium.lattice.find_node(2 * ivec3(k >> 2, k >> 1 & 1, k & 1));
        ASSERT_GE(i, 0);
        const float d = std::sqrt(3.0f) * lit.medium.spacing;
        const float expected = (2.0f * d / radius - 1.0f) / (d * d) * std::exp(-lit.medium.extinction[i] * d);
        EXPECT_NEAR(g.fluence[i] / expected, 1.0f, 0.03f);
    }
}

TEST(FirstLevel, EverySecondNodeGetsWhatItGetsAmongAll) {
    const Lit lit(make_medium(skewed_fire()));
    const std::vector<std::uint8_t> all(lit.medium.lattice.node_count(), 1);
    BrickLattice even;
    const std::vector<std::uint8_t> needed = parents(lit.medium.lattice, all, even);
    Gathered of_all, of_even;
    of_all.resize(all.size(), false, true);
    of_even.resize(needed.size(), false, true);
    const FirstLevel level = first_level(lit);
    const std::uint64_t evaluations = level.gather(input_of(lit), {&lit.medium.lattice, &all, false}, of_all);
    EXPECT_LT(level.gather(input_of(lit), {&even, &needed, true}, of_even) * 4, evaluations);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < needed.size(); ++i)
        if (const std::int64_t j = lit.medium.lattice.find_node(2 * even.node(i)); j >= 0 && needed[i]) {
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_EQ(of_even.fluence[c * needed.size() + i], of_all.fluence[c * all.size() + j]);
            for (std::size_t c = 0; c < 24; ++c)
                ASSERT_EQ(of_even.moments[c * needed.size() + i], of_all.moments[c * all.size() + j]);
            ++compared;
        }
    EXPECT_GT(compared, 1000u);
}

// Light of the level must not pass a surface: whatever receives it without maps is too far from one.
TEST(FirstLevel, NodesThatASurfaceMayShadeAreKnown) {
    const Lit lit(make_medium(skewed_fire()));
    const PlaneOccluder wall = plane_across(0, 0.1f);
    const std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 1);
    const LatticeRequest request{&needed, std::nullopt, false, 0.0f};
    const NodeReceivers nodes = node_receivers(lit.medium, request);
    const float reach = 3.0f * lit.medium.spacing;
    const NodesBesideSurfaces parts = part_within_reach(lit.medium, request, nodes, 0, reach, wall);
    std::size_t open = 0;
    for (std::size_t i = 0; i < needed.size(); ++i) {
        ASSERT_EQ(parts.in_the_open.needed[i] + parts.beside.needed[i], 1);
        open += parts.in_the_open.needed[i];
        const float distance = std::abs(wall.side(lit.medium.local_of_node(node_at(lit.medium, i))));
        ASSERT_TRUE(distance >= reach || parts.beside.needed[i]);
    }
    EXPECT_GT(open, needed.size() / 8);
    EXPECT_GE(parts.beside.receivers.size(), needed.size() - open);
}

}  // namespace
}  // namespace brisance
