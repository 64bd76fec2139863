// Different methods gather the same light; the number of threads and the memory do not change it.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/parallel.h"
#include "fixtures/plane_occluder.h"
#include "gather_fixture.h"

namespace brisance {
namespace {

using namespace testing;

Recipe fireball(float extinction) {
    Recipe r = glowing_ball(10, 1.0f);
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 10.0) * (0.3f + noise(n >> 1, 1)); };
    r.flame = [](const ivec3& n) { return noise(n >> 2, 2) > 0.5f ? noise(n, 3) : 0.0f; };
    r.settings.smoke.extinction_per_metre = extinction;
    return r;
}

struct Difference {
    double mean = 0.0, rms = 0.0;
};

// Relative to the mean of `b`.
Difference difference(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0.0, square = 0.0, reference = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += a[i] - b[i];
        square += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
        reference += b[i];
    }
    return {sum / reference, std::sqrt(square * a.size()) / reference};
}

TEST(Agreement, MapsAgreeWithExactShadows) {
    const Lit lit(make_medium(fireball(3.0f)));
    const Gathered exact = at_all_nodes(lit, lighting(ShadowMethod::Exact));
    const Gathered maps = at_all_nodes(lit, lighting(ShadowMethod::Maps));
    const Difference d = difference(maps.fluence, exact.fluence);
    EXPECT_LT(std::abs(d.mean), 0.03);
    EXPECT_LT(d.rms, 0.05);
}

// Of a ball with four levels of lights, gathered at every node and between fewer.
struct BetweenNodes {
    Gathered at_every_node, interpolated;
};

BetweenNodes between_nodes(const Lit& lit, const Occluders* surfaces) {
    BetweenNodes out;
    EXPECT_GE(lit.grid.levels.size(), 4u);
    LightField field = field_of(lit, lighting(ShadowMethod::Maps));
    field.occluders = surfaces;
    const std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 1);
    std::vector<LevelCost> every, fewer;
    Progress silent;
    out.at_every_node = gather_at_nodes(field, {&needed, std::nullopt, false, 0.0f, false}, every, silent);
    out.interpolated = gather_at_nodes(field, {&needed, std::nullopt, false, 0.0f, true}, fewer, silent);
    EXPECT_LT(fewer.back().evaluations * 4, every.back().evaluations);
    return out;
}

Recipe large_fireball() {
    Recipe r = fireball(3.0f);
    r.box = cube(-26, 25);
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 26.0) * (0.3f + noise(n >> 1, 1)); };
    return r;
}

TEST(Agreement, FarLightBetweenNodesIsThatOfTheNodes) {
    const Lit lit(make_medium(large_fireball()));
    const BetweenNodes b = between_nodes(lit, nullptr);
    const Difference d = difference(b.interpolated.fluence, b.at_every_node.fluence);
    std::printf("mean %+.3f %%, rms %.3f %%\n", 100.0 * d.mean, 100.0 * d.rms);
    // Far below the 2 % that shadow maps may add; nodes are an eighth of a level's radius apart at most.
    EXPECT_LT(std::abs(d.mean), 0.001);
    EXPECT_LT(d.rms, 0.004);
}

// Fire to the left of a wall alone: no light is interpolated across it. If it were, nodes beside the wall would be 1.3
// % off.
TEST(Agreement, FarLightBetweenNodesStaysOnItsSideOfAWall) {
    Recipe r = large_fireball();
    r.flame = [all = r.flame](const ivec3& n) { return n.x < 0 ? all(n) : 0.0f; };
    const PlaneOccluder wall = plane_across(0, 0.03f);
    const Lit lit(make_medium(r));
    const BetweenNodes b = between_nodes(lit, &wall);
    const Difference all = difference(b.interpolated.fluence, b.at_every_node.fluence);
    EXPECT_LT(std::abs(all.mean), 0.001);
    EXPECT_LT(all.rms, 0.006);
    std::vector<float> beside, beside_exact;
    for (std::size_t i = 0; i < lit.medium.lattice.node_count(); ++i) {
        const ivec3 node = node_at(lit.medium, i);
        if (lit.medium.extinction[i] > 0.0f && (node.x == 0 || node.x == 1)) {
            beside.push_back(b.interpolated.fluence[i]);
            beside_exact.push_back(b.at_every_node.fluence[i]);
        }
    }
    EXPECT_LT(difference(beside, beside_exact).rms, 0.005);
}

TEST(Agreement, PointsAtTheNodesSeeWhatTheNodesSee) {
    const Lit lit(make_medium(fireball(2.0f)));
    std::vector<vec3> points;
    std::vector<float> expected;
    const Gathered nodes = at_all_nodes(lit, lighting(ShadowMethod::Exact));
    for (std::size_t i = 0; i < lit.medium.lattice.node_count(); i += 37)
        if (lit.medium.extinction[i] > 0.0f) {
            points.push_back(lit.medium.local_of_node(node_at(lit.medium, i)));
            expected.push_back(nodes.fluence[i]);
        }
    const std::vector<float> got = at_points(lit, lighting(ShadowMethod::Exact), points);
    const Difference d = difference(got, expected);
    EXPECT_LT(std::abs(d.mean), 0.02);
    EXPECT_LT(d.rms, 0.05);
}

TEST(Agreement, NodesThatAskAloneGetWhatTheyGetTogether) {
    const Lit lit(make_medium(fireball(2.0f)));
    const Gathered all = at_all_nodes(lit, lighting(ShadowMethod::Maps, 1.0f));
    std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 0);
    for (std::size_t i = 0; i < needed.size(); ++i)
        needed[i] = noise(node_at(lit.medium, i), 8) < 0.03f;
    std::vector<LevelCost> costs;
    Progress silent;
    const Gathered some = gather_at_nodes(field_of(lit, lighting(ShadowMethod::Maps, 1.0f)),
                                          {&needed, std::nullopt, false, 0.0f}, costs, silent);
    const std::size_t nodes = needed.size();
    for (std::size_t i = 0; i < nodes; ++i)
        for (int c = 0; needed[i] && c < 3; ++c)
            ASSERT_NEAR(some.fluence[c * nodes + i] / all.fluence[c * nodes + i], 1.0f, 2e-3f);
    EXPECT_EQ(costs.size(), lit.grid.levels.size() + 1);
}

TEST(Agreement, MapsMadeOnDemandGiveTheSameLight) {
    const Lit lit(make_medium(fireball(2.0f)));
    LightField all = field_of(lit, lighting(ShadowMethod::Maps, 1.0f)), on_demand = all;
    ShadowMapCache cache;
    cache.on_demand = true;
    on_demand.cache = &cache;
    const GridLevel bottom = bottom_level(all);
    const auto gathered = [&](const LightField& field, const vec3& position, std::uint64_t& map_bytes) {
        Receivers receivers;
        receivers.add_block({position, position + vec3(0.05f, 0.0f, 0.0f)}, {});
        std::vector<LevelCost> costs;
        Progress silent;
        const Gathered g = gather_at_points(field, bottom, receivers, 0.0f, costs, silent);
        map_bytes = costs[1].map_bytes;
        return g.fluence;
    };
    // The second position needs further maps; the third only maps that exist.
    std::uint64_t before = 0, bytes = 0, of_all = 0;
    for (const vec3 position : {vec3(0.4f, 0.1f, -0.2f), vec3(-0.5f, 0.3f, 0.1f), vec3(0.4f, 0.1f, -0.2f)}) {
        EXPECT_EQ(gathered(on_demand, position, bytes), gathered(all, position, of_all));
        EXPECT_GE(bytes, before);
        EXPECT_LT(bytes, of_all);
        before = bytes;
    }
    EXPECT_GT(before, 0u);
}

// A block of receivers all around the medium: only the top level's lights reach as far.
TEST(Agreement, NoMapIsMadeForABoxAroundFarReceivers) {
    const Lit lit(make_medium(fireball(2.0f)));
    LightField field = field_of(lit, lighting(ShadowMethod::Maps, 1.0f));
    ShadowMapCache cache;
    cache.on_demand = true;
    field.cache = &cache;
    std::vector<vec3> far;
    for (int k = 0; k < 8; ++k)
        far.push_back(20.0f * vec3(k & 1 ? 1.0f : -1.0f, k & 2 ? 1.0f : -1.0f, k & 4 ? 1.0f : -1.0f));
    Receivers receivers;
    receivers.add_block(far, {});
    std::vector<LevelCost> costs;
    Progress silent;
    gather_at_points(field, bottom_level(field), receivers, 0.0f, costs, silent);
    for (const LevelCost& cost : costs)
        EXPECT_EQ(cost.map_bytes > 0, &cost == &costs.back()) << cost.level;
}

// Points outside of the medium read what the maps hold for their last distance; beside a point inside of it they read
// the distances themselves. Both are the same transmittance, give or take the interpolation between distances.
TEST(Agreement, OutsideOfTheMediumLightIsWhatTheMapsEndWith) {
    const Lit lit(make_medium(fireball(2.0f)));
    std::vector<vec3> outside, with_the_middle = {vec3(0.0f)};
    for (int i = 0; i < 15; ++i) {  // before a face of the medium, nearer than its far corners
        const vec3 p(1.9f + noise(ivec3(i), 1), 2.0f * noise(ivec3(i), 2) - 1.0f, 2.0f * noise(ivec3(i), 3) - 1.0f);
        outside.push_back(p);
        with_the_middle.push_back(p);
    }
    const auto gathered = [&](const std::vector<vec3>& points, bool& keeps_ends) {
        LightField field = field_of(lit, lighting(ShadowMethod::Maps));
        ShadowMapCache cache;
        field.cache = &cache;
        Receivers receivers;
        receivers.add_block(points, {});
        std::vector<LevelCost> costs;
        Progress silent;
        std::vector<float> fluence =
            gather_at_points(field, bottom_level(field), receivers, 0.0f, costs, silent).fluence;
        keeps_ends = !cache.levels.back().ends.empty();
        fluence.resize(points.size());  // the first channel
        return fluence;
    };
    bool ends_alone = false, ends_together = false;
    const std::vector<float> by_ends = gathered(outside, ends_alone);
    std::vector<float> by_distances = gathered(with_the_middle, ends_together);
    by_distances.erase(by_distances.begin());
    EXPECT_TRUE(ends_alone);
    EXPECT_FALSE(ends_together);
    EXPECT_GT(*std::ranges::min_element(by_ends), 0.0f);
    EXPECT_LT(difference(by_ends, by_distances).rms, 2e-3);
}

TEST(Agreement, TheNumberOfThreadsDoesNotShow) {
    const Medium medium = make_medium(fireball(2.0f));
    std::vector<std::vector<float>> nodes, points;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        const Lit lit(medium);
        const Gathered g = at_all_nodes(lit, lighting(ShadowMethod::Maps, 1.0f), vec3(1.0f, 2.0f, 3.0f), true, 0.5f);
        nodes.push_back(g.fluence);
        nodes.back().insert(nodes.back().end(), g.scattered.begin(), g.scattered.end());
        nodes.back().insert(nodes.back().end(), g.moments.begin(), g.moments.end());
        std::vector<vec3> at;
        for (int i = 0; i < 200; ++i)
            at.push_back(2.0f * vec3(noise(ivec3(i), 1), noise(ivec3(i), 2), noise(ivec3(i), 3)) - 1.0f);
        points.push_back(at_points(lit, lighting(ShadowMethod::Maps, 1.0f), at));
    }
    for (int k : {1, 2}) {
        EXPECT_EQ(nodes[0], nodes[k]);
        EXPECT_EQ(points[0], points[k]);
    }
}

TEST(Agreement, LittleMemoryIsMentionedAndCostsLittle) {
    const Lit lit(make_medium(fireball(2.0f)));
    const Gathered free = at_all_nodes(lit, lighting(ShadowMethod::Maps));
    LightingSettings tight = lighting(ShadowMethod::Maps);
    tight.memory_limit_bytes = 1 << 20;
    const std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 1);
    std::vector<LevelCost> costs;
    Listener listener;
    const Gathered g = gather_at_nodes(field_of(lit, tight), {&needed, std::nullopt, false, 0.0f}, costs, listener);
    ASSERT_FALSE(listener.notices.empty());
    for (const char* what : {"memory limit of 1 MiB", "lighting.memory_limit_mebibytes"})
        EXPECT_NE(listener.notices[0].find(what), std::string::npos) << listener.notices[0];
    for (const LevelCost& cost : costs)
        EXPECT_LE(cost.held_bytes, std::uint64_t{2} << 20);
    const Difference d = difference(g.fluence, free.fluence);
    EXPECT_LT(std::abs(d.mean), 0.03);
    EXPECT_LT(d.rms, 0.06);
}

TEST(Agreement, InBatchesOrAtOnceTheLightIsTheSame) {
    Recipe r = fireball(0.5f);
    r.box = cube(0, 87);
    r.density = r.flame = [](const ivec3& n) { return 0.5f + noise(n, 4); };
    const Lit lit(make_medium(r));
    const std::size_t level = 2;  // the first that has maps in the open
    ASSERT_GT(lit.grid.levels[level - 1].size(), 9000u);
    LightingSettings settings = lighting(ShadowMethod::Maps, 1.0f);
    settings.shadow_resolution = 4;
    settings.shadow_distances = 2;
    std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 0);
    for (std::size_t i = 0; i < needed.size(); i += 4799)
        needed[i] = 1;
    std::vector<LevelCost> whole_costs, costs;
    Progress silent;
    const LatticeRequest request{&needed, std::nullopt, false, 0.0f};
    const Gathered whole = gather_at_nodes(field_of(lit, settings), request, whole_costs, silent);
    settings.memory_limit_bytes = whole_costs[level].map_bytes * 4 / 5;  // too little for this level alone
    const Gathered batches = gather_at_nodes(field_of(lit, settings), request, costs, silent);
    EXPECT_LT(costs[level].held_bytes, whole_costs[level].held_bytes);
    for (std::size_t l = 1; l < costs.size(); ++l) {
        ASSERT_EQ(costs[l].resolution, whole_costs[l].resolution);
        ASSERT_EQ(costs[l].distances, whole_costs[l].distances);
        EXPECT_EQ(costs[l].evaluations, whole_costs[l].evaluations);
    }
    for (std::size_t i = 0; i < needed.size(); ++i)
        if (needed[i]) {
            ASSERT_NEAR(batches.fluence[i], whole.fluence[i], 2e-5f * whole.fluence[i]);
        }
}

TEST(Agreement, MapsKeptForLaterAreTheSameMaps) {
    const Lit lit(make_medium(fireball(2.0f)));
    std::vector<LevelCost> costs;
    Progress silent;
    const std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 1);
    LightingSettings small = lighting(ShadowMethod::Maps, 1.0f);
    small.shadow_resolution = 4;
    small.shadow_distances = 2;
    const Gathered whole = gather_at_nodes(field_of(lit, small), {&needed, std::nullopt, false, 0.0f}, costs, silent);
    for (const LevelCost& cost : costs)
        EXPECT_EQ(cost.map_bytes, cost.held_bytes);
    ShadowMapCache cache;
    LightField kept = field_of(lit, small);
    kept.cache = &cache;
    std::vector<LevelCost> ignored;
    const Gathered first = gather_at_nodes(kept, {&needed, std::nullopt, false, 0.0f}, ignored, silent);
    const Gathered second = gather_at_nodes(kept, {&needed, std::nullopt, false, 0.0f}, ignored, silent);
    EXPECT_EQ(whole.fluence, first.fluence);
    EXPECT_EQ(whole.fluence, second.fluence);
}

TEST(Agreement, TwiceTheSizeAndHalfTheExtinctionIsTheSameFire) {
    Recipe r = fireball(2.0f);
    const Lit small(make_medium(r));
    r.world_from_index = cubic(2.0 / 10);
    r.settings.smoke.extinction_per_metre = 1.0f;
    const Lit large(make_medium(r));
    const Gathered a = at_all_nodes(small, lighting(ShadowMethod::Maps, 1.0f));
    const Gathered b = at_all_nodes(large, lighting(ShadowMethod::Maps, 1.0f));
    for (std::size_t i = 0; i < a.fluence.size(); ++i)
        ASSERT_NEAR(b.fluence[i], a.fluence[i], 1e-4f * a.fluence[i] + 1e-6f);
}

TEST(Agreement, WithoutLightNothingArrives) {
    Recipe r = fireball(2.0f);
    const Medium medium = make_medium(r);
    const Lit lit(medium, std::vector<Rgb>(medium.lattice.node_count(), Rgb(0.0f)));
    const Gathered g = at_all_nodes(lit, lighting(ShadowMethod::Maps));
    EXPECT_TRUE(std::all_of(g.fluence.begin(), g.fluence.end(), [](float v) { return v == 0.0f; }));
}

}  // namespace
}  // namespace brisance
