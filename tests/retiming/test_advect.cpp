// Smoke that a known velocity carries, at times between two frames: blended, and advected.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "media/node_media.h"
#include "moving_smoke.h"

namespace brisance::testing {
namespace {

double error_of(const Fields& fields, const MovingSmoke& smoke, double time) {
    return relative_error(fields.at(0).value(), smoke.grid(time));
}

// Translation by 6.5 voxels a frame of a Gaussian of 3: one interpolation between nodes is what remains as error.
MovingSmoke straight() {
    MovingSmoke smoke;
    smoke.motion.velocity = {6.0, -2.3, 1.1};
    return smoke;
}

TEST(Advect, ATranslatedGaussianArrivesWhereItShould) {
    const MovingSmoke smoke = straight();
    for (const double time : {0.1, 0.5, 0.73}) {
        const BetweenFrames pair = smoke.pair(0, 1, time);
        const double advect = error_of(advected(pair, kVoxelsPerFrame), smoke, time);
        const double linear = error_of(blended(pair), smoke, time);
        EXPECT_LT(advect, 0.01) << time;
        EXPECT_GT(linear, 15.0 * advect) << time;
    }
}

TEST(Advect, ARotatedGaussianTurnsAlongItsCircle) {
    const MovingSmoke smoke = turning_smoke(0.6);  // 34 degrees a frame: chords would miss by half a voxel
    const BetweenFrames pair = smoke.pair(0, 1, 0.5);
    const double advect = error_of(advected(pair, kVoxelsPerFrame), smoke, 0.5);
    EXPECT_LT(advect, 0.03);
    EXPECT_GT(error_of(blended(pair), smoke, 0.5), 15.0 * advect);
}

TEST(Advect, MovesAcrossFramesThatAreMissing) {
    const MovingSmoke smoke = turning_smoke(0.2);
    const BetweenFrames pair = smoke.pair(0, 3, 2.0);
    EXPECT_LT(error_of(advected(pair, kVoxelsPerFrame), smoke, 2.0), 0.03);
}

TEST(Advect, KeepsAmountAndBounds) {
    const MovingSmoke smoke = turning_smoke(0.4);
    const BetweenFrames pair = smoke.pair(0, 1, 0.5);
    const BlockGrid truth = smoke.grid(0.5), moved = *advected(pair, kVoxelsPerFrame).at(0);
    double sum = 0.0, wanted = 0.0;
    float most = 0.0f;
    for (const float v : moved.values) {
        sum += v;
        most = std::max(most, v);
        EXPECT_GE(v, 0.0f) << "the limiter makes nothing negative";
    }
    for (const float v : truth.values)
        wanted += v;
    EXPECT_NEAR(sum / wanted, 1.0, 0.01);
    const std::vector<float> known = pair.first.fields[0]->values;
    EXPECT_LE(most, *std::max_element(known.begin(), known.end())) << "nor anything above what was there";
}

TEST(Advect, EachUnitMeansTheSameMotion) {
    MovingSmoke smoke = straight();
    const double reference = error_of(advected(smoke.pair(0, 1, 0.5), kVoxelsPerFrame), smoke, 0.5);
    const double fps = 30.0;
    const std::pair<VelocitySettings, double> units[] = {{{VelocityUnit::Second, 1.0, fps}, 1.0 / (fps * kVoxel)},
                                                         {{VelocityUnit::Frame, 1.0, fps}, 1.0 / kVoxel},
                                                         {{VelocityUnit::VoxelSecond, 1.0, fps}, 1.0 / fps},
                                                         {{VelocityUnit::VoxelFrame, 0.5, fps}, 0.5}};
    for (const auto& [settings, unit] : units) {
        smoke.unit = unit;
        EXPECT_NEAR(error_of(advected(smoke.pair(0, 1, 0.5), settings), smoke, 0.5), reference, 1e-4);
    }
}

TEST(Advect, WithoutVelocityIsABlend) {
    MovingSmoke smoke = straight();
    BetweenFrames pair = smoke.pair(0, 1, 0.25);
    pair.first.velocity = pair.second.velocity = {};
    EXPECT_LT(relative_error(*advected(pair, kVoxelsPerFrame).at(0), *blended(pair).at(0)), 1e-6);
}

TEST(Advect, AFrameWithoutVelocityMovesAsTheOther) {
    const MovingSmoke smoke = straight();
    BetweenFrames pair = smoke.pair(0, 1, 0.5);
    pair.first.velocity = {};
    EXPECT_LT(error_of(advected(pair, kVoxelsPerFrame), smoke, 0.5), 0.01);
}

TEST(Advect, ADomainThatGrowsChangesNothing) {
    const MovingSmoke smoke = straight();
    BetweenFrames pair = smoke.pair(0, 1, 0.5);
    const Fields same = advected(pair, kVoxelsPerFrame);
    pair.second.fields[0] = smoke.grid(1, {5, -3, 11});  // another origin of indices, the same places
    EXPECT_LT(relative_error(*advected(pair, kVoxelsPerFrame).at(0), *same.at(0)), 1e-5);
    const Fields blend = blended(pair);
    pair.second.fields[0] = smoke.grid(1);
    EXPECT_LT(relative_error(*blend.at(0), *blended(pair).at(0)), 1e-5);
}

TEST(Advect, DoesNotDependOnThreads) {
    const MovingSmoke smoke = turning_smoke(0.5);
    const BetweenFrames pair = smoke.pair(0, 1, 0.4);
    std::vector<BlockGrid> results;
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        results.push_back(*advected(pair, kVoxelsPerFrame).at(0));
    }
    EXPECT_EQ(results[0].block_origin, results[1].block_origin);
    EXPECT_EQ(results[0].values, results[1].values);
}

TEST(Advect, MovesAllRolesAndChannelsAlike) {
    const MovingSmoke smoke = straight();
    BetweenFrames pair = smoke.pair(0, 1, 0.5);
    for (SourceFrame* frame : {&pair.first, &pair.second}) {
        BlockGrid colour = *frame->fields[0];
        colour.channels = 3;
        colour.values.clear();
        for (const float v : frame->fields[0]->values)
            for (const float share : {1.0f, 0.5f, 0.25f})
                colour.values.push_back(share * v);
        frame->fields.emplace_back();  // a role that is absent
        frame->fields.emplace_back(colour);
    }
    const Fields out = advected(pair, kVoxelsPerFrame);
    ASSERT_FALSE(out.at(1).has_value());
    ASSERT_EQ(out[0]->values.size() * 3, out[2]->values.size());
    for (std::size_t i = 0; i < out[0]->values.size(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_FLOAT_EQ(out[2]->values[3 * i + c], out[0]->values[i] / static_cast<float>(1 << c));
}

TEST(Advect, RefusesVelocitiesThatCannotBeMeant) {
    const MovingSmoke smoke = straight();
    try {
        advected(smoke.pair(0, 1, 0.5), {VelocityUnit::VoxelFrame, 100.0, 24.0});
        ADD_FAILURE() << "650 voxels a frame in a box of 50";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::BadData);
        EXPECT_NE(std::string(error.what()).find("set velocity.unit to auto"), std::string::npos);
    }
}

TEST(Blend, IsTheWeightedMeanOnBothTopologies) {
    const MovingSmoke smoke = straight();
    const BlockGrid mean = *blended(smoke.pair(0, 1, 0.25)).at(0);
    for (std::size_t b = 0; b < mean.block_origin.size(); ++b)
        for (int n = 0; n < 512; n += 37) {
            const dvec3 p(mean.block_origin[b] + ivec3(n >> 6, n >> 3 & 7, n & 7));
            const float wanted = static_cast<float>(0.75 * smoke.density(p, 0) + 0.25 * smoke.density(p, 1));
            EXPECT_NEAR(mean.values[b * 512 + n], wanted, 1e-6);
        }
}

}  // namespace
}  // namespace brisance::testing
