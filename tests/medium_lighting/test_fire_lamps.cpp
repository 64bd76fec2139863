// A fire as a few lamps, the baseline: never the light of the whole fire, but closer to it the more lamps there are.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/parallel.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "gathering/gather.h"
#include "layer_difference.h"
#include "lighting_grid/light_clusters.h"
#include "render/render_frame.h"
#include "small_view.h"

namespace brisance {
namespace {

using namespace testing;

// Ragged smoke of 32 nodes across, in which three balls of fire burn.
Medium three_fires(float extinction, float mean_cosine = 0.0f) {
    Recipe r;
    r.box = cube(-16, 16);
    r.world_from_index = cubic(0.075);
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 15.0) * (0.4f + noise(n >> 2, 1)); };
    r.flame = [](const ivec3& n) {
        return (ball(n, dvec3(5.0, -4.0, 0.0), 5.0) + ball(n, dvec3(-7.0, 2.0, 4.0), 4.0) +
                ball(n, dvec3(0.0, 0.0, -8.0), 3.0)) *
               noise(n >> 1, 2);
    };
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = Rgb(0.7f);
    r.settings.smoke.mean_cosine = mean_cosine;
    r.settings.fire.convention = EmissionConvention::Direct;
    return make_medium(r);
}

Shot lamp_shot(int lamps) {
    Shot shot = small_view(24);
    shot.lighting.clusters = lamps;
    return shot;
}

// For what V and MV say; they do not depend on how often light is scattered after that.
Shot scattered_once(Shot shot) {
    shot.scattering.bounces = 1;
    return shot;
}

double layer_sum(const Image& image, const char* layer) {
    double sum = 0.0;
    for (const float v : image.layer(layer).pixels)
        sum += v;
    return sum;
}

Image lamp_picture(const Medium& medium, const Shot& shot, const Surroundings* surroundings = nullptr) {
    Progress silent;
    return render_medium(shot, medium, silent, surroundings).image;
}

// One lamp in the place of a ball of even fire, and the closed form of that ball's light: the mean of 1 / r^2.
TEST(FireLamps, LightAsTheBallThatTheyStandFor) {
    Recipe r;
    r.box = cube(-30, 30);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 8.0); };
    r.flame = r.density;
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = 1e-6f;
    r.settings.fire.convention = EmissionConvention::Direct;
    const testing::Lit lit(make_medium(r));
    LightingGrid grid;
    grid.levels.push_back(cluster_lights(lit.medium, lit.intensity, 1));
    const double a = grid.levels[0].ball[0].radius, power = total(lit.intensity).x;
    EXPECT_NEAR(a, 0.8, 0.04);
    const std::vector<float> no_weight(lit.medium.lattice.node_count(), 0.0f);
    LightField field{&lit.pyramid, nullptr, nullptr, &grid, &no_weight, 2.0f, {}};
    field.settings.shadows = ShadowMethod::None;
    field.bottom = grid.levels[0].level;
    const std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 1);
    std::vector<LevelCost> costs;
    Progress silent;
    const Gathered g = gather_at_nodes(field, {&needed, std::nullopt, false, 0.0f}, costs, silent);
    for (std::size_t i = 0; i < needed.size(); ++i) {
        const vec3 to_lamp = lit.medium.local_of_node(lit.medium.lattice.node(i)) - grid.levels[0].position[0];
        const double t = glm::length(to_lamp) / a;
        if (t < 0.02 || std::abs(t - 1.0) < 1e-3)
            continue;
        const double mean = 0.75 / (a * a) * (2.0 + (1.0 - t * t) / t * std::log(std::abs((1.0 + t) / (1.0 - t))));
        ASSERT_NEAR(g.fluence[i] / (power * mean), 1.0, 3e-3) << t << " radii";
    }
}

TEST(FireLamps, ComeCloserToTheFireTheMoreThereAre) {
    const Medium medium = three_fires(3.0f);
    const Image fire = lamp_picture(medium, scattered_once(lamp_shot(0)));
    double first = 0.0, before = 1e30;
    for (const int lamps : {1, 4, 16, 64, 256, 1024}) {
        const Image lit = lamp_picture(medium, scattered_once(lamp_shot(lamps)));
        const double error = layer_difference(lit, fire, "MV");
        std::printf("%4d lamps: MV %.4f (mean %+.4f)\n", lamps, error,
                    layer_sum(lit, "MV") / layer_sum(fire, "MV") - 1.0);
        EXPECT_EQ(lit.layer("V").pixels, fire.layer("V").pixels) << "the fire itself is seen as it is";
        EXPECT_LT(error, 1.05 * before) << lamps;
        first = lamps == 1 ? error : first;
        before = error;
    }
    EXPECT_LT(before, 0.15 * first);
    EXPECT_LT(before, 0.05);
}

// With a lamp for every voxel both are the same sum, up to how a voxel lights itself and its neighbours.
TEST(FireLamps, AreTheFireWhereEveryVoxelHasItsOwn) {
    const Medium medium = three_fires(3.0f);
    Shot fire = scattered_once(lamp_shot(0));
    fire.lighting.shadows = ShadowMethod::Exact;
    fire.lighting.alpha = 8.0f;
    const Image lit_by_fire = lamp_picture(medium, fire);
    for (const ShadowMethod shadows : {ShadowMethod::Exact, ShadowMethod::Maps}) {
        Shot lamps = scattered_once(lamp_shot(65536));
        lamps.lighting.shadows = shadows;
        const double error = layer_difference(lamp_picture(medium, lamps), lit_by_fire, "MV");
        std::printf("a lamp for every voxel, %s: MV %.4f\n", shadows == ShadowMethod::Exact ? "exact" : "maps", error);
        EXPECT_LT(error, 0.03);
    }
}

// The lamps' own light in smoke is scaled to what rays from the fire's voxels collide with.
TEST(FireLamps, ConserveEnergy) {
    Progress silent;
    for (const StageCost& stage : render_medium(lamp_shot(8), three_fires(6.0f), silent).statistics.stages)
        if (stage.detail.contains("balance"))
            for (const auto& row : stage.detail["balance"]) {
                // Without the balance the lamps themselves come near it.
                EXPECT_NEAR(row["scale"].get<double>(), 1.0, 0.3) << stage.name;
                EXPECT_NEAR(row["sum"].get<double>(), 1.0, 0.01 + 4.0 * row["escape_standard_error"].get<double>())
                    << stage.name;
            }
}

TEST(FireLamps, LightSurfacesAndComeCloserThere) {
    const Medium medium = three_fires(1.0f);
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    add_quad(scene, {-4, -4, -1.6f}, {8, 0, 0}, {0, 8, 0}, lambert(0.8f));
    const Surroundings surroundings(scene, {});
    const auto floor = [&](int lamps) {
        Shot shot = lamp_shot(lamps);
        shot.camera.eye = {0.0, -6.0, 1.5};
        shot.camera.target = {0.0, 0.0, -1.0};
        shot.virtual_lights.count = 200;
        shot.virtual_lights.photons = 20000;
        return lamp_picture(medium, shot, &surroundings);
    };
    const Image fire = floor(0), few = floor(1), many = floor(128);
    const double far = layer_difference(few, fire, "SV"), near = layer_difference(many, fire, "SV");
    std::printf("SV: 1 lamp %.4f, 128 lamps %.4f, sums %+.4f %+.4f\n", far, near,
                layer_sum(few, "SV") / layer_sum(fire, "SV") - 1.0,
                layer_sum(many, "SV") / layer_sum(fire, "SV") - 1.0);
    EXPECT_LT(near, 0.5 * far);
    EXPECT_LT(near, 0.05);
    EXPECT_NEAR(layer_sum(many, "SV") / layer_sum(fire, "SV"), 1.0, 0.03);
}

TEST(FireLamps, AreTheSameOnAnyNumberOfThreads) {
    const Medium medium = three_fires(3.0f, 0.3f);
    const auto pixels = [&](int threads) {
        const ThreadLimit limit(threads);
        return lamp_picture(medium, lamp_shot(10)).layer("").pixels;
    };
    const std::vector<float> one = pixels(1);
    EXPECT_EQ(one, pixels(2));
    EXPECT_EQ(one, pixels(8));
}

}  // namespace
}  // namespace brisance
