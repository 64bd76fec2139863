// An isothermal ball that emits, absorbs and scatters: the closed problem nearest to a fireball, solved here through
// all orders of scattering. Values of the centre pixel from the integral equation
//   f(x) = (1 - a) x + a/2 integral over [-R, R] of E1|x - y| f(y) dy,  f = x S(x).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "camera_rays/integrate.h"
#include "core/parallel.h"
#include "fixtures/media.h"
#include "render/many_lights.h"

namespace brisance {
namespace {

using testing::glowing_ball;
using testing::make_medium;
using testing::Recipe;

constexpr int kNodes = 10, kNodesOfThickBalls = 14;  // to the ball's radius

struct Lit {
    Shot shot;
    Medium medium;
    Plan plan;
    Statistics statistics;
    NodeLighting nodes;
    double centre = 0.0;
};

// The ball's lighting and the radiance of the ray through its middle.
Lit light_ball(float optical_radius, float albedo, float g = 0.0f, int nodes = kNodes) {
    Lit lit;
    Recipe r = glowing_ball(nodes, optical_radius);
    r.settings.smoke.albedo = Rgb(albedo);
    r.settings.smoke.mean_cosine = g;
    lit.medium = make_medium(r);
    lit.plan = plan_cells(lit.shot, lit.medium);
    CameraSettings eye;
    eye.eye = dvec3(0.0, -40.0, 0.0);
    eye.target = dvec3(0.0);
    const Camera camera(eye, lit.medium);
    Progress silent;
    const DrawInput input{lit.shot, lit.plan, lit.medium, nullptr, camera};
    const MediumLighting lighting(medium_lighting_input(input, lit.plan, lit.medium), lit.statistics, silent);
    lit.nodes = lighting.at_nodes();
    const SourceField field(lit.medium, lit.nodes);
    const RaySum sum = integrate(field, camera.ray(0.5 * eye.width, 0.5 * eye.height), 2);
    lit.centre = sum.cells.at(Cell::V).x + sum.cells.at(Cell::MV).x + sum.cells.at(Cell::MM).x;
    return lit;
}

struct Row {
    float radius, albedo;
    double centre;
};

TEST(ModelFireball, IsAsBrightAsTheIntegralEquationSays) {
    for (const Row& row :
         {Row{0.5f, 0.5f, 0.37982}, Row{0.5f, 0.95f, 0.04622}, Row{1.0f, 0.5f, 0.58950}, Row{1.0f, 0.9f, 0.16488},
          Row{2.0f, 0.8f, 0.46372}, Row{2.0f, 0.9f, 0.27951}, Row{2.0f, 0.99f, 0.03428}, Row{5.0f, 0.5f, 0.85490},
          Row{5.0f, 0.95f, 0.29220}, Row{5.0f, 0.99f, 0.07782}}) {
        const int nodes = row.radius > 2.0f ? kNodesOfThickBalls : kNodes;
        const double centre = light_ball(row.radius, row.albedo, 0.0f, nodes).centre;
        std::printf("radius %.1f, albedo %.2f: %+.2f %%\n", row.radius, row.albedo,
                    100.0 * (centre / row.centre - 1.0));
        EXPECT_NEAR(centre / row.centre, 1.0, 0.03) << "radius " << row.radius << ", albedo " << row.albedo;
    }
}

// The fire's light, all orders on the coarse lattice together, and the last flight: rays with no part in the balance
// find that what is emitted collides or escapes. Four standard errors, seeds are fixed. Light of the fire on
// the next coarser lattice, as far as it counts, has a row of its own, and so has the fine bounce.
TEST(ModelFireball, WhatIsEmittedCollidesOrEscapes) {
    const Lit lit = light_ball(2.0f, 0.9f);
    int rows = 0, expected = 3;
    for (const StageCost& stage : lit.statistics.stages) {
        if (stage.name == "lattice of the light")
            expected += stage.detail["share_of_coarser_level"].get<double>() > 0.0;
        if (stage.detail.contains("share_of_fine_bounces"))
            expected += stage.detail["share_of_fine_bounces"].get<double>() > 0.0;
        if (stage.detail.contains("balance"))
            for (const auto& b : stage.detail["balance"]) {
                const double error = b["escape_standard_error"].get<double>();
                EXPECT_GT(error, 0.0);
                EXPECT_LE(error, 0.001) << "not sampled enough";
                EXPECT_NEAR(b["sum"].get<double>(), 1.0, 0.003 + 4.0 * error) << b;
                // What had to be corrected is the gather's own error: percents, not factors.
                EXPECT_NEAR(b["scale"].get<double>(), 1.0, 0.06);
                ++rows;
            }
    }
    EXPECT_EQ(rows, expected);
}

TEST(ModelFireball, AWeaklyForwardPhaseFunctionIsNearlyIsotropic) {
    const double isotropic = light_ball(1.0f, 0.8f).centre;
    const double forward = light_ball(1.0f, 0.8f, 1e-3f).centre;
    EXPECT_NEAR(forward / isotropic, 1.0, 0.01);
}

TEST(ModelFireball, ForwardScatteringHidesLessOfTheMiddle) {
    // Similarity: for the escaping light, g > 0 acts as less scattering; the ball shines brighter.
    EXPECT_GT(light_ball(2.0f, 0.9f, 0.7f).centre, 1.05 * light_ball(2.0f, 0.9f).centre);
}

TEST(ModelFireball, DoesNotKnowHowManyThreadsThereAre) {
    std::vector<NodeLighting> found;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        found.push_back(light_ball(2.0f, 0.8f, 0.3f, 8).nodes);
    }
    for (std::size_t k = 1; k < found.size(); ++k) {
        EXPECT_TRUE(found[k].single == found[0].single);
        EXPECT_TRUE(found[k].multiple == found[0].multiple);
    }
}

TEST(ModelFireball, AskingForNScatteringsLeavesOutTheRest) {
    double previous = 0.0;
    const double all = light_ball(2.0f, 0.9f).centre;
    for (const int bounces : {0, 1, 2, 3, 6}) {
        Recipe r = glowing_ball(kNodes, 2.0f);
        r.settings.smoke.albedo = Rgb(0.9f);
        const Medium medium = make_medium(r);
        Shot shot;
        shot.scattering.bounces = bounces;
        const Plan plan = plan_cells(shot, medium);
        EXPECT_EQ(plan.single, bounces > 0);
        EXPECT_EQ(plan.multiple, bounces > 1);
        CameraSettings eye;
        eye.eye = dvec3(0.0, -40.0, 0.0);
        eye.target = dvec3(0.0);
        const Camera camera(eye, medium);
        Progress silent;
        Statistics statistics;
        NodeLighting nodes;
        if (plan.single)
            nodes = MediumLighting(medium_lighting_input({shot, plan, medium, nullptr, camera}, plan, medium),
                                   statistics, silent)
                        .at_nodes();
        const SourceField field(medium, nodes);
        const RaySum sum = integrate(field, camera.ray(0.5 * eye.width, 0.5 * eye.height), 2);
        const double now = sum.cells.at(Cell::V).x + sum.cells.at(Cell::MV).x + sum.cells.at(Cell::MM).x;
        EXPECT_GT(now, previous);
        EXPECT_LT(now, all);
        previous = now;
    }
    EXPECT_GT(previous, 0.8 * all);
}

}  // namespace
}  // namespace brisance
