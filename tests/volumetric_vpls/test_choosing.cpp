// Few point lights chosen by the tree have the mean of all, with a fixed set of lights; and lights are the same for any
// number of threads.
#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "point_fixture.h"

namespace brisance {
namespace {

using namespace testing;

TEST(VolumetricVpls, ChosenLightsHaveTheMeanOfAll) {
    for (const float g : {0.0f, 0.6f, -0.3f}) {
        const Stage stage(lumpy_ball(8, 3.0f, g), floor_below(0.7f));
        VolumetricVplSettings settings = points(0.3, BiasCompensation::None);
        settings.paths = 200;
        settings.samples = 3;
        const VolumetricVpls lights(stage.scene(), settings, -1, stage.receivers(16, 5));
        const auto mean = [&](bool all, std::uint64_t per_batch) {
            return estimate(2, per_batch, [&](const dvec3&, Rng& rng, double* out) {
                const Twice seen = stage.by_lights(lights, stage.ray(rng), rng, all);
                out[0] = seen.medium.x;
                out[1] = seen.surface.x;
            });
        };
        const Estimate chosen = mean(false, 150), all = mean(true, 6);
        for (int k = 0; k < 2; ++k) {
            const double error = std::hypot(chosen.error[k], all.error[k]);
            EXPECT_NEAR(chosen.mean[k], all.mean[k], kSigmas * error) << (k == 0 ? "MM" : "SM") << ", g " << g;
            EXPECT_LT(error, 0.08 * all.mean[k]);
        }
    }
}

// Vertices in smoke also choose lights by the tree, on paths that compensate.
TEST(VolumetricVpls, ChosenLightsHaveTheMeanOfAllAtAPointInSmoke) {
    for (const float g : {0.0f, 0.6f, -0.3f}) {
        const Stage stage(lumpy_ball(8, 3.0f, g), {});
        VolumetricVplSettings settings = points(0.3, BiasCompensation::None);
        VolumetricVplReport report;
        const VplSum sum(stage.scene(), trace_vpls(stage.scene(), settings, -1, report),
                         bound_of(settings, stage.scene().field()), -1);
        for (const int order : {1, 2}) {
            const auto mean = [&](bool all, std::uint64_t per_batch) {
                return estimate(1, per_batch, [&](const dvec3& u, Rng& rng, double* out) {
                    const dvec3 position = 0.9 * u - dvec3(0.45), arriving = uniform_direction(u.x, u.y);
                    const PathVertex at(position, arriving, g);
                    out[0] = (all ? sum.at_from_all(at, order, rng) : sum.at(at, order, 1, rng)).x;
                });
            };
            const Estimate chosen = mean(false, 100), all = mean(true, 10);
            EXPECT_NEAR(chosen.mean[0], all.mean[0], kSigmas * std::hypot(chosen.error[0], all.error[0])) << g;
            EXPECT_LT(chosen.error[0], 0.05 * all.mean[0]);
        }
    }
}

TEST(VolumetricVpls, ThreadsChangeNothing) {
    const Stage stage(lumpy_ball(8, 3.0f, 0.3f), floor_below(0.7f));
    const auto seen = [&](int threads) {
        const ThreadLimit limit(threads);
        VolumetricVplSettings settings = points(0.3, BiasCompensation::Exact);
        settings.count = 300;
        const VolumetricVpls lights(stage.scene(), settings, -1, stage.receivers(16, 5));
        std::vector<float> out{float(lights.lights().size())};
        Rng rng(Stream::Points, 8);
        for (int i = 0; i < 50; ++i) {
            const Twice t = stage.by_lights(lights, stage.ray(rng), rng);
            out.insert(out.end(), {t.medium.x, t.medium.y, t.surface.x});
        }
        return out;
    };
    EXPECT_EQ(seen(1), seen(2));
}

}  // namespace
}  // namespace brisance
