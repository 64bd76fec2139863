// What is emitted either collides or escapes.
#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"
#include "fixtures/media.h"
#include "lighting_grid/voxel_lights.h"
#include "scattering/balance.h"

namespace brisance {
namespace {

using testing::glowing_ball;
using testing::Lit;
using testing::make_medium;

struct Ball {
    float depth;    // optical radius
    double escape;  // exact, of light emitted uniformly
};

constexpr Ball kBalls[] = {{0.01f, 0.9925398}, {0.1f, 0.9288389}, {0.5f, 0.7072766},
                           {1.0f, 0.5272522},  {2.0f, 0.3324177}, {5.0f, 0.1470015}};

TEST(Balance, EscapeFromABallIsAsTabulated) {
    for (const Ball& b : kBalls) {
        const Lit lit(make_medium(glowing_ball(16, b.depth)));
        const CollisionEstimate e = estimate_collisions(lit.pyramid, lit.intensity, {}, 40000);
        EXPECT_EQ(e.rays, 40000u);
        // A voxel of haze round the ball lets more escape, the more a voxel absorbs: sigma h = depth / 16.
        EXPECT_NEAR((1.0 - e.fraction.x) / b.escape, 1.0, 0.004 + 0.012 * b.depth) << "optical radius " << b.depth;
        EXPECT_EQ(e.fraction.x, e.fraction.y);
    }
}

// The mean distance out of a ball is 3/4 of its radius; the estimate is as precise where hardly anything collides.
TEST(Balance, CollisionsInTheThinnestSmokeKeepTheirDigits) {
    for (const float depth : {1e-3f, 1e-6f, 1e-12f}) {
        const Lit lit(make_medium(glowing_ball(16, depth)));
        const CollisionEstimate e = estimate_collisions(lit.pyramid, lit.intensity, {}, 40000);
        EXPECT_NEAR(e.fraction.x / (0.75 * depth), 1.0, 0.02) << "optical radius " << depth;
        EXPECT_LT(e.standard_error, 0.01 * e.fraction.x);
    }
}

// Plain Monte Carlo of the interpolated fields themselves: source 1, so that emission is where extinction is.
TEST(Balance, EscapeIsThatOfTheFieldTheCameraSees) {
    for (const float depth : {1.0f, 5.0f}) {
        const Lit lit(make_medium(glowing_ball(16, depth)));
        Rng rng(Stream::EscapeRay, 99);
        double escaped = 0.0, emitted = 0.0;
        for (int i = 0; i < 40000; ++i) {
            const float x = rng.next(), y = rng.next(), z = rng.next(), u = rng.next(), v = rng.next();
            const vec3 from = 1.1f * (2.0f * vec3(x, y, z) - 1.0f);
            const float extinction = lit.pyramid.extinction_at(from);
            if (extinction <= 0.0f)
                continue;
            const float up = 1.0f - 2.0f * u, side = std::sqrt(1.0f - up * up), angle = 6.2831853f * v;
            const vec3 to = from + 2.4f * vec3(side * std::cos(angle), side * std::sin(angle), up);
            escaped += extinction * std::exp(-lit.pyramid.optical_depth(from, to));
            emitted += extinction;
        }
        const CollisionEstimate e = estimate_collisions(lit.pyramid, lit.intensity, {}, 40000);
        EXPECT_NEAR((1.0 - e.fraction.x) / (escaped / emitted), 1.0, 0.02) << "optical radius " << depth;
    }
}

// Two estimators; the second is far more precise for the little light that leaves opaque smoke.
TEST(Balance, WhatEscapesIsWhatDoesNotCollide) {
    for (const float depth : {0.5f, 5.0f, 50.0f}) {
        const Lit lit(make_medium(glowing_ball(16, depth)));
        std::vector<float> likelihood;
        for (std::size_t i = 0; i < lit.intensity.size(); ++i) {
            const ivec3 node = lit.medium.lattice.first_node(i / BrickLattice::kNodes) +
                               BrickLattice::node_in_brick(int(i % BrickLattice::kNodes));
            likelihood.push_back(std::exp(-depth * std::max(0.0f, 1.0f - glm::length(vec3(node)) / 16.0f)));
        }
        const CollisionEstimate inside = estimate_collisions(lit.pyramid, lit.intensity, {}, 200000);
        const EscapeEstimate e = estimate_escape(lit.pyramid, lit.intensity, {}, likelihood, 200000);
        const double share = e.power.x / total(lit.intensity).x, other = 1.0 - inside.fraction.x;
        EXPECT_NEAR(share / other, 1.0, 4.0 * (e.standard_error + inside.standard_error / other)) << depth;
        if (depth == 50.0f) {
            EXPECT_LT(e.standard_error, 0.5 * inside.standard_error / other);
        }
    }
}

TEST(Balance, EscapeFromTheTableIsThreeEpsilonOverFourTau) {
    for (const Ball& b : kBalls) {
        const double tau = b.depth;
        const double emissivity = 1.0 - (1.0 - (1.0 + 2.0 * tau) * std::exp(-2.0 * tau)) / (2.0 * tau * tau);
        EXPECT_NEAR(3.0 * emissivity / (4.0 * tau), b.escape, 1e-4);
    }
}

TEST(Balance, TheStandardErrorIsHonest) {
    const Lit lit(make_medium(glowing_ball(10, 1.0f)));
    const double truth = estimate_collisions(lit.pyramid, lit.intensity, {}, 400000).fraction.x;
    double square_error = 0.0, square_claim = 0.0;
    int runs = 0;
    for (std::size_t rays = 900; rays < 1300; rays += 7, ++runs) {
        const CollisionEstimate e = estimate_collisions(lit.pyramid, lit.intensity, {}, rays);
        square_error += (e.fraction.x - truth) * (e.fraction.x - truth);
        square_claim += e.standard_error * e.standard_error;
    }
    const double ratio = std::sqrt(square_error / square_claim);
    EXPECT_GT(ratio, 0.2) << "claims far more error than there is";
    EXPECT_LT(ratio, 2.0) << "claims less error than there is";
}

TEST(Balance, ColoursCollideTogetherInGreySmoke) {
    Lit lit(make_medium(glowing_ball(10, 2.0f)));
    for (Rgb& i : lit.intensity)
        i *= Rgb(1.0f, 0.3f, 0.0f);
    const CollisionEstimate e = estimate_collisions(lit.pyramid, lit.intensity, {}, 5000);
    EXPECT_NEAR(e.fraction.x, e.fraction.y, 1e-6);
    EXPECT_EQ(e.fraction.z, 0.0);
}

TEST(Balance, FromTheMiddleOfABallEscapesOneTransmittance) {
    for (const float depth : {0.1f, 1.0f, 4.0f}) {
        const Lit lit(make_medium(glowing_ball(16, depth)));
        for (const float p : collision_probabilities(lit.pyramid, std::vector<ivec3>(3, ivec3(0)), 0, 64))
            EXPECT_NEAR((1.0f - p) / std::exp(-depth), 1.0f, 0.02f);
    }
}

// 1/2 + (1 - exp(-2 tau)) / (4 tau) = 0.623 on the surface of a sharp ball; half a voxel of haze lies before it here.
TEST(Balance, FromTheSurfaceMoreThanHalfEscapes) {
    const Lit lit(make_medium(glowing_ball(16, 2.0f)));
    const std::vector<ivec3> surface = {{16, 0, 0}, {0, -16, 0}, {0, 0, 16}};
    for (const float p : collision_probabilities(lit.pyramid, surface, 0, 512)) {
        EXPECT_GT(1.0f - p, 0.54f);
        EXPECT_LT(1.0f - p, 0.63f);
    }
}

// The vertices' hats share all smoke between them: so do their escapes.
TEST(Balance, CoarseVerticesEscapeAsTheSmokeTheyStandForDoes) {
    const Lit lit(make_medium(glowing_ball(16, 2.0f)));
    const int level = 2, reach = 5;
    std::vector<ivec3> vertices;
    for (int x = -reach; x <= reach; ++x)
        for (int y = -reach; y <= reach; ++y)
            for (int z = -reach; z <= reach; ++z)
                vertices.emplace_back(x, y, z);
    const std::vector<float> probability = collision_probabilities(lit.pyramid, vertices, level, 256);
    double escaped = 0.0, all = 0.0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::int64_t n = lit.pyramid.lattice(level).find_node(vertices[i]);
        const double smoke = n < 0 ? 0.0 : lit.pyramid.nodes(level)[n];
        escaped += smoke * (1.0 - probability[i]);
        all += smoke;
    }
    EXPECT_NEAR(escaped / all / 0.3324177, 1.0, 0.02);
}

// Light that leaves between a node with smoke and one without is that of both.
TEST(Balance, FromANodeWithoutSmokeLightCollidesAsRaysFromItDo) {
    const Lit lit(make_medium(glowing_ball(16, 2.0f)));
    const ivec3 beside(0, 17, 0);
    const auto node = std::size_t(lit.medium.lattice.find_node(beside));
    ASSERT_EQ(lit.medium.extinction[node], 0.0f);
    std::vector<Rgb> intensity(lit.intensity.size(), Rgb(0.0f));
    intensity[node] = Rgb(1.0f);
    const CollisionEstimate by_rays = estimate_collisions(lit.pyramid, intensity, {}, 100000);
    const float by_table = collision_probabilities(lit.pyramid, {beside}, 0, 4096).front();
    EXPECT_GT(by_table, 0.2f);
    EXPECT_NEAR(by_table / by_rays.fraction.x, 1.0, 0.01);
}

TEST(Balance, CollisionsAreTheIntegralOfExtinctionTimesFluence) {
    const Lit lit(make_medium(glowing_ball(16, 3.0f)));
    const std::vector<Rgb> fluence(lit.medium.lattice.node_count(), Rgb(4.0f, 2.0f, 0.0f));
    const double pi = 3.14159265358979;
    const dvec3 sum = collided_power(lit.medium, fluence);
    EXPECT_NEAR(sum.x / (3.0 * 4.0 / 3.0 * pi * 4.0 / (4.0 * pi)), 1.0, 2e-3);
    EXPECT_NEAR(sum.y / sum.x, 0.5, 1e-5);
    EXPECT_EQ(sum.z, 0.0);
}

// Light toward x, from the ball's face on that side, meets hardly anything; toward -x it crosses the ball. Both ways of
// counting must see that, and agree: rays of the lights, and moments of the nodes.
TEST(Balance, DirectionalLightCollidesWhereItGoes) {
    const Lit lit(make_medium(glowing_ball(12, 1.5f)));
    const ivec3 face(12, 0, 0);
    const auto node = std::size_t(lit.medium.lattice.find_node(face));
    const std::vector<float> moments = collision_probabilities(lit.pyramid, {face}, 0, 4096, kCollisionMoments);
    for (const float sign : {1.0f, -1.0f}) {
        std::vector<Rgb> intensity(lit.intensity.size(), Rgb(0.0f));
        std::vector<float> directional(intensity.size() * 24, 0.0f);
        intensity[node] = Rgb(1.0f);
        const auto basis = sh_basis({sign, 0.0f, 0.0f});
        float by_moments = moments[0];
        for (int m = 0; m < 3; ++m) {
            const float coefficient = 0.8f * 4.0f / 3.0f * 3.14159265f * basis[m];  // 1 + 0.8 cos
            by_moments += coefficient * moments[1 + m];
            for (int c = 0; c < 3; ++c)
                directional[node * 24 + 3 * m + c] = coefficient;
        }
        const CollisionEstimate e = estimate_collisions(lit.pyramid, intensity, directional, 100000);
        EXPECT_NEAR(e.fraction.x / by_moments, 1.0, 0.01);
        const double isotropic = moments[0];
        EXPECT_LT(sign * (e.fraction.x / isotropic - 1.0), -0.2);
    }
}

TEST(Balance, WithoutLightsNothingCollides) {
    const Lit lit(make_medium(glowing_ball(10, 1.0f)));
    const std::vector<Rgb> dark(lit.intensity.size(), Rgb(0.0f));
    const CollisionEstimate e = estimate_collisions(lit.pyramid, dark, {}, 100);
    EXPECT_EQ(e.rays, 0u);
    EXPECT_EQ(e.fraction, dvec3(0.0));
}

// A part and the rest add up, and halves of a ball that are alike have a half each.
TEST(Balance, CollisionsAreCountedByParts) {
    const Lit lit(make_medium(glowing_ball(16, 2.0f)));
    const std::size_t nodes = lit.medium.extinction.size();
    std::vector<float> all(nodes, 1.0f), half(nodes), rest(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
        const int x = lit.medium.lattice.node(i).x;
        half[i] = x > 0 ? 1.0f : x == 0 ? 0.5f : 0.0f;
        rest[i] = 1.0f - half[i];
    }
    const auto of = [&](const std::vector<float>& part) {
        return estimate_collisions(lit.pyramid, lit.intensity, {}, 40000, part);
    };
    const PartlyCollided whole = of(all), right = of(half), left = of(rest);
    EXPECT_NEAR(whole.part.fraction.x / whole.all.fraction.x, 1.0, 1e-3);
    EXPECT_NEAR((right.part.fraction.x + left.part.fraction.x) / whole.all.fraction.x, 1.0, 1e-3);
    EXPECT_NEAR(right.part.fraction.x / whole.all.fraction.x, 0.5, 5.0 * right.part.standard_error);
    EXPECT_LT(right.part.standard_error, 0.01);
}

}  // namespace
}  // namespace brisance
