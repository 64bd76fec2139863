// The similar medium of lower extinction in which scattered light is solved.
#include "medium/similar_medium.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "media/node_media.h"

namespace brisance {
namespace {

Medium ball(float optical_radius, float albedo, float g = 0.0f) {
    media::Recipe r = media::glowing_ball(8, optical_radius);
    r.settings.smoke.albedo = Rgb(albedo);
    r.settings.smoke.mean_cosine = g;
    return media::make_medium(r);
}

TEST(SimilarMedium, IsNotMadeWhereTheMediumWillDo) {
    for (const float g : {-0.7f, 0.0f, 0.5f})
        EXPECT_FALSE(similar_medium(ball(8.0f, 0.9f, g), -1)) << g;
    // Up to two mean free paths to a voxel.
    EXPECT_FALSE(similar_medium(ball(15.9f, 0.9f), -1));
    EXPECT_TRUE(similar_medium(ball(17.0f, 0.9f), -1));
}

TEST(SimilarMedium, AFewScatteringsKeepTheirForwardPeak) {
    EXPECT_FALSE(similar_medium(ball(1.0f, 0.9f, 0.95f), 2));
    EXPECT_TRUE(similar_medium(ball(1.0f, 0.9f, 0.95f), -1));
}

// What is left is scattered as before, and extinguished by all that there is.
TEST(SimilarMedium, OfSingleScatteringThePeakIsLeftOut) {
    const Medium before = ball(2.0f, 0.9f, 0.9f), after = *similar_medium(before, 1);
    EXPECT_EQ(after.extinction, before.extinction);
    EXPECT_EQ(after.source, before.source);
    for (const Rgb& albedo : after.albedo_nodes)
        EXPECT_NEAR(albedo.x, 0.9 * (1.0 - 0.729), 1e-6);
}

// Delta scaling: what is absorbed stays, and so do the first moments of what is scattered, the peak's share counted in.
TEST(SimilarMedium, TakesOutForwardScatteringAlone) {
    const Medium before = ball(2.0f, 0.9f, 0.9f), after = *similar_medium(before, -1);
    const double share = forward_share(0.9f), g = after.mean_cosine;
    EXPECT_NEAR(share, 0.9 * 0.9 * 0.9, 1e-6);
    EXPECT_NEAR(share + (1.0 - share) * g, 0.9, 1e-6);
    for (std::size_t i = 0; i < before.extinction.size(); ++i) {
        const double sigma = before.extinction[i], scattered = sigma * 0.9;
        EXPECT_NEAR(after.extinction[i], sigma - share * scattered, 1e-6 * sigma);
        EXPECT_NEAR(after.extinction[i] * (1.0 - after.albedo_nodes[i].x), sigma - scattered, 1e-6 * sigma);
    }
}

TEST(SimilarMedium, EmitsWhatTheMediumEmits) {
    const Medium before = ball(2.0f, 0.9f, 0.9f), after = *similar_medium(before, -1);
    for (std::size_t i = 0; i < before.extinction.size(); ++i)
        EXPECT_NEAR(after.extinction[i] * after.source[i].x, before.extinction[i] * before.source[i].x, 1e-6f);
}

TEST(SimilarMedium, ForwardShareGrowsFromNothing) {
    float before = 0.0f;
    for (float g = -1.0f; g <= 1.0f; g += 0.01f) {
        const float share = forward_share(g);
        EXPECT_GE(share, before);
        EXPECT_LE(share, std::max(0.0f, g));
        before = share;
    }
    EXPECT_EQ(forward_share(0.5f), 0.0f);
}

TEST(SimilarMedium, WidensBackwardPeaks) {
    EXPECT_NEAR(similar_medium(ball(1.0f, 0.9f, -0.999f), -1)->mean_cosine, -0.7f, 1e-6f);
    EXPECT_NEAR(similar_medium(ball(1.0f, 0.9f, -0.999f), 2)->mean_cosine, -0.8f, 1e-6f);
    const Medium before = ball(1.0f, 0.9f, -0.999f), after = *similar_medium(before, -1);
    EXPECT_EQ(after.extinction, before.extinction);
}

// Stiff smoke that absorbs nothing still absorbs nothing and sends out all it emits, however opaque.
TEST(SimilarMedium, ConservesPowerWhereNothingIsAbsorbed) {
    media::Recipe r = media::glowing_ball(8, 1e4f);
    r.settings.smoke.albedo = Rgb(1.0f);
    r.flame = r.density;
    r.settings.fire.convention = EmissionConvention::Direct;
    const Medium before = media::make_medium(r), after = *similar_medium(before, -1);
    EXPECT_LE(after.max_extinction * after.spacing, 4.0f);
    EXPECT_EQ(after.emission, before.emission);
    EXPECT_TRUE(
        std::all_of(after.albedo_nodes.begin(), after.albedo_nodes.end(), [](const Rgb& a) { return a == Rgb(1.0f); }));
}

}  // namespace
}  // namespace brisance
