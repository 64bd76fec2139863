// Light on a coarser lattice than the medium's.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/media.h"
#include "layer_difference.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/coarse_medium.h"
#include "medium_lighting/levels/coarse_lighting.h"
#include "medium_lighting/levels/light_of_detail.h"
#include "medium_lighting/levels/lighting_level.h"
#include "render/render_frame.h"
#include "small_view.h"

namespace brisance {
namespace {

using namespace testing;

// Thin smoke with fire that changes slowly from node to node.
Medium smooth_fire(float extinction) {
    Recipe r;
    r.box = cube(-16, 16);
    r.world_from_index = cubic(0.075);
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 14.0); };
    r.flame = [](const ivec3& n) {
        const float d = glm::length(vec3(n) - vec3(3.0f, -4.0f, 0.0f)) / 9.0f;
        return d < 1.0f ? (1.0f - d * d) * (1.0f - d * d) : 0.0f;
    };
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = Rgb(0.7f);
    r.settings.fire.convention = EmissionConvention::Direct;
    return make_medium(r);
}

RenderedFrame picture_on(const Medium& medium, int level) {
    Shot shot = small_view(24);
    shot.lighting.lattice_level = level;
    Progress silent;
    return render_medium(shot, medium, silent);
}

// Of light that is a part of the picture's, the next coarser lattice adds as much less to the picture.
TEST(LightingLevel, InterpolationIsToleratedByTheShareOfTheLight) {
    const ToleratedInterpolation tolerated{0.005f, 2.4f}, stated{0.0025f, 0.0f};
    EXPECT_EQ(tolerated.of(1.0f), 0.0f);
    EXPECT_EQ(tolerated.of(0.625f), 0.0f);
    EXPECT_FLOAT_EQ(tolerated.of(0.4f), 0.005f);
    EXPECT_GT(tolerated.of(0.5f), tolerated.of(0.51f));
    EXPECT_FLOAT_EQ(stated.of(1.0f), 0.0025f);
}

TEST(LightingLevel, LinearLightIsInterpolatedAsItIs) {
    const Medium fine = smooth_fire(1.0f);
    const auto light_at = [](const ivec3& node) {
        return Rgb(100.0f + float(node.x), 100.0f - 2.0f * float(node.y), 100.0f + 3.0f * float(node.z));
    };
    for (const int level : {1, 2, 3}) {
        const Medium coarse = medium_to_light(fine, level);
        std::vector<Rgb> light(coarse.lattice.node_count());
        for (std::size_t i = 0; i < light.size(); ++i)
            light[i] = light_at(coarse.lattice.node(i) << level);
        const std::vector<Rgb> found = light_at_fine_nodes(coarse.lattice, light, level, fine.lattice);
        for (std::size_t i = 0; i < found.size(); ++i)
            for (int c = 0; c < 3 && fine.extinction[i] > 0.0f; ++c)
                ASSERT_NEAR(found[i][c], light_at(fine.lattice.node(i))[c], 1e-3f) << level;
    }
}

TEST(LightingLevel, TheMeanMediumEmitsAndExtinguishesAsMuch) {
    const Medium fine = smooth_fire(2.0f), coarse = medium_to_light(fine, 2);
    const auto extinction = [](const Medium& m) {
        double sum = 0.0;
        for (const float e : m.extinction)
            sum += e;
        return sum * m.voxel_volume;
    };
    EXPECT_NEAR(extinction(coarse) / extinction(fine), 1.0, 1e-4);
    EXPECT_NEAR(total_luminance(voxel_lights(coarse)) / total_luminance(voxel_lights(fine)), 1.0, 1e-4);
}

double mean_of(const RenderedFrame& frame, const char* layer) {
    double sum = 0.0;
    for (const float v : frame.image.layer(layer).pixels)
        sum += v;
    return sum;
}

// Burning clumps two voxels wide, of two thirds more and less smoke: voxels twice as wide blur them. Where dense smoke
// lights itself more collides, and the rest must be darker. Measured: 1.1 % too much light, and 2.2 % if it is not.
TEST(LightOfDetail, PathTracerSeesAsMuchLightInClumps) {
    Recipe r;
    r.box = cube(-16, 16);
    r.world_from_index = cubic(0.075);
    r.density = [](const ivec3& n) {
        const ivec3 clump = (n + 1) >> 1;
        const auto hash = static_cast<std::uint32_t>(clump.x * 73856093) ^
                          static_cast<std::uint32_t>(clump.y * 19349663) ^
                          static_cast<std::uint32_t>(clump.z * 83492791);
        return ball(n, dvec3(0.0), 14.0) * (1.0f + ((hash * 2654435761u) >> 31 ? 0.65f : -0.65f));
    };
    r.flame = r.density;
    r.settings.smoke.extinction_per_metre = 4.0f;
    r.settings.smoke.albedo = Rgb(0.7f);
    r.settings.fire.convention = EmissionConvention::Direct;
    const Medium medium = make_medium(r);
    Shot shot = small_view(24);
    shot.scattering.bounces = 1;
    shot.lighting.lattice_level = 1;
    Progress silent;
    const RenderedFrame found = render_medium(shot, medium, silent);
    shot.method = RenderMethod::Path;
    shot.tracing.samples = 100;
    const RenderedFrame truth = render_medium(shot, medium, silent);
    EXPECT_NEAR(mean_of(found, "MV") / mean_of(truth, "MV"), 1.0, 0.017);
}

// The fire's light of radiance 1 on voxels twice as wide, at the medium's own nodes.
std::vector<Rgb> even_light_with_detail(const Medium& fine) {
    const Medium coarse = medium_to_light(fine, 1);
    const std::size_t n = fine.lattice.node_count();
    const std::vector<Rgb> mean(n, Rgb(1.0f));
    std::vector<Rgb> light = mean;
    add_light_of_detail(fine, {coarse, mean, true}, std::vector<std::uint8_t>(n, 1), light);
    return light;
}

// Where the finer lattice knows nothing more, it adds nothing. What the box's sides change scales all light alike.
TEST(LightOfDetail, LinearFieldsHaveNone) {
    Recipe r;
    r.box = cube(-16, 15);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3& n) { return 2.0f + 0.05f * float(n.x); };
    r.flame = [](const ivec3& n) { return 2.0f - 0.05f * float(n.y); };
    r.settings.fire.convention = EmissionConvention::Direct;
    const Medium fine = make_medium(r);
    const std::vector<Rgb> light = even_light_with_detail(fine);
    for (std::size_t i = 0; i < light.size(); ++i) {
        const bool inside = glm::all(glm::lessThan(glm::abs(fine.lattice.node(i)), ivec3(10)));
        ASSERT_NEAR(inside ? light[i].x / light[std::size_t(fine.lattice.find_node(ivec3(0)))].x : 1.0f, 1.0f, 1e-4f);
    }
}

// A sheet one node thick, of fire or of smoke.
TEST(LightOfDetail, FireLightsItselfAndSmokeHidesItself) {
    const auto at_sheet = [](bool fire) {
        Recipe r;
        r.box = cube(-16, 15);
        r.world_from_index = cubic(0.1);
        r.density = [=](const ivec3& n) { return !fire && n.x == 0 ? 2.0f : 1.0f; };
        r.flame = [=](const ivec3& n) { return fire && n.x == 0 ? 2.0f : 1.0f; };
        r.settings.fire.convention = EmissionConvention::Direct;
        const Medium fine = make_medium(r);
        return even_light_with_detail(fine)[std::size_t(fine.lattice.find_node(ivec3(0)))].x;
    };
    EXPECT_GT(at_sheet(true), 1.01f);
    EXPECT_LT(at_sheet(false), 0.99f);
}

Medium large_smooth_fire(float extinction) {
    Recipe r;
    r.box = cube(-24, 24);
    r.world_from_index = cubic(0.075);
    r.density = [](const ivec3& n) { return std::max(0.0f, 1.0f - glm::dot(vec3(n), vec3(n)) / 400.0f); };
    r.flame = r.density;
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = Rgb(0.7f);
    r.settings.fire.convention = EmissionConvention::Direct;
    return make_medium(r);
}

// From thin to dense, whatever the first light alone would be content with. Drafts allow sqrt(0.02 * 0.05).
TEST(LightingLevel, NoLatticeIsWiderThanLightOfTheSmokeAllows) {
    bool wider = false;
    for (float extinction = 0.5f; extinction < 64.0f; extinction *= 1.3f) {
        LightingSettings draft;
        draft.error = 0.05f;
        const LightingLevels levels = lighting_levels(large_smooth_fire(extinction), draft);
        wider = wider || levels.first.level > 0;
        if (levels.smoke.level > 0) {
            EXPECT_LE(levels.smoke.error, 0.0317f) << "extinction " << extinction;
        }
        EXPECT_LE(float(levels.first.level) + levels.first.share_of_coarser,
                  float(levels.smoke.level) + levels.smoke.share_of_coarser);
    }
    EXPECT_TRUE(wider);
}

// Voxels of optical depth 0.15 add less than shadow maps may. Both pictures are of lighting.error=0.02.
TEST(LightingLevel, SmoothFireInThinSmokeNeedsNoFineLattice) {
    const Medium medium = smooth_fire(1.0f);
    const RenderedFrame fine = picture_on(medium, 0);
    const RenderedFrame coarse = picture_on(medium, 1);
    for (const char* layer : {"MV", "MM"})
        EXPECT_LT(layer_difference(coarse.image, fine.image, layer), 2.0 * 0.02) << layer;
}

// A lamp in smoke lights its own voxel most, which no wider voxel may take for even. One beside it changes nothing, and
// one that moves into thinning smoke changes the lattice step by step.
TEST(LightingLevel, ALampInSmokeNeedsFineVoxels) {
    const auto position_with = [](double extinction, double x) {
        Recipe r;
        r.box = cube(-16, 16);
        r.world_from_index = cubic(0.1);
        r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 14.0); };
        r.settings = media::black_smoke();
        r.settings.smoke.albedo = Rgb(0.7f);
        r.settings.smoke.extinction_per_metre = float(extinction);
        const Medium medium = make_medium(r);
        Scene scene;
        scene.origin = medium.world_of_local(vec3(0.0f));
        LightSettings lamp;
        lamp.position = scene.origin + dvec3(x, 0.0, 0.0);
        const Surroundings set(std::move(scene), {lamp});
        const LightingLevels levels = lighting_levels(medium, {}, &set);
        return glm::dvec2(levels.first.level + double(levels.first.share_of_coarser),
                          levels.smoke.level + double(levels.smoke.share_of_coarser));
    };
    EXPECT_EQ(position_with(2.0, 0.3), glm::dvec2(0.0));
    EXPECT_GT(position_with(2.0, 3.0).y, 0.5);
    double before = position_with(0.2, 0.3).y;
    EXPECT_GT(before, 0.5);
    for (double extinction = 0.2; extinction < 2.0; extinction *= 1.05) {
        const double now = position_with(extinction, 0.3).y;
        EXPECT_LT(std::abs(now - before), 0.35) << extinction;
        before = now;
    }
}

// A fire of 18 voxels across: voxels twice as wide would change MV by 2 %.
TEST(LightingLevel, SmallFiresAndStatedInterpolationKeepTheirLattice) {
    LightingSettings settings;
    EXPECT_EQ(lighting_levels(smooth_fire(0.01f), settings).first.level, 0);
    settings.interpolation = 0.5f;
    EXPECT_EQ(lighting_levels(smooth_fire(0.01f), settings).first.level, 0);
    EXPECT_EQ(lighting_levels(smooth_fire(0.01f), settings).smoke.level, 0);
    settings.lattice_level = 3;
    EXPECT_EQ(lighting_levels(smooth_fire(0.01f), settings).first.level, 3);
    EXPECT_EQ(lighting_levels(smooth_fire(0.01f), settings).smoke.level, 3);
}

void expect_same(const LightingLevels& levels, const LightingLevels& wanted, const char* what) {
    const auto number = [](const LightingLevel& level) { return float(level.level) + level.share_of_coarser; };
    EXPECT_NEAR(number(levels.first), number(wanted.first), 1e-3f) << what;
    EXPECT_NEAR(number(levels.smoke), number(wanted.smoke), 1e-3f) << what;
    EXPECT_NEAR(levels.interpolation, wanted.interpolation, 1e-5f) << what;
}

// Eight times as much of the same smoke, from a quarter of a million voxels to two million.
TEST(LightingLevel, HowManyVoxelsThereAreDoesNotMatter) {
    const auto levels = [](int nodes, float extinction) {
        Recipe r;
        r.box = cube(0, nodes - 1);
        r.world_from_index = cubic(0.05);
        r.density = [](const ivec3&) { return 1.0f; };
        r.settings.smoke.extinction_per_metre = extinction;
        r.settings.smoke.albedo = Rgb(0.5f);
        return lighting_levels(make_medium(r), {});
    };
    EXPECT_EQ(levels(64, 2.0f).first.level, 1);
    EXPECT_GT(levels(64, 2.0f).interpolation, 0.0f);
    EXPECT_EQ(levels(64, 30.0f).interpolation, 0.0f);
    for (const float extinction : {2.0f, 6.0f, 9.0f, 30.0f})
        expect_same(levels(128, extinction), levels(64, extinction), "more of it");
}

// Voxels that hold nothing, or smoke that nobody can see.
TEST(LightingLevel, PaddingDoesNotMatter) {
    const auto levels = [](int border, float around) {
        Recipe r;
        r.box = cube(-26 - border, 26 + border);
        r.world_from_index = cubic(0.05);
        r.density = [=](const ivec3& n) { return std::max(around, ball(n, dvec3(0.0), 25.0)); };
        r.flame = [](const ivec3& n) {
            const float d = glm::length(vec3(n)) / 24.0f;
            return d < 1.0f ? 1.0f - d * d : 0.0f;
        };
        r.settings.smoke.extinction_per_metre = 5.0f;
        r.settings.smoke.albedo = Rgb(0.5f);
        r.settings.fire.convention = EmissionConvention::Direct;
        return lighting_levels(make_medium(r), {});
    };
    const LightingLevels wanted = levels(0, 0.0f);
    expect_same(levels(25, 0.0f), wanted, "nothing around");
    expect_same(levels(25, 1e-7f), wanted, "invisible smoke around");
}

// A wave of eight coarse voxels: the means alone have lost a thirteenth of it.
TEST(LightingLevel, LightKnowsTheContrastOfTheExtinction) {
    Recipe r;
    r.box = cube(-32, 31);
    r.world_from_index = cubic(0.1);
    const auto wave = [](const ivec3& n) { return std::sin(2.0f * 3.14159265f * float(n.x) / 16.0f); };
    r.density = [=](const ivec3& n) { return 2.0f + wave(n); };
    r.settings.smoke.extinction_per_metre = 1.0f;
    const Medium fine = make_medium(r);
    const auto amplitude = [&](const Medium& coarse) {
        const CoarseSampler sampler{coarse.lattice, 1};
        double product = 0.0, square = 0.0;
        for (std::size_t i = 0; i < fine.lattice.node_count(); ++i) {
            const ivec3 node = fine.lattice.node(i);
            if (glm::any(glm::lessThan(node, ivec3(-16))) || glm::any(glm::greaterThanEqual(node, ivec3(16))))
                continue;
            sampler.at(node, [&](std::size_t j, float w) { product += wave(node) * w * coarse.extinction[j]; });
            square += wave(node) * wave(node);
        }
        return product / square;
    };
    const Medium means = coarse_medium(fine, 1), sharp = medium_to_light(fine, 1);
    EXPECT_LT(amplitude(means), 0.95);
    EXPECT_NEAR(amplitude(sharp), 1.0, 0.02);
    double sum = 0.0, wanted = 0.0;
    for (std::size_t i = 0; i < means.extinction.size(); ++i) {
        EXPECT_GE(sharp.extinction[i], 0.0f);
        sum += sharp.extinction[i];
        wanted += means.extinction[i];
    }
    EXPECT_NEAR(sum / wanted, 1.0, 1e-5);
}

TEST(LightingLevel, LightOfTheSmokeIsNeverOnAFinerLatticeThanTheFires) {
    LightingSettings settings;
    settings.smoke_lattice_level = 2;
    EXPECT_EQ(lighting_levels(smooth_fire(0.01f), settings).smoke.level, 2);
    settings.lattice_level = 3;
    EXPECT_EQ(lighting_levels(smooth_fire(0.01f), settings).smoke.level, 3);
}

// The same smoke in voxels half as wide: its light has voxels of the same width in the world.
TEST(LightingLevel, VoxelsOfTheSmokesLightDoNotDependOnThoseOfTheVolume) {
    const auto width = [](int nodes, float extinction) {
        Recipe r;
        r.box = cube(-nodes, nodes);
        r.world_from_index = cubic(1.0 / nodes);
        r.density = [&](const ivec3& n) { return ball(n, dvec3(0.0), nodes - 1.0); };
        r.settings.smoke.extinction_per_metre = extinction;
        r.settings.smoke.albedo = Rgb(0.8f);
        return std::exp2(float(lighting_levels(make_medium(r), {}).smoke.level)) / float(nodes);
    };
    EXPECT_EQ(width(16, 6.0f), width(32, 6.0f));
    EXPECT_EQ(width(8, 3.0f), width(16, 3.0f));
    EXPECT_LT(width(32, 30.0f), width(32, 6.0f));
}

TEST(LightingLevel, LightOfTheSmokeOnAWiderLatticeIsNearlyTheSame) {
    const Medium medium = smooth_fire(4.0f);
    const auto picture = [&](int level) {
        Shot shot = small_view(24);
        shot.lighting.smoke_lattice_level = level;
        Progress silent;
        return render_medium(shot, medium, silent);
    };
    const RenderedFrame fine = picture(0), coarse = picture(1);
    EXPECT_EQ(layer_difference(coarse.image, fine.image, "MV"), 0.0);
    const double difference = layer_difference(coarse.image, fine.image, "MM");
    EXPECT_GT(difference, 0.0);
    EXPECT_LT(difference, 0.02);
}

// What is allowed of the fire's light is 1 % at an error of 2 %.
TEST(LightingLevel, FollowsTheOpticalDepthOfVoxelsWithoutJumps) {
    Recipe r;
    r.box = cube(-64, 64);
    r.world_from_index = cubic(0.02);
    r.density = [](const ivec3&) { return 1.0f; };
    LightingSettings settings;
    r.settings.smoke.extinction_per_metre = 1.0f;
    Medium medium = make_medium(r);
    float before = 1e9f, smoke_before = 1e9f;
    for (float extinction = 1.0f; extinction < 60.0f; extinction *= 1.03f) {
        for (float& e : medium.extinction)
            e = e > 0.0f ? extinction : 0.0f;
        const LightingLevels levels = lighting_levels(medium, settings);
        const auto number = [](const LightingLevel& level) { return float(level.level) + level.share_of_coarser; };
        const float at = number(levels.first), smoke = number(levels.smoke);
        EXPECT_LE(at, before);
        EXPECT_LE(smoke, smoke_before);
        EXPECT_LE(at, smoke);
        if (before < 100.0f) {
            EXPECT_LT(before - at, 0.35f) << extinction;
            EXPECT_LT(smoke_before - smoke, 0.35f) << extinction;
        }
        before = at;
        smoke_before = smoke;
    }
    EXPECT_EQ(before, 0.0f);
    EXPECT_EQ(smoke_before, 0.0f);
}

}  // namespace
}  // namespace brisance
