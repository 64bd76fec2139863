// Fluence of uniformly emitting balls: what arrives at a point from all directions, inside, on and outside.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kNodes = 32;  // to the radius
// A surface smeared with a variance of a quarter of a voxel: 3/4 / 32^2 of the volume.
constexpr double kBall = 1e-3;

// Looks around from r: `sample` gets a ray uniform over all directions, or over the cone that holds a ball of radius
// 1.06. The means are times the solid angle of either.
Estimate look_around(double r, int numbers,
                     const std::function<void(const Ray&, double position, Rng&, double*)>& sample) {
    const double most = r > 1.1 ? 1.0 - std::sqrt(1.0 - std::pow(1.06 / r, 2)) : 2.0;  // of 1 - cos
    const dvec3 out_there(0.6, -0.48, 0.64), x(0.8, 0.36, -0.48), y(0.0, 0.8, 0.6);
    Estimate e = estimate_to(kSharp, numbers, [&](const dvec3& u, Rng& rng, double* out) {
        const dvec3 d = uniform_direction(0.5 * most * u.y, u.z);
        sample({r * out_there, -(d.z * out_there + d.x * x + d.y * y)}, u.x, rng, out);
    });
    for (int k = 0; k < numbers; ++k) {
        e.mean[k] *= 2.0 * kPi64 * most;
        e.error[k] *= 2.0 * kPi64 * most;
    }
    return e;
}

Traced unscattered(const Recipe& recipe) {
    return Traced(recipe, {}, 0);
}

// j = R = 1, no extinction: 2 pi + pi (1 - r^2) / r ln |(1 + r) / (1 - r)|.
TEST(TracedFluenceOfBalls, WithoutExtinctionMatchesTheClosedForm) {
    Rows rows("fluence, transparent ball");
    Recipe r = glowing_ball(kNodes, 1.0f);
    r.flame = r.density;
    r.density = nullptr;
    r.settings.fire.convention = EmissionConvention::Direct;
    const Traced traced = unscattered(r);
    constexpr double table[][2] = {{0.0, 12.566371}, {0.25, 12.301208}, {0.5, 11.460274}, {0.75, 9.849252},
                                   {0.9, 8.236011},  {1.0, 6.283185},   {1.25, 3.176932}, {1.5, 2.069687},
                                   {2.0, 1.106097},  {4.0, 0.265163},   {10.0, 0.041972}};
    for (const auto& row : table) {
        const Estimate e = look_around(row[0], 1, [&](const Ray& ray, double position, Rng& rng, double* out) {
            double seen[3];
            traced.look(ray, position, rng, seen);
            out[0] = seen[0];
        });
        rows.expect("r = " + std::to_string(row[0]), e.mean[0], e.error[0], row[1], kBall * row[1]);
    }
}

constexpr struct {
    double radius;
    double fluence[6];  // at 0, 0.25, 0.5, 0.75, 0.9, 1 of the radius
} kAbsorbing[] = {{0.1, {1.19585, 1.17064, 1.09047, 0.93590, 0.77975, 0.58845}},
                  {0.5, {4.94448, 4.84356, 4.51819, 3.87148, 3.19092, 2.31147}},
                  {1.0, {7.94346, 7.79574, 7.30850, 6.29151, 5.15282, 3.56679}},
                  {2.0, {10.86570, 10.71848, 10.20095, 8.97095, 7.36963, 4.74122}},
                  {5.0, {12.48170, 12.44680, 12.27751, 11.56789, 9.97660, 5.65506}}};

// sigma = j = 1: the ball of radius one metre and extinction R has source function 1, and the same fluence as the ball
// of radius R has in units of j. With source function 1 everywhere, the truth of the lattice's own ball follows from
// optical depths; on the surface, half way down the ramp, it differs from the table by up to 2 % for each mean free
// path of R.
TEST(TracedFluenceOfBalls, WithAbsorptionMatchesTheTable) {
    Rows rows("fluence, absorbing ball");
    constexpr double at[] = {0.0, 0.25, 0.5, 0.75, 0.9, 1.0};
    for (const auto& ball : kAbsorbing) {
        const Traced traced = unscattered(glowing_ball(kNodes, static_cast<float>(ball.radius)));
        for (int k = 0; k < 6; ++k) {
            const Estimate e = look_around(at[k], 2, [&](const Ray& ray, double position, Rng& rng, double* out) {
                double seen[3];
                traced.look(ray, position, rng, seen);
                out[1] = -std::expm1(-optical_depth(traced.tracer.field(), ray, 1e9));
                out[0] = seen[0] - out[1] + 1.0;  // paired: the spread over directions cancels
            });
            const std::string row = "R = " + std::to_string(ball.radius) + ", r = " + std::to_string(at[k]);
            rows.expect(row, e.mean[0] - 4.0 * kPi64 + e.mean[1], e.error[0], e.mean[1], 1e-6 * e.mean[1]);
            EXPECT_NEAR(e.mean[1] / ball.fluence[k], 1.0,
                        kBall + kSigmas * e.error[1] / ball.fluence[k] + (k == 5 ? 0.02 * ball.radius : 0.0))
                << row;
        }
    }
}

}  // namespace
}  // namespace brisance
