// Choosing one light of many.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/rng.h"
#include "emitters/light_front.h"
#include "emitters/light_tree.h"

namespace brisance {
namespace {

constexpr double kPi = 3.14159265358979323846;

dvec3 unit(Rng& rng) {
    const double z = 1.0 - 2.0 * rng.next_double(), a = 2.0 * kPi * rng.next_double(), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(a), r * std::sin(a), z};
}

// Points and small one-sided faces, some of them of no intensity.
std::vector<LightBounds> some_lights(int count) {
    Rng rng(Stream::Points, 11);
    std::vector<LightBounds> lights;
    for (int i = 0; i < count; ++i) {
        LightBounds b;
        b.low = 10.0 * dvec3(rng.next_double(), rng.next_double(), rng.next_double());
        b.high = b.low + (i % 2 ? 0.1 * dvec3(rng.next_double(), rng.next_double(), rng.next_double()) : dvec3(0.0));
        b.axis = unit(rng);
        b.spread = i % 2 ? 0.0 : kPi;
        b.reach = kPi / 2.0;
        b.intensity = i % 7 == 0 ? 0.0 : std::exp(6.0 * rng.next_double());
        b.two_sided = i % 3 == 0;
        lights.push_back(b);
    }
    return lights;
}

std::vector<LitPoint> some_points() {
    Rng rng(Stream::Points, 12);
    std::vector<LitPoint> points;
    for (int i = 0; i < 20; ++i)
        points.push_back({14.0 * dvec3(rng.next_double(), rng.next_double(), rng.next_double()) - 2.0, unit(rng),
                          static_cast<LitPoint::Kind>(i % 3)});
    return points;
}

TEST(LightTree, ProbabilitiesAddUpToOneOrLess) {
    const LightTree tree(some_lights(300));
    for (const LitPoint& point : some_points()) {
        double sum = 0.0;
        for (std::size_t i = 0; i < tree.size(); ++i)
            sum += tree.probability(point, i);
        EXPECT_LE(sum, 1.0 + 1e-9);
        EXPECT_GT(sum, 0.5) << "what is lost ends at lights that cannot reach the point";
    }
}

TEST(LightTree, ChoosesAsItSays) {
    const LightTree tree(some_lights(64));
    for (const LitPoint& point : some_points()) {
        constexpr int n = 100000;
        std::map<std::size_t, int> counts;
        for (int i = 0; i < n; ++i)
            if (const auto choice = tree.choose(point, (i + 0.5) / n)) {
                ++counts[choice->light];
                ASSERT_NEAR(choice->probability, tree.probability(point, choice->light), 1e-12);
            }
        // Even numbers: every light's share is met to a few steps.
        for (std::size_t i = 0; i < tree.size(); ++i)
            EXPECT_NEAR(counts[i], n * tree.probability(point, i), 20.0);
    }
}

// If a light reaches the point, no node on its path through the tree may have probability 0.
TEST(LightTree, EveryLightThatReachesAPointCanBeChosen) {
    const std::vector<LightBounds> lights = some_lights(300);
    const LightTree tree(lights);
    for (const LitPoint& point : some_points())
        for (std::size_t i = 0; i < lights.size(); ++i) {
            if (lights[i].intensity == 0.0)
                continue;
            const dvec3 centre = 0.5 * (lights[i].low + lights[i].high), offset = point.position - centre;
            double emitted = glm::dot(lights[i].axis, glm::normalize(offset));
            if (lights[i].two_sided)
                emitted = std::abs(emitted);
            const bool emits = lights[i].spread == kPi || emitted > 0.01;
            const double received = -glm::dot(point.normal, glm::normalize(offset));
            const bool receives = point.kind == LitPoint::Kind::Medium || received > 0.01 ||
                                  (point.kind == LitPoint::Kind::Transmitting && received < -0.01);
            if (emits && receives) {
                EXPECT_GT(tree.probability(point, i), 0.0) << "light " << i;
            }
        }
}

// Fronts of one node, of some, and of all lights: whatever the point for which they were found.
TEST(LightFront, ChoosesAsItSays) {
    const LightTree tree(some_lights(64));
    const std::vector<LitPoint> points = some_points();
    for (const std::size_t most : {1u, 7u, 1000u})
        for (std::size_t p = 0; p < points.size(); ++p) {
            LitPoint near = points[p];
            near.position += dvec3(0.3, -0.2, 0.1);
            near.normal = glm::normalize(near.normal + dvec3(0.1, 0.0, -0.1));
            const LightFront front(tree, near, most);
            constexpr int n = 100000;
            std::map<std::size_t, int> counts;
            std::map<std::size_t, double> probability;
            for (int i = 0; i < n; ++i)
                if (const auto choice = front.choose(points[p], (i + 0.5) / n)) {
                    ++counts[choice->light];
                    probability[choice->light] = choice->probability;
                }
            for (const auto& [light, share] : probability)
                EXPECT_NEAR(counts[light], n * share, 20.0) << most << " nodes, point " << p << ", light " << light;
            for (std::size_t i = 0; i < tree.size(); ++i)
                if (tree.probability(points[p], i) > 0.01) {
                    EXPECT_GT(counts[i], 0) << most << " nodes, point " << p << ", light " << i;
                }
        }
}

// Where the middle sees no light, points around it may.
TEST(LightFront, ReachesLightsThatTheMiddleDoesNotSee) {
    const LightTree tree(some_lights(64));
    LitPoint away{dvec3(5.0, 5.0, 30.0), dvec3(0.0, 0.0, 1.0), LitPoint::Kind::Surface};
    const LightFront front(tree, away, 16);
    LitPoint toward = away;
    toward.normal = -away.normal;
    double found = 0.0;
    for (int i = 0; i < 1000; ++i)
        if (front.choose(toward, (i + 0.5) / 1000.0))
            found += 1e-3;
    EXPECT_GT(found, 0.3);
    EXPECT_FALSE(front.choose(away, 0.5));
}

TEST(LightFront, OfNoLights) {
    const LightTree none({});
    EXPECT_FALSE(LightFront(none, {}, 8).choose({}, 0.5));
}

TEST(LightTree, NearLightsAreFoundMoreOften) {
    std::vector<LightBounds> lights = some_lights(200);
    for (LightBounds& l : lights)
        l.intensity = 1.0, l.spread = kPi;
    const LightTree tree(lights);
    const LitPoint beside{0.5 * (lights[17].low + lights[17].high) + dvec3(0.05, 0.0, 0.0), {}, LitPoint::Kind::Medium};
    // Where a box holds the point, the tree does not know on which side the light is. The bound is low for that reason.
    EXPECT_GT(tree.probability(beside, 17), 3.0 / 200.0);
}

TEST(LightTree, OneLightAndNone) {
    EXPECT_TRUE(LightTree({}).empty());
    EXPECT_FALSE(LightTree({}).choose({}, 0.5));
    std::vector<LightBounds> one = some_lights(2);
    one.erase(one.begin());
    one[0].spread = kPi;
    const auto choice = LightTree(one).choose({dvec3(1, 2, 3), {}, LitPoint::Kind::Medium}, 0.999999);
    ASSERT_TRUE(choice);
    EXPECT_EQ(choice->probability, 1.0);
}

// Lights at one position cannot be split by their positions.
TEST(LightTree, LightsAtOnePosition) {
    std::vector<LightBounds> lights(50, some_lights(2)[1]);
    const LightTree tree(lights);
    double sum = 0.0;
    for (std::size_t i = 0; i < lights.size(); ++i)
        sum += tree.probability({dvec3(-3, 1, 2), {}, LitPoint::Kind::Medium}, i);
    EXPECT_LE(sum, 1.0 + 1e-9);
}

}  // namespace
}  // namespace brisance
