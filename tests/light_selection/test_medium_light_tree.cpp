// Choosing among ray lights: probabilities are what they are said to be, the mean is the sum over all lights, and the
// cost grows like the logarithm of their number.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "fixtures/ray_fixture.h"

namespace brisance {
namespace {

using namespace testing;

std::vector<RayLight> random_lights(std::size_t count) {
    Rng rng(Stream::Points, 21);
    std::vector<RayLight> lights(count);
    for (RayLight& light : lights) {
        const dvec3 start(rng.next_double(), rng.next_double(), rng.next_double());
        const double u = rng.next_double();
        light.segment = {start, uniform_direction(u, rng.next_double()), 0.2 * rng.next_double()};
        light.scattered = std::exp(4.0 * rng.next_double());
        light.extinction = 10.0 * rng.next_double();
    }
    return lights;
}

std::vector<LightReceiver> some_receivers() {
    return {LightReceiver::along({{-1.0, 0.4, 0.3}, glm::normalize(dvec3(1.0, 0.1, 0.2)), 3.0}),
            LightReceiver::along({{0.5, 0.5, 0.5}, {0.0, 0.0, 1.0}, 0.01}),
            LightReceiver::along({{50.0, 0.5, 0.5}, {0.0, 0.0, 1.0}, 2.0}),
            LightReceiver::at({0.5, 0.5, -0.1}, {0.0, 0.0, 1.0}), LightReceiver::at({0.5, 0.5, 0.5}, {1.0, 0.0, 0.0})};
}

TEST(MediumLightTree, ProbabilitiesAddUpToOne) {
    const std::vector<RayLight> lights = random_lights(500);
    for (const double g : {0.0, 0.8, -0.999}) {
        const MediumLightTree tree(boxes_of(lights), g);
        for (const LightReceiver& receiver : some_receivers()) {
            double sum = 0.0;
            for (std::size_t i = 0; i < lights.size(); ++i) {
                const double p = tree.probability(receiver, i);
                EXPECT_GT(p, 0.0);
                sum += p;
            }
            EXPECT_NEAR(sum, 1.0, 1e-9);
        }
    }
}

TEST(MediumLightTree, ChoosesAsItSays) {
    constexpr int kSamples = 200'000, kLights = 40;
    const std::vector<RayLight> lights = random_lights(kLights);
    for (const double g : {0.0, 0.8}) {
        const MediumLightTree tree(boxes_of(lights), g);
        for (const LightReceiver& receiver : some_receivers()) {
            std::map<std::size_t, int> chosen;
            Rng rng(Stream::Points, 22);
            for (int i = 0; i < kSamples; ++i) {
                const auto choice = tree.choose(receiver, rng.next_double());
                ASSERT_TRUE(choice);
                ASSERT_NEAR(choice->probability / tree.probability(receiver, choice->light), 1.0, 1e-9);
                ++chosen[choice->light];
            }
            double chi_square = 0.0;
            for (std::size_t i = 0; i < lights.size(); ++i) {
                const double expected = kSamples * tree.probability(receiver, i);
                chi_square += std::pow(chosen[i] - expected, 2) / expected;
            }
            EXPECT_GT(chi_square_tail(chi_square, kLights - 1), 1e-4) << chi_square;
        }
    }
}

TEST(MediumLightTree, WithoutLightsNoneIsChosen) {
    EXPECT_FALSE(MediumLightTree({}, 0.0).choose(some_receivers()[0], 0.5));
}

// Lights of no power, and no power at all, are no trouble.
TEST(MediumLightTree, DarkLightsAreNotChosen) {
    std::vector<RayLight> lights = random_lights(9);
    for (RayLight& light : lights)
        light.scattered = 0.0;
    EXPECT_FALSE(MediumLightTree(boxes_of(lights), 0.0).choose(some_receivers()[0], 0.5));
    lights[4].scattered = 1.0;
    const auto choice = MediumLightTree(boxes_of(lights), 0.0).choose(some_receivers()[0], 0.5);
    ASSERT_TRUE(choice);
    EXPECT_EQ(choice->light, 4u);
    EXPECT_DOUBLE_EQ(choice->probability, 1.0);
}

TEST(MediumLightTree, CostGrowsLikeTheLogarithm) {
    std::printf(" lights  nodes evaluated for one light\n");
    for (const std::size_t count : {100, 1'000, 10'000, 100'000}) {
        const MediumLightTree tree(boxes_of(random_lights(count)), 0.3);
        Rng rng(Stream::Points, 23);
        int most = 0;
        for (int i = 0; i < 1000; ++i)
            most = std::max(most, tree.choose(some_receivers()[0], rng.next_double())->visited);
        std::printf("%7zu  %d\n", count, most);
        EXPECT_LE(most, 1 + 2 * static_cast<int>(std::ceil(std::log2(double(count)))));
    }
}

}  // namespace
}  // namespace brisance
