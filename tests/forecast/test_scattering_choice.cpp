// The weights of the solutions of scattered light.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/media.h"
#include "forecast/mean_escape.h"
#include "forecast/scattering_choice.h"

namespace brisance {
namespace {

using namespace testing;

Medium smoke(float mean_cosine) {
    Recipe r = glowing_ball(8, 1.0f);
    r.settings.smoke.albedo = Rgb(0.8f);
    r.settings.smoke.mean_cosine = mean_cosine;
    return make_medium(r);
}

Shot shot_with(const std::string& method, float escape = -1.0f) {
    Shot shot;
    shot.scattering_methods.method = method;
    shot.scattering.escape = escape;
    return shot;
}

const std::string kPhotons = VolumetricPhotonsMethod::kName;

// Parts of a picture.
struct Parts {
    float photons, emitters_by_rays;
};

Parts parts_of(float escape, float mean_cosine) {
    Medium medium;  // what it looks like is stated
    medium.mean_cosine = mean_cosine;
    const ScatteringChoice c = choose_scattering(shot_with(kAutomaticMethod, escape), medium, true, true);
    return {c.share, c.share + (1.0f - c.share) * c.emitters_by_rays};
}

TEST(ScatteringChoice, IsOneSolutionFarFromTheLimits) {
    EXPECT_EQ(parts_of(1.0f, 0.8f).photons, 1.0f);
    EXPECT_EQ(parts_of(1.0f, -0.8f).photons, 1.0f);
    EXPECT_EQ(parts_of(1.0f, 0.3f).photons, 0.0f);
    EXPECT_EQ(parts_of(0.0f, 0.8f).photons, 0.0f);
    EXPECT_EQ(parts_of(1.0f, 0.0f).emitters_by_rays, 1.0f);
    EXPECT_EQ(parts_of(1.0f, 0.8f).emitters_by_rays, 1.0f);
    EXPECT_EQ(parts_of(0.0f, 0.0f).emitters_by_rays, 0.0f);
}

// Whatever the phase function: beams of lamps may be narrower than voxels.
TEST(ScatteringChoice, TheGridLeavesLampsToRaysAsFarAsSmokeIsThin) {
    for (const float escape : {0.0f, 0.05f, 0.1f, 0.15f, 0.2f, 0.5f})
        for (const float g : {0.0f, 0.7f})
            for (const std::string& method : {std::string(kAutomaticMethod), std::string(kLightingGridMethod)}) {
                const ScatteringChoice c = choose_scattering(shot_with(method, escape), smoke(g), true, true);
                EXPECT_EQ(c.emitters_by_rays, thinness(escape)) << method << " " << escape << " " << g;
            }
}

TEST(ScatteringChoice, IsContinuous) {
    constexpr float kStep = 0.001f;
    // The steepest slopes of the smoothsteps, 1.5 over their widths, with room; of 1 - (1 - share) (1 - thin), 1.6
    // times as steep.
    constexpr float kMost = 20.0f * kStep, kMostOfEmitters = 1.6f * kMost;
    for (float escape = 0.0f; escape <= 0.6f; escape += 0.02f)
        for (float g = 0.35f; g < 0.65f; g += 0.01f) {
            const Parts here = parts_of(escape, g);
            for (const Parts& there : {parts_of(escape + kStep, g), parts_of(escape, g + kStep)}) {
                EXPECT_NEAR(here.photons, there.photons, kMost) << escape << " " << g;
                EXPECT_NEAR(here.emitters_by_rays, there.emitters_by_rays, kMostOfEmitters) << escape << " " << g;
            }
        }
}

TEST(ScatteringChoice, DoesNotAskWhetherABoxOrAFileHoldsTheSmoke) {
    Shot box = shot_with(kAutomaticMethod), file = box;
    box.volumes.emplace_back().volume.box = FogBox{{-1, -1, -1}, {1, 1, 1}, 0.1};
    file.volume.file = "smoke.vdb";
    for (const float g : {0.0f, 0.45f, 0.5f, 0.8f, -0.8f}) {
        const ScatteringChoice a = choose_scattering(box, smoke(g), true, true),
                               b = choose_scattering(file, smoke(g), true, true);
        EXPECT_EQ(a.method, b.method);
        EXPECT_EQ(a.share, b.share);
        EXPECT_EQ(a.emitters_by_rays, b.emitters_by_rays);
        EXPECT_EQ(a.reason, b.reason);
        EXPECT_GT(a.share + a.emitters_by_rays, 0.0f);
    }
}

TEST(ScatteringChoice, LooksAtTheMediumOnlyWhereThatDecides) {
    const auto looks = [](const std::string& method, float g, bool twice, bool lamps) {
        return !choose_scattering(shot_with(method), smoke(g), twice, lamps).cost.name.empty();
    };
    EXPECT_FALSE(looks(kAutomaticMethod, 0.4f, true, false));
    EXPECT_FALSE(looks(kAutomaticMethod, 0.8f, false, false));
    EXPECT_TRUE(looks(kAutomaticMethod, 0.8f, true, false));
    EXPECT_TRUE(looks(kAutomaticMethod, 0.0f, true, true));
    EXPECT_TRUE(looks(kAutomaticMethod, 0.8f, false, true));
    EXPECT_TRUE(looks(kLightingGridMethod, 0.0f, true, true));
    EXPECT_TRUE(looks(kLightingGridMethod, 0.8f, true, true));
    EXPECT_FALSE(looks(kLightingGridMethod, 0.8f, true, false));
    EXPECT_FALSE(looks(kPhotons, 0.8f, true, true));
    EXPECT_TRUE(looks(kPhotons, 0.8f, false, true));
}

TEST(ScatteringChoice, SaysByWhatItChose) {
    const Medium medium = smoke(0.8f);
    const ScatteringChoice c = choose_scattering(shot_with(kAutomaticMethod), medium, true, true);
    EXPECT_DOUBLE_EQ(c.cost.detail.at("mean_escape").get<double>(), mean_escape(medium));
    EXPECT_FLOAT_EQ(c.cost.detail.at("share_of_method").get<float>(), c.share);
    const ScatteringChoice stated = choose_scattering(shot_with(kAutomaticMethod, 0.25f), medium, true, true);
    EXPECT_EQ(stated.cost.detail.at("mean_escape").get<double>(), 0.25);
    EXPECT_NE(stated.reason.find("0.25"), std::string::npos) << stated.reason;
    EXPECT_EQ(choose_scattering(shot_with(kPhotons), medium, true, true).share, 1.0f);
    EXPECT_EQ(choose_scattering(shot_with(kPhotons), medium, false, true).share, 0.0f);
}

TEST(ScatteringChoice, IsLeftOpenWhereASequenceMaySwitch) {
    Shot shot = shot_with(kAutomaticMethod);
    EXPECT_FALSE(leaves_escape_open(shot));
    shot.medium.smoke.mean_cosine = 0.5f;
    EXPECT_TRUE(leaves_escape_open(shot));
    shot.scattering.escape = 0.3f;
    EXPECT_FALSE(leaves_escape_open(shot));
    Shot lamps = shot_with(kLightingGridMethod);
    lamps.scene.lights.emplace_back();
    EXPECT_TRUE(leaves_escape_open(lamps));
    lamps.method = RenderMethod::Path;
    EXPECT_FALSE(leaves_escape_open(lamps));
}

}  // namespace
}  // namespace brisance
