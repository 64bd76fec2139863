// The roulette that keeps the lights that matter to the camera.
#include "light_selection/thin_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numeric>

#include "fixtures/ray_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// A ball of smoke behind a wall at y = 0, seen from y < 0, and lights on both sides of it.
struct WalledSmoke {
    WalledSmoke() : stage(coloured_ball(4, 1.0f, 0.0f), wall()) {
        Rng rng(Stream::Points, 31);
        for (int i = 0; i < 1000; ++i) {
            MediumLightBounds light;
            light.low = light.high = {rng.next_double() - 0.5, rng.next_double() - 0.5, rng.next_double() - 0.5};
            light.scattered = 0.5 + rng.next_double();
            light.extinction = 0.5;
            lights.push_back(light);
        }
        for (int i = 0; i < 20; ++i) {
            const double x = 0.04 * i - 0.4;
            receivers.push_back(LightReceiver::along({{x, -0.5, -1.0}, {0.0, 0.0, 1.0}, 2.0}));
            receivers.push_back(LightReceiver::at({x, -0.01, 0.3}, {0.0, -1.0, 0.0}));
        }
    }

    static Scene wall() {
        Scene set;
        add_quad(set, {-50, 0, -50}, {100, 0, 0}, {0, 0, 100}, lambert(0.5f));
        return set;
    }
    Thinning thinning(bool visibility, std::uint32_t seed = 0) const {
        return {200, 0.0, visibility ? stage.scene().occluders() : nullptr, Stream::RayLightRoulette, seed};
    }
    bool hidden(std::size_t i) const { return lights[i].low.y > 0.0; }

    Stage stage;
    std::vector<MediumLightBounds> lights;
    std::vector<LightReceiver> receivers;
};

TEST(ThinLights, KeepsAsManyAsAsked) {
    const WalledSmoke room;
    for (const bool visibility : {false, true}) {
        const std::vector<double> chances =
            survival_probabilities(room.lights, room.receivers, room.thinning(visibility));
        EXPECT_NEAR(std::accumulate(chances.begin(), chances.end(), 0.0), 200.0, 0.1);
        for (const double chance : chances)
            EXPECT_TRUE(chance > 0.0 && chance <= 1.0) << chance;
    }
}

// All lines from one side end at the wall, and none from the other.
TEST(ThinLights, KeepsFewOfWhatAWallHides) {
    const WalledSmoke room;
    const std::vector<double> plain = survival_probabilities(room.lights, room.receivers, room.thinning(false)),
                              seen = survival_probabilities(room.lights, room.receivers, room.thinning(true));
    double plain_hidden = 0.0, seen_hidden = 0.0;
    for (std::size_t i = 0; i < room.lights.size(); ++i)
        if (room.hidden(i)) {
            plain_hidden += plain[i] / 200.0;
            seen_hidden += seen[i] / 200.0;
        } else {
            EXPECT_GE(seen[i], plain[i]) << i;
        }
    std::printf("share of hidden lights: %.3g, with visibility %.3g\n", plain_hidden, seen_hidden);
    EXPECT_GT(plain_hidden, 0.15);
    EXPECT_LT(seen_hidden, 0.5 * plain_hidden);
}

// What the lights on this side send to a point, over 400 roulettes: the same mean, and less variance where none is
// wasted on lights behind the wall.
TEST(ThinLights, HasTheMeanOfAllAndLessVarianceByVisibility) {
    const WalledSmoke room;
    const dvec3 at(0.1, -0.8, 0.1);
    std::vector<double> sent;
    for (std::size_t i = 0; i < room.lights.size(); ++i) {
        const dvec3 offset = room.lights[i].low - at;
        sent.push_back(room.hidden(i) ? 0.0 : room.lights[i].scattered / glm::dot(offset, offset));
    }
    const double all = std::accumulate(sent.begin(), sent.end(), 0.0);
    double variance[2];
    for (const bool visibility : {false, true}) {
        constexpr int kTimes = 400;
        const std::vector<double> chances =
            survival_probabilities(room.lights, room.receivers, room.thinning(visibility));
        double sum = 0.0, squares = 0.0;
        for (int k = 0; k < kTimes; ++k) {
            double light = 0.0;
            for (std::size_t i = 0; i < sent.size(); ++i)
                if (Rng(Stream::RayLightRoulette, i, std::uint64_t(k)).next_double() < chances[i])
                    light += sent[i] / chances[i];
            sum += light / kTimes;
            squares += light * light / kTimes;
        }
        variance[visibility] = squares - sum * sum;
        EXPECT_NEAR(sum, all, 4.0 * std::sqrt(variance[visibility] / kTimes));
    }
    std::printf("relative variance %.3g, with visibility %.3g\n", variance[0] / (all * all), variance[1] / (all * all));
    EXPECT_LT(variance[1], 0.8 * variance[0]);
}

}  // namespace
}  // namespace brisance
