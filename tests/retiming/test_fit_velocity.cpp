// The unit of a velocity, from how smoke does move.
#include <gtest/gtest.h>

#include "core/parallel.h"
#include "media/node_media.h"
#include "moving_smoke.h"

namespace brisance::testing {
namespace {

std::vector<NeighbourFrames> sequence(const MovingSmoke& smoke) {
    std::vector<NeighbourFrames> places;
    for (const int n : {1, 4, 9})
        places.push_back({n, n + 1, smoke.frame(n), smoke.frame(n + 1)});
    return places;
}

TEST(FitVelocity, FindsEachUnitWithinAFewPerCent) {
    const double fps = 24.0;
    // A unit in voxels per frame, and what it is called.
    const std::pair<double, const char*> units[] = {{1.0, "(voxel_frame)"},
                                                    {1.0 / kVoxel, "(frame)"},
                                                    {1.0 / fps, "(voxel_second)"},
                                                    {1.0 / (fps * kVoxel), "(second)"},
                                                    {0.104, "none of the usual"}};
    for (const auto& [unit, name] : units) {
        MovingSmoke smoke = turning_smoke(0.15);
        smoke.unit = unit;
        const VelocityFit fit = fit_velocity(sequence(smoke), 0);
        EXPECT_EQ(fit.why_not, "");
        EXPECT_NEAR(fit.voxels_per_frame() / unit, 1.0, 0.03);
        EXPECT_GT(fit.explained, 0.9);
        EXPECT_NEAR(fit.high / fit.low, 1.0, 0.05);
        EXPECT_NE(fit.nearest_unit(fps).find(name), std::string::npos) << fit.nearest_unit(fps);
    }
}

TEST(FitVelocity, RefusesNoise) {
    const MovingSmoke smoke = turning_smoke(0.15);
    std::vector<NeighbourFrames> places = sequence(smoke);
    int salt = 0;
    for (NeighbourFrames& place : places)
        for (SourceFrame* frame : {&place.first, &place.second}) {
            salt += 3;
            frame->velocity = centred_velocity(
                {media::colour_grid("noise", media::cubic(kVoxel), media::cube(-30, 30), [&](const ivec3& node) {
                    return Rgb(media::noise(node, salt), media::noise(node, salt + 1), media::noise(node, salt + 2)) -
                           0.5f;
                })});
        }
    const VelocityFit fit = fit_velocity(places, 0);
    EXPECT_NE(fit.why_not.find("explains"), std::string::npos) << fit.describe(24.0);
}

TEST(FitVelocity, RefusesAMotionThatTheSmokeDoesNotFollow) {
    std::vector<NeighbourFrames> places = sequence(turning_smoke(0.15));
    for (NeighbourFrames& place : places)
        for (SourceFrame* frame : {&place.first, &place.second})
            for (float& v : frame->velocity.grid.values)
                v = -v;
    EXPECT_NE(fit_velocity(places, 0).why_not, "");
}

TEST(FitVelocity, RefusesScalesThatDiffer) {
    MovingSmoke smoke = turning_smoke(0.15);
    std::vector<NeighbourFrames> places = sequence(smoke);
    smoke.unit = 2.2;
    places.resize(2);
    for (const int n : {12, 15})
        places.push_back({n, n + 1, smoke.frame(n), smoke.frame(n + 1)});
    EXPECT_NE(fit_velocity(places, 0).why_not.find("ratio"), std::string::npos);
}

TEST(FitVelocity, NeedsSmokeThatMoves) {
    EXPECT_NE(fit_velocity({}, 0).why_not, "");
    EXPECT_NE(fit_velocity(sequence(turning_smoke(0.0)), 0).why_not, "");
}

TEST(FitVelocity, DoesNotDependOnThreads) {
    const std::vector<NeighbourFrames> places = sequence(turning_smoke(0.2));
    std::vector<double> scales;
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        scales.push_back(fit_velocity(places, 0).metres_per_frame);
    }
    EXPECT_EQ(scales[0], scales[1]);
}

}  // namespace
}  // namespace brisance::testing
