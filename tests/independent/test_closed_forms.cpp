// The brute-force estimator itself, against closed forms.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "brute_force.h"
#include "fixtures/media.h"

namespace brisance::independent {
namespace {

using testing::Recipe;

constexpr double kPi = 3.14159265358979323846;
constexpr double kSigmas = 4.0;

void expect_mean(const Mean& mean, const dvec3& expected, double most_error, const char* what) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(mean.value[c], expected[c], kSigmas * mean.error[c] + 1e-6 * expected[c]) << what << " " << c;
        EXPECT_LE(mean.error[c], most_error * expected[c]) << what << " " << c << ": not sampled enough";
    }
}

// A ray is a view of no extent.
View along(const dvec3& origin, const dvec3& direction) {
    return {origin, origin + direction, dvec3(0.0), dvec3(0.0)};
}

// A cube of homogeneous smoke with density 1 at the nodes -n ... n, `spacing` metres apart.
Recipe cube_of_smoke(int n, double spacing, float extinction, const Rgb& albedo) {
    Recipe r;
    r.box = testing::cube(-n - 1, n + 1);
    r.world_from_index = testing::cubic(spacing);
    r.density = [=](const ivec3& i) {
        return std::max({std::abs(i.x), std::abs(i.y), std::abs(i.z)}) <= n ? 1.0f : 0.0f;
    };
    r.settings = testing::black_smoke();
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = albedo;
    return r;
}

// L = L_e (1 - exp(-tau)). The ramps to zero at either end hold half a node each: 2 n + 1 nodes in all.
TEST(BruteForce, AHotSlabOutshinesItsBackgroundByItsOpacity) {
    Recipe r = cube_of_smoke(4, 0.25, 0.8f, Rgb(0.0f));
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings.fire.colour = Rgb(1.0f, 0.5f, 0.25f);
    const World world{SmokeBox(testing::make_medium(r)), {}, {}};
    const double opacity = 1.0 - std::exp(-0.8 * 9.0 * 0.25);
    const Mean mean = measure(world, along({0.1, -0.2, -3.0}, {0.0, 0.0, 1.0}), 200'000, 1);
    expect_mean(mean, opacity * dvec3(1.0, 0.5, 0.25), 0.005, "slab");
}

// A lamp h above a floor seen through homogeneous absorbing smoke:
// L = rho / pi * I cos / d^2 * exp(-sigma (d + distance to the eye)).
TEST(BruteForce, ALampLightsAFloorThroughSmoke) {
    const double sigma = 0.3;
    World world{SmokeBox(testing::make_medium(cube_of_smoke(12, 0.5, float(sigma), Rgb(0.0f)))), {}, {}};
    world.quads.push_back({{-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, {0.2, 0.5, 0.8}, {0, 0, 0}});
    const dvec3 lamp(0.7, -0.4, 1.5), p(0.1, 0.2, 0.0), eye(0.1, 0.2, 1.0);
    world.lamps.push_back({lamp, {3.0, 3.0, 2.0}});
    const double d = glm::length(lamp - p);
    const double factor = 1.5 / (kPi * d * d * d) * std::exp(-sigma * (d + 1.0));
    const Mean mean = measure(world, along(eye, p - eye), 200'000, 2);
    expect_mean(mean, factor * dvec3(0.6, 1.5, 1.6), 0.005, "floor");

    // The same with a spot that is halfway between its two angles at p.
    const double off = 20.0 * kPi / 180.0;
    const dvec3 toward = (p - lamp) / d, aside = glm::normalize(glm::cross(toward, dvec3(1, 0, 0)));
    world.lamps[0].spot = true;
    world.lamps[0].axis = std::cos(off) * toward + std::sin(off) * aside;
    world.lamps[0].inner_degrees = 10.0;
    world.lamps[0].outer_degrees = 25.0;
    const double inner = std::cos(10.0 * kPi / 180.0), outer = std::cos(25.0 * kPi / 180.0);
    const double falloff = std::pow((std::cos(off) - outer) / (inner - outer), 2);
    expect_mean(measure(world, along(eye, p - eye), 200'000, 3), falloff * factor * dvec3(0.6, 1.5, 1.6), 0.005,
                "spot");
}

// Light of a point lamp that homogeneous smoke scatters once, by quadrature along the ray:
// L = integral of sigma_s p(cos) I exp(-sigma (t + d)) / d^2 dt.
TEST(BruteForce, SmokeScattersALampsLightOnce) {
    for (const double g : {0.0, 0.7, -0.4}) {
        Recipe r = cube_of_smoke(10, 0.5, 0.25f, Rgb(0.9f, 0.6f, 0.3f));
        r.settings.smoke.mean_cosine = float(g);
        World world{SmokeBox(testing::make_medium(r)), {}, {}};
        const dvec3 eye(-4.0, 0.3, 0.2), direction = glm::normalize(dvec3(1.0, 0.1, -0.05)), lamp(1.0, 1.5, 0.4);
        world.lamps.push_back({lamp, dvec3(2.0)});
        // A black screen ends the ray inside the smoke.
        const double end = 7.0;
        world.quads.push_back({eye + end * direction - dvec3(0, 2, 2), {0, 4, 0}, {0, 0, 4}});
        constexpr int kSteps = 20000;
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const double t = (i + 0.5) / kSteps * end;
            const dvec3 to = lamp - (eye + t * direction);
            const double d = glm::length(to), cosine = glm::dot(direction, to) / d;
            const double phase = (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
            sum += 0.25 * phase * 2.0 * std::exp(-0.25 * (t + d)) / (d * d) * end / kSteps;
        }
        const Mean mean = measure(world, along(eye, direction), 400'000, 4, 1);
        expect_mean(mean, sum * dvec3(double(0.9f), double(0.6f), double(0.3f)), 0.005, "lamp in smoke");
    }
}

// The sampled cosines have the mean g, and fill equal shares of the distribution equally.
TEST(BruteForce, ThePhaseFunctionIsSampledAsItIsEvaluated) {
    constexpr int kSamples = 200'000, kBins = 8;
    for (const double g : {0.0, 0.6, -0.8}) {
        Random random(5);
        const dvec3 direction = glm::normalize(dvec3(0.3, -0.8, 0.2));
        std::array<double, kBins> expected{}, found{};
        for (int i = 0; i < 100 * kBins; ++i) {
            const double cosine = (i + 0.5) / (50.0 * kBins) - 1.0;
            expected[i / 100] += 2.0 * kPi * phase_function(cosine, g) / (50.0 * kBins) * kSamples;
        }
        double mean = 0.0;
        for (int i = 0; i < kSamples; ++i) {
            const double cosine = glm::dot(direction, sample_phase_function(direction, g, random));
            mean += cosine / kSamples;
            found[std::min(kBins - 1, int((cosine + 1.0) / 2.0 * kBins))] += 1.0;
        }
        EXPECT_NEAR(mean, g, kSigmas * std::sqrt((1.0 - g * g) / 3.0 / kSamples));
        for (int b = 0; b < kBins; ++b)
            EXPECT_NEAR(found[b], expected[b], kSigmas * std::sqrt(expected[b]) + 1e-3 * expected[b]) << g << ": " << b;
    }
}

// In a closed box whose walls emit 1 - rho, with smoke whose source function is 1, everything has radiance 1.
TEST(BruteForce, ThermalEquilibriumHasOneRadiance) {
    Recipe r = cube_of_smoke(3, 0.25, 1.5f, Rgb(0.7f));
    // The outermost nodes are empty, so that the source function is 1 wherever there is smoke.
    r.density = [inside = r.density](const ivec3& n) { return inside(n) * testing::noise(n, 1); };
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings.smoke.mean_cosine = 0.5f;
    World world{SmokeBox(testing::make_medium(r)), {}, {}};
    const dvec3 rho(0.6), glow(0.4);
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            dvec3 corner(-1.2), u(0.0), v(0.0);
            corner[axis] = 1.2 * side;
            u[(axis + 1) % 3] = v[(axis + 2) % 3] = 2.4;
            if (side > 0.0)  // fronts look inward
                std::swap(u, v);
            world.quads.push_back({corner, u, v, rho, glow});
        }
    const Mean mean =
        measure(world, {{0.9, -1.0, 0.8}, {-1.0, 1.0, -1.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, 2.0}}, 100'000, 6);
    expect_mean(mean, dvec3(1.0), 0.005, "equilibrium");
}

}  // namespace
}  // namespace brisance::independent
