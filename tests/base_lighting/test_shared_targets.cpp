// Points that neighbouring receivers test for what surfaces hide: what part of the light arrives, and with what noise.
#include "base_lighting/shared_targets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/media.h"
#include "gathering/escape_probability.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/lattice/extinction_pyramid.h"

namespace brisance {
namespace {

using namespace testing;

// A glowing ball of radius 1 m around the origin, which surfaces hide but for what lies beyond an edge.
class HiddenBall {
public:
    using Sums = std::array<double, 2>;

    bool seen(const vec3& point, float edge) const { return point.x > edge; }

    // Light of a batch that arrives at a receiver, and all of it.
    Sums light(const VisibilityRatio::Targets& targets, const SurfaceReceiver& at, float edge) const {
        std::array<VisibilityRatio::Draw, VisibilityRatio::kDraws> draws;
        ratio_.weigh({dvec3(at.local), dvec3(at.normal), LitPoint::Kind::Surface}, targets, draws);
        Sums sums{};
        for (const VisibilityRatio::Draw& d : draws) {
            sums[0] += seen(d.point, edge) ? d.weight : 0.0f;
            sums[1] += d.weight;
        }
        return sums;
    }

    // Batches for a place that sees what lies beyond `edge`, of which each is taken by so many receivers.
    TargetPool pool(const SurfaceReceiver& place, float edge, std::size_t takers, std::uint64_t seed) const {
        return {ratio_,   place,    [this, edge](const vec3& p) { return seen(p, edge); }, kBatches * takers,
                kBatches, {seed, 0}};
    }

    static constexpr std::size_t kBatches = 8;

private:
    Medium medium_ = make_medium(glowing_ball(8, 2.0f));
    ExtinctionPyramid pyramid_{medium_, ExtinctionPyramid::kMaxLevels};
    PointDepths depths_{pyramid_, 0};
    std::vector<Rgb> intensity_ = voxel_lights(medium_);
    VisibilityRatio ratio_{medium_, depths_, intensity_, escape_likelihood(medium_, depths_, intensity_)};
};

// What part of the light arrives, from all batches of many pools; and the variance of the part of a batch.
struct PartSeen {
    double part = 0.0, standard_error = 0.0, variance_of_batch = 0.0;
};

PartSeen part_seen(const HiddenBall& ball, const SurfaceReceiver& place, float edge_of_place, const SurfaceReceiver& at,
                   float edge, std::size_t takers) {
    constexpr std::uint64_t kPools = 256;
    std::vector<HiddenBall::Sums> pools;
    double arrived = 0.0, all = 0.0;
    std::vector<double> parts;
    for (std::uint64_t seed = 0; seed < kPools; ++seed) {
        TargetPool pool = ball.pool(place, edge_of_place, takers, seed);
        HiddenBall::Sums sums{};
        for (std::size_t b = 0; b < HiddenBall::kBatches; ++b) {
            const HiddenBall::Sums of_batch = ball.light(pool.batch(0.0f, b), at, edge);
            for (int k = 0; k < 2; ++k)
                sums[k] += of_batch[k];
            parts.push_back(of_batch[0] / of_batch[1]);
        }
        pools.push_back(sums);
        arrived += sums[0];
        all += sums[1];
    }
    PartSeen out;
    out.part = arrived / all;
    double squares = 0.0;
    for (const HiddenBall::Sums& p : pools)
        squares += std::pow((p[0] - out.part * p[1]) / (all / double(kPools)), 2.0);
    out.standard_error = std::sqrt(squares) / double(kPools);
    for (const double p : parts)
        out.variance_of_batch += (p - out.part) * (p - out.part) / double(parts.size());
    return out;
}

const SurfaceReceiver kPlace{{0.0f, 0.0f, 3.0f}, {0.0f, 0.0f, -1.0f}};
const SurfaceReceiver kBeside{{0.2f, 0.1f, 3.0f}, {0.0f, 0.0f, -1.0f}};

// At four standard errors, with fixed seeds: all six stay within them with a probability above 0.999.
void expect_same(const PartSeen& a, const PartSeen& b) {
    EXPECT_NEAR(a.part, b.part, 4.0 * std::hypot(a.standard_error, b.standard_error));
    EXPECT_LT(a.standard_error, 0.05 * a.part);
}

TEST(SharedTargets, ResampledBatchesFindTheSamePartOfTheLightWithLessNoise) {
    const HiddenBall ball;
    for (const float edge : {-0.5f, 0.3f, 0.7f}) {
        const PartSeen plain = part_seen(ball, kPlace, edge, kPlace, edge, 1),
                       resampled = part_seen(ball, kPlace, edge, kPlace, edge, 8);
        expect_same(resampled, plain);
        EXPECT_LT(resampled.variance_of_batch, 0.5 * plain.variance_of_batch) << edge;
    }
}

TEST(SharedTargets, ReceiversThatSeeMoreOrLessThanThePlaceFindTheirOwnPart) {
    const HiddenBall ball;
    for (const float edge_of_place : {0.1f, 0.6f, 2.0f}) {
        const PartSeen plain = part_seen(ball, kPlace, edge_of_place, kBeside, 0.4f, 1),
                       resampled = part_seen(ball, kPlace, edge_of_place, kBeside, 0.4f, 8);
        expect_same(resampled, plain);
        EXPECT_LT(resampled.variance_of_batch, 2.0 * plain.variance_of_batch) << edge_of_place;
    }
}

}  // namespace
}  // namespace brisance
