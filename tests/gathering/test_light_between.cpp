// Light at nodes from that at every second one: no light is gained or lost, surfaces part it, and it is the nodes' own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fixtures/plane_occluder.h"
#include "gather_fixture.h"
#include "gathering/light_between.h"
#include "gathering/near_depth.h"

namespace brisance {
namespace {

using namespace testing;

// Lumpy fire in lumpy smoke.
Recipe lumpy_fire(float extinction) {
    Recipe r = glowing_ball(26, 1.0f);
    r.box = cube(-26, 25);
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 26.0) * (0.3f + noise(n >> 1, 1)); };
    r.flame = [](const ivec3& n) { return noise(n >> 2, 2) > 0.5f ? noise(n, 3) : 0.0f; };
    r.settings.smoke.extinction_per_metre = extinction;
    return r;
}

Gathered gathered(const Lit& lit, float own_share, const Occluders* surfaces = nullptr, bool directions = false) {
    LightField field = field_of(lit, lighting(ShadowMethod::Maps));
    field.occluders = surfaces;
    const std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 1);
    LatticeRequest request{&needed, std::nullopt, directions, 0.0f};
    request.own_share = own_share;
    std::vector<LevelCost> costs;
    Progress silent;
    return gather_at_nodes(field, request, costs, silent);
}

struct OfCollisions {
    double mean, rms;  // of what collides, relative
};

OfCollisions of_collisions(const Medium& medium, const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0.0, square = 0.0, all = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < medium.extinction.size(); ++i) {
        const double x = double(medium.extinction[i]) * a[i], y = double(medium.extinction[i]) * b[i];
        sum += x - y;
        square += (x - y) * (x - y);
        all += y;
        squares += y * y;
    }
    return {sum / all, std::sqrt(square / squares)};
}

// Voxels of a depth of 0.1, 0.5 and 1.5. A node may err by some percent, which averages out along a ray; the light as a
// whole may not.
TEST(LightBetween, LosesAndGainsNoLight) {
    for (const float extinction : {3.0f, 12.0f, 40.0f}) {
        const Lit lit(make_medium(lumpy_fire(extinction)));
        const OfCollisions d = of_collisions(lit.medium, gathered(lit, 0.0f).fluence, gathered(lit, 1.0f).fluence);
        std::printf("depth of a voxel %.2f: mean %+.3f %%, rms %.2f %%\n", extinction * lit.medium.spacing,
                    100.0 * d.mean, 100.0 * d.rms);
        EXPECT_LT(std::abs(d.mean), 0.01);  // the energy balance takes the rest
        EXPECT_LT(d.rms, 0.03);
    }
}

TEST(LightBetween, TakesAnEighthOfTheEvaluations) {
    const Lit lit(make_medium(lumpy_fire(3.0f)));
    const LightField field = field_of(lit, lighting(ShadowMethod::Maps));
    const std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 1);
    const auto evaluations = [&](float own_share, int level) {
        LatticeRequest request{&needed, std::nullopt, false, 0.0f};
        request.own_share = own_share;
        std::vector<LevelCost> costs;
        Progress silent;
        gather_at_nodes(field, request, costs, silent);
        EXPECT_TRUE(std::ranges::is_sorted(costs, {}, &LevelCost::level));
        double sum = 0.0;
        for (const LevelCost& c : costs)
            if (c.level == level)
                sum += double(c.evaluations);
        return sum;
    };
    EXPECT_LT(evaluations(0.0f, 1), 0.25 * evaluations(1.0f, 1));  // with the nodes that are compared
    EXPECT_LT(evaluations(0.0f, 2), 0.25 * evaluations(1.0f, 2));
}

TEST(LightBetween, AShareIsTheMixtureOfBoth) {
    const Lit lit(make_medium(lumpy_fire(3.0f)));
    const Gathered none = gathered(lit, 0.0f, nullptr, true), half = gathered(lit, 0.5f, nullptr, true),
                   all = gathered(lit, 1.0f, nullptr, true);
    std::vector<float> mixture(all.fluence.size());
    for (std::size_t i = 0; i < mixture.size(); ++i)
        mixture[i] = 0.5f * (none.fluence[i] + all.fluence[i]);
    // The ratios of nodes' own light are from all nodes here, and from a sixteenth there.
    EXPECT_LT(of_collisions(lit.medium, half.fluence, mixture).rms, 0.005);
    ASSERT_FALSE(all.moments.empty());
    for (std::size_t c = 0; c < 24; ++c) {
        const auto plane = [&](const Gathered& g) {
            const auto first = g.moments.begin() + std::ptrdiff_t(c * lit.medium.lattice.node_count());
            return std::vector<float>(first, first + std::ptrdiff_t(lit.medium.lattice.node_count()));
        };
        const std::vector<float> a = plane(none), b = plane(all);
        double square = 0.0, squares = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            square += std::pow(double(lit.medium.extinction[i]) * (a[i] - b[i]), 2);
            squares += std::pow(double(lit.medium.extinction[i]) * b[i], 2);
        }
        EXPECT_LT(std::sqrt(square / squares), 0.15) << "moment " << c / 3;
    }
}

// Fire on one side alone: nodes on the other stay as dark as they are, and those beside the wall gather for themselves.
TEST(LightBetween, StaysOnItsSideOfAWall) {
    Recipe r = lumpy_fire(3.0f);
    r.flame = [all = r.flame](const ivec3& n) { return n.x < 0 ? all(n) : 0.0f; };
    const Lit lit(make_medium(r));
    const PlaneOccluder wall = plane_across(0, 0.03f);
    const Gathered between = gathered(lit, 0.0f, &wall), own = gathered(lit, 1.0f, &wall);
    EXPECT_LT(std::abs(of_collisions(lit.medium, between.fluence, own.fluence).mean), 0.005);
    double beside = 0.0, beside_own = 0.0, square = 0.0;
    for (std::size_t i = 0; i < lit.medium.lattice.node_count(); ++i) {
        const ivec3 node = node_at(lit.medium, i);
        if (lit.medium.extinction[i] > 0.0f && (node.x == 0 || node.x == 1)) {
            beside += between.fluence[i];
            beside_own += own.fluence[i];
            square += std::pow(between.fluence[i] - own.fluence[i], 2);
        }
    }
    EXPECT_NEAR(beside / beside_own, 1.0, 0.003);
    EXPECT_GT(beside_own, 0.0);
}

TEST(LightBetween, ComparedNodesAreASixteenthThatStaysInTheWorld) {
    const Medium medium = make_medium(lumpy_fire(3.0f));
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const std::vector<std::uint8_t> needed(medium.lattice.node_count(), 1);
    const LatticeRequest request{&needed, std::nullopt, false, 0.0f};
    const NodeReceivers coarser = coarser_receivers(medium, request, node_receivers(medium, request), 1);
    const LightBetween between(pyramid, pyramid.nodes(1), coarser, medium.spacing);
    const std::vector<std::uint8_t> compared = between.compared_nodes(needed);
    for (std::size_t brick = 0; brick < medium.lattice.brick_count(); ++brick) {
        const auto first = compared.begin() + std::ptrdiff_t(brick * BrickLattice::kNodes);
        EXPECT_EQ(std::count(first, first + BrickLattice::kNodes, 1), BrickLattice::kNodes / 16);
    }
    // Fewer nodes, the same choice.
    std::vector<std::uint8_t> some(needed);
    for (std::size_t i = 0; i < some.size(); i += 3)
        some[i] = 0;
    const std::vector<std::uint8_t> of_some = between.compared_nodes(some);
    for (std::size_t i = 0; i < some.size(); ++i)
        ASSERT_EQ(of_some[i], compared[i] && some[i]);
}

TEST(LightBetween, NodesGatherForThemselvesWhereLittleErrorIsAllowedOrLobesAreNarrow) {
    LightingSettings settings;
    const auto share = [&](float error, float mean_cosine) {
        settings.error = error;
        return own_share_of(settings, mean_cosine);
    };
    EXPECT_EQ(share(0.02f, 0.0f), 0.0f);
    EXPECT_EQ(share(0.05f, -0.4f), 0.0f);
    EXPECT_EQ(share(0.01f, 0.0f), 1.0f);
    EXPECT_EQ(share(0.02f, 0.6f), 1.0f);
    EXPECT_EQ(share(0.02f, -0.6f), 1.0f);
    for (const float part : {0.1f, 0.5f, 0.9f}) {
        EXPECT_GT(share(0.01f + 0.01f * part, 0.0f), share(0.01f + 0.01f * (part + 0.1f), 0.0f));
        EXPECT_LT(share(0.02f, 0.4f + 0.2f * part), share(0.02f, 0.4f + 0.2f * (part + 0.1f)));
    }
    settings.shadows = ShadowMethod::Exact;
    EXPECT_EQ(share(0.02f, 0.0f), 1.0f);
    settings = {};
    settings.interpolation = 0.0f;
    EXPECT_EQ(share(0.02f, 0.0f), 1.0f);
}

// In even smoke the depth is extinction times reach, whatever the voxels' shape.
TEST(NearDepth, IsThatOfEvenSmoke) {
    std::vector<ivec3> bricks;
    for (int k = 0; k < 27; ++k)
        bricks.push_back({k / 9, k / 3 % 3, k % 3});
    const BrickLattice lattice(bricks);
    const std::vector<float> even(lattice.node_count(), 0.7f);
    const mat3 skewed(1.0f, 0.2f, 0.0f, 0.0f, 1.5f, 0.0f, 0.3f, 0.0f, 0.8f);
    for (const mat3& span : {mat3(0.5f), skewed}) {
        const float reach = 0.75f;
        const std::vector<float> depth = near_depths(lattice, even, span, reach);
        for (int k = 0; k < BrickLattice::kNodes; ++k)
            ASSERT_NEAR(depth[std::size_t(lattice.find_node(ivec3(8) + BrickLattice::node_in_brick(k)))], 0.7f * reach,
                        1e-4f);
    }
    // One node alone: the integral of its hat along lines from it is 0.43 to 0.5 voxels.
    std::vector<float> single(lattice.node_count(), 0.0f);
    single[std::size_t(lattice.find_node(ivec3(12)))] = 1.0f;
    const std::vector<float> depth = near_depths(lattice, single, mat3(1.0f), 2.0f);
    EXPECT_NEAR(depth[std::size_t(lattice.find_node(ivec3(12)))], 0.465f, 0.035f);
    EXPECT_EQ(depth[std::size_t(lattice.find_node(ivec3(12, 12, 16)))], 0.0f);
}

TEST(LocalRatios, FollowTheirPlaceAndDoNotJump) {
    const BrickLattice lattice({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
    LocalRatios ratios(lattice);
    for (std::size_t i = 0; i < lattice.node_count(); i += 4)
        ratios.add(i, Rgb(lattice.node(i).x < 16 ? -0.1f : 0.1f) * 3.0f, Rgb(3.0f));
    const std::vector<LocalRatios::Corners> corners = ratios.at_corners();
    const auto at = [&](int x) {
        return LocalRatios::at_node(corners[std::size_t(lattice.find({x / 8, 0, 0}))], {x % 8, 3, 5}).x;
    };
    EXPECT_NEAR(at(0), -0.1f, 0.02f);
    EXPECT_NEAR(at(31), 0.1f, 0.02f);
    for (int x = 0; x < 31; ++x)
        EXPECT_LT(std::abs(at(x + 1) - at(x)), 0.03f) << x;
}

TEST(LocalRatios, OfFewNodesSayLittle) {
    const BrickLattice lattice({{0, 0, 0}, {9, 9, 9}});
    LocalRatios nothing(lattice), few(lattice);
    few.add(0, Rgb(1.0f), Rgb(1.0f));
    const auto at = [](const LocalRatios& r) { return LocalRatios::at_node(r.at_corners()[1], ivec3(3)); };
    EXPECT_EQ(at(nothing), Rgb(0.0f));
    EXPECT_NEAR(at(few).x, 0.0f, 0.005f);
}

}  // namespace
}  // namespace brisance
