// Ray lights chosen by the light tree against all of them.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/ray_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// Few lights chosen by the tree have the mean of all, with a fixed set of lights.
TEST(RayLights, ChosenLightsHaveTheMeanOfAll) {
    for (const float g : {0.0f, 0.6f, -0.7f}) {
        const Stage stage(lumpy_ball(8, 3.0f, g), floor_below(0.7f));
        RayLightSettings settings;
        settings.paths = 60;
        settings.samples = 3;
        const RayLights lights = stage.lights(settings, 16, 5);
        const auto mean = [&](bool all, std::uint64_t per_batch) {
            return estimate(2, per_batch, [&](const dvec3&, Rng& rng, double* out) {
                const Twice seen = stage.by_lights(lights, stage.ray(rng), rng, all);
                out[0] = seen.medium.x;
                out[1] = seen.surface.x;
            });
        };
        const Estimate chosen = mean(false, 150), all = mean(true, 4);
        for (int k = 0; k < 2; ++k)
            EXPECT_NEAR(chosen.mean[k], all.mean[k], kSigmas * std::hypot(chosen.error[k], all.error[k]))
                << (k == 0 ? "MM" : "SM") << ", g " << g;
    }
}

}  // namespace
}  // namespace brisance
