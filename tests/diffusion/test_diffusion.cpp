// The diffusion equation of light against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "diffusion/diffusion.h"
#include "fixtures/plane_occluder.h"
#include "fixtures/tracing_fixture.h"
#include "medium/sh.h"

namespace brisance {
namespace {

using namespace testing;

DiffusionSettings classical() {
    DiffusionSettings settings;
    settings.flux_limiter = false;
    return settings;
}

// A cube of even smoke, nodes 0.25 m apart.
Recipe even_cube(float extinction, float albedo, float mean_cosine, int half = 32) {
    Recipe r;
    r.box = cube(-half, half - 1);
    r.world_from_index = cubic(0.25);
    r.density = [=](const ivec3&) { return extinction; };
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    r.settings.smoke.albedo = Rgb(albedo);
    r.settings.smoke.mean_cosine = mean_cosine;
    return r;
}

// Power 4 pi at the middle node.
std::vector<Rgb> point_light(const Lit& lit) {
    std::vector<Rgb> light(lit.medium.extinction.size(), Rgb(0.0f));
    light[lit.medium.lattice.find_node({0, 0, 0})] = Rgb(1.0f);
    return light;
}

class PointSource : public ::testing::TestWithParam<float> {};

// exp(-mu r) / (4 pi D r) around a source of power 1, mu = sqrt(sigma_a / D).
TEST_P(PointSource, FallsOffAsTheGreensFunction) {
    const float g = GetParam(), albedo = 0.9f;
    const Lit lit(make_medium(even_cube(1.0f, albedo, g)));
    Diffusion diffusion(lit.pyramid, classical());
    const Gathered light = diffusion.solve(point_light(lit), {});
    EXPECT_TRUE(diffusion.counts().converged);
    const double d = 1.0 / (3.0 * (1.0 - g * albedo)), mu = std::sqrt((1.0 - albedo) / d);
    double worst = 0.0;
    for (int n = 5; n <= 14; ++n)
        for (const ivec3& at : {ivec3(n, 0, 0), ivec3(n, n, 0), ivec3(n, n, n)}) {
            const double r = 0.25 * glm::length(dvec3(at));
            if (r > 3.5)
                continue;
            const double truth = std::exp(-mu * r) / (d * r);
            worst = std::max(worst, std::abs(light.fluence[lit.medium.lattice.find_node(at)] / truth - 1.0));
        }
    std::printf("g %g: largest error %.4f, %d iterations\n", g, worst, diffusion.counts().iterations);
    EXPECT_LT(worst, 0.03);
}

INSTANTIATE_TEST_SUITE_P(MeanCosines, PointSource, ::testing::Values(0.0f, 0.5f));

// A layer that emits evenly: phi = Q / sigma_a (1 - B cosh(mu z)) with phi / 2 leaving at its faces, in the middle of
// a layer that is much wider than thick.
TEST(Diffusion, OfALayerIsTheClosedForm) {
    constexpr int kNodes = 46;
    for (const double depth : {1.0, 6.0, 24.0})
        for (const double albedo : {0.5, 0.9, 0.99}) {
            Recipe r;
            r.box = {ivec3(0), ivec3(7, 7, kNodes + 1)};
            r.world_from_index = transform(dmat3(1000, 0, 0, 0, 1000, 0, 0, 0, 1), dvec3(0.0));
            r.density = [](const ivec3& n) { return n.z >= 1 && n.z <= kNodes ? 1.0f : 0.0f; };
            r.settings = black_smoke();
            r.settings.smoke.albedo = Rgb(float(albedo));
            r.settings.smoke.extinction_per_metre = float(depth / kNodes);
            const Lit lit(make_medium(r));
            const std::vector<Rgb> even =
                project_extinction_times(lit.medium, std::vector<Rgb>(lit.medium.extinction.size(), Rgb(1.0f)));
            // Voxels as flat as these are what coarser cells represent worst.
            DiffusionSettings settings = classical();
            settings.most_iterations = 5000;
            Diffusion diffusion(lit.pyramid, settings);
            const Gathered light = diffusion.solve(even, {});
            EXPECT_TRUE(diffusion.counts().converged);
            EXPECT_LT(diffusion.counts().unbalanced, 1e-4);
            const double mu = std::sqrt(3.0 * (1.0 - albedo)), half = 0.5 * depth;  // lengths in mean free paths
            const double b = 1.0 / (std::cosh(mu * half) + 2.0 / 3.0 * mu * std::sinh(mu * half));
            double worst = 0.0;
            for (int z = 3; z <= kNodes - 2; ++z) {
                const double at = (z - 0.5 * (kNodes + 1)) * depth / kNodes;
                const double truth = 4.0 * kPi64 / (1.0 - albedo) * (1.0 - b * std::cosh(mu * at));
                worst = std::max(worst, std::abs(light.fluence[lit.medium.lattice.find_node({4, 4, z})] / truth - 1.0));
            }
            std::printf("depth %g albedo %g: largest error %.4f, %d iterations\n", depth, albedo, worst,
                        diffusion.counts().iterations);
            EXPECT_LT(worst, 0.02);
        }
}

// Light that leaves a source with mean cosine c is absorbed c / sigma_t' further on, on average.
TEST(Diffusion, OfADirectedSourceIsShifted) {
    const float g = 0.5f, albedo = 0.5f;
    const Lit lit(make_medium(even_cube(2.0f, albedo, g, 24)));
    std::vector<float> directional(lit.medium.extinction.size() * 24, 0.0f);
    std::vector<Rgb> source(lit.medium.extinction.size());
    const double cosine = 0.3;
    for (std::size_t i = 0; i < source.size(); ++i) {
        source[i] = Rgb(ball(lit.medium.lattice.node(i), dvec3(0.0), 3.0));
        for (int c = 0; c < 3; ++c)
            directional[i * 24 + 3 * 2 + c] = float(3.0 * cosine / kSh1) * source[i][c];  // 1 + 3 c w_x
    }
    for (const bool limit : {false, true}) {
        DiffusionSettings settings;
        settings.flux_limiter = limit;
        Diffusion diffusion(lit.pyramid, settings);
        const Gathered light = diffusion.solve(source, directional);
        dvec3 moment(0.0);
        double sum = 0.0;
        for (std::size_t i = 0; i < lit.medium.extinction.size(); ++i) {
            moment += double(light.fluence[i]) * 0.25 * dvec3(lit.medium.lattice.node(i));
            sum += light.fluence[i];
        }
        const double truth = cosine / (2.0 * (1.0 - g * albedo));
        std::printf("%s: shift %.4f m, closed form %.4f\n", limit ? "limited" : "classical", moment.x / sum, truth);
        if (!limit) {
            EXPECT_NEAR(moment.x / sum / truth, 1.0, 0.02);
        }
        EXPECT_GT(moment.x, 0.0);
        EXPECT_NEAR(moment.y / sum, 0.0, 1e-3);
        EXPECT_LT(diffusion.counts().unbalanced, 1e-4);
        // On the far side light travels on, on the near side it travels back.
        const std::size_t n = lit.medium.extinction.size();
        EXPECT_GT(light.moments[3 * 2 * n + lit.medium.lattice.find_node({8, 0, 0})], 0.0f);
        EXPECT_LT(light.moments[3 * 2 * n + lit.medium.lattice.find_node({-8, 0, 0})], 0.0f);
    }
}

// Clumps, of which some are almost clear air, and three colours of albedo.
struct Clumps {
    Lit lit;
    std::vector<Rgb> source;
    explicit Clumps(float density = 20.0f, Rgb colours = Rgb(1.0f, 0.5f, 0.0f))
        : lit(make_medium([&] {
              Recipe r = glowing_ball(12, density);
              const auto even = r.density;
              r.density = [=](const ivec3& n) { return even(n) * (noise(n >> 2, 3) > 0.5f ? 1.7f : 1e-5f); };
              r.settings.smoke.albedo = Rgb(0.99f, 0.9f, 0.5f);
              return r;
          }())) {
        for (std::size_t i = 0; i < lit.medium.extinction.size(); ++i)
            source.push_back(colours * ball(lit.medium.lattice.node(i), dvec3(3.0, 2.0, 1.0), 3.0));
    }
};

TEST(Diffusion, ConservesEnergyColourByColour) {
    const Clumps clumps;
    for (const bool limit : {true, false}) {
        DiffusionSettings settings;
        settings.flux_limiter = limit;
        Diffusion diffusion(clumps.lit.pyramid, settings);
        const Gathered light = diffusion.solve(clumps.source, {});
        const DiffusionBalance& b = diffusion.balance();
        std::printf("%s: %d limiters, %d iterations, residual %.1e, change %.1e\n", limit ? "limited" : "classical",
                    diffusion.counts().limiters, diffusion.counts().iterations, diffusion.counts().residual,
                    diffusion.counts().change);
        EXPECT_TRUE(diffusion.counts().converged);
        for (int c = 0; c < 2; ++c)
            EXPECT_NEAR((b.absorbed[c] + b.escaped[c]) / b.emitted[c], 1.0, 1e-4) << "colour " << c;
        EXPECT_GT(b.absorbed.y / b.emitted.y, b.absorbed.x / b.emitted.x);
        EXPECT_EQ(b.emitted.z, 0.0);
        const std::size_t n = clumps.lit.medium.extinction.size();
        EXPECT_EQ(*std::max_element(light.fluence.begin() + 2 * n, light.fluence.end()), 0.0f);
        EXPECT_GE(*std::min_element(light.fluence.begin(), light.fluence.end()), 0.0f);
    }
}

// In almost clear air light flies: power / (4 pi r^2). Unlimited, it would fall off as 1 / (D r).
TEST(Diffusion, FluxLimitedLightFliesThroughClearAir) {
    const Lit lit(make_medium(even_cube(1e-6f, 0.5f, 0.0f, 24)));
    double errors[2];
    for (const bool limit : {false, true}) {
        DiffusionSettings settings;
        settings.flux_limiter = limit;
        Diffusion diffusion(lit.pyramid, settings);
        const Gathered light = diffusion.solve(point_light(lit), {});
        double& worst = errors[limit] = 0.0;
        for (int n = 4; n <= 20; n += 4) {
            const double r = 0.25 * n;
            const double ratio = light.fluence[lit.medium.lattice.find_node({n, 0, 0})] * r * r;
            std::printf("%s, r %g: %.3f of the inverse square\n", limit ? "limited" : "classical", r, ratio);
            worst = std::max(worst, std::abs(std::log(ratio)));
        }
    }
    EXPECT_LT(errors[1], std::log(1.5));
    EXPECT_GT(errors[0], std::log(2.0));
}

TEST(Diffusion, OfNoLightOrNoSmokeIsFinite) {
    for (const float density : {0.0f, 1e-12f, 1e-3f, 1e6f}) {
        const Clumps clumps(density == 0.0f ? 1e-30f : density);
        Diffusion diffusion(clumps.lit.pyramid, {});
        const Gathered light = diffusion.solve(clumps.source, {});
        for (const float f : light.fluence) {
            ASSERT_TRUE(std::isfinite(f)) << density;
            ASSERT_GE(f, 0.0f);
        }
        EXPECT_LT(diffusion.counts().unbalanced, 1e-3) << density;
    }
    const Clumps dark(20.0f, Rgb(0.0f));
    Diffusion diffusion(dark.lit.pyramid, {});
    for (const float f : diffusion.solve(dark.source, {}).fluence)
        ASSERT_EQ(f, 0.0f);
    EXPECT_EQ(diffusion.counts().iterations, 0);
    EXPECT_TRUE(diffusion.counts().converged);
}

TEST(Diffusion, SaysWhenItHasNotConverged) {
    const Clumps clumps;
    DiffusionSettings few;
    few.most_iterations = 1;
    few.most_limiters = 2;
    Diffusion diffusion(clumps.lit.pyramid, few);
    diffusion.solve(clumps.source, {});
    EXPECT_FALSE(diffusion.counts().converged);
    EXPECT_GT(diffusion.counts().residual, few.tolerance);
}

TEST(Diffusion, WallsStopLight) {
    Lit lit(make_medium(even_cube(1.0f, 0.9f, 0.0f, 16)));
    const PlaneOccluder wall = plane_across(0, -0.4f);
    lit.pyramid.set_occluders(&wall);
    Diffusion diffusion(lit.pyramid, {});
    const Gathered light = diffusion.solve(point_light(lit), {});
    float behind = 0.0f;
    for (std::size_t i = 0; i < lit.medium.extinction.size(); ++i)
        if (lit.medium.lattice.node(i).x < -1)
            behind = std::max(behind, light.fluence[i]);
    EXPECT_LT(behind, 1e-6f * light.fluence[lit.medium.lattice.find_node({0, 0, 0})]);
    EXPECT_LT(diffusion.counts().unbalanced, 1e-4);
    // What the wall swallows is missing on its bright side, too.
    const Lit open(make_medium(even_cube(1.0f, 0.9f, 0.0f, 16)));
    const Gathered without = Diffusion(open.pyramid, {}).solve(point_light(open), {});
    const std::size_t at = lit.medium.lattice.find_node({4, 0, 0});
    EXPECT_LT(light.fluence[at], without.fluence[at]);
}

TEST(Diffusion, ThreadsChangeNoBit) {
    const Clumps clumps;
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return Diffusion(clumps.lit.pyramid, {}).solve(clumps.source, {}).fluence;
    };
    EXPECT_EQ(with(1), with(5));
}

}  // namespace
}  // namespace brisance
