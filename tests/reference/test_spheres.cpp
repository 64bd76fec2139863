// An isothermal ball that emits, absorbs and scatters isotropically: the closed problem nearest to a fireball. With
// f = x S(x) and optical radius R, f(x) = (1 - a) x + a / 2 integral over [-R, R] of E1|x - y| f(y) dy.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// The ball's surface is a ramp of two voxels, 40 to the radius, so that the limb of a thick ball is opaque outside its
// radius. `lattice` is what that does, in percent: the same equation solved for the lattice ball's mean radial profile.
// It leaves out that the ramp is not the same all around; for a black ball optical depths along rays say what that is
// worth: 0.02 % to 0.06 %.
constexpr int kNodes = 40;
constexpr double kUneven = 6e-4;

struct Fireball {
    double radius, albedo;
    double flux, centre;  // over those of a black body
    double flux_lattice, centre_lattice;
};

constexpr Fireball kFireballs[] = {
    {0.5, 0.2, 0.40039, 0.54229, 0.08, -0.01},  {0.5, 0.5, 0.27583, 0.37982, 0.06, -0.02},
    {0.5, 0.8, 0.12302, 0.17250, 0.04, -0.03},  {0.5, 0.9, 0.06398, 0.09029, 0.04, -0.03},
    {0.5, 0.95, 0.03265, 0.04622, 0.03, -0.03}, {0.5, 0.99, 0.00664, 0.00943, 0.03, -0.03},
    {1.0, 0.2, 0.61940, 0.77479, 0.15, -0.01},  {1.0, 0.5, 0.45774, 0.58950, 0.11, -0.02},
    {1.0, 0.8, 0.22504, 0.30013, 0.07, -0.04},  {1.0, 0.9, 0.12199, 0.16488, 0.05, -0.05},
    {1.0, 0.95, 0.06370, 0.08669, 0.04, -0.05}, {1.0, 0.99, 0.01321, 0.01808, 0.03, -0.06},
    {2.0, 0.2, 0.81091, 0.91708, 0.32, -0.01},  {2.0, 0.5, 0.65108, 0.76677, 0.23, -0.04},
    {2.0, 0.8, 0.37160, 0.46372, 0.13, -0.08},  {2.0, 0.9, 0.21838, 0.27951, 0.09, -0.09},
    {2.0, 0.95, 0.11996, 0.15573, 0.06, -0.11}, {2.0, 0.99, 0.02608, 0.03428, 0.04, -0.12},
    {5.0, 0.2, 0.92168, 0.95631, 0.85, -0.04},  {5.0, 0.5, 0.79481, 0.85490, 0.64, -0.10},
    {5.0, 0.8, 0.54684, 0.62872, 0.37, -0.19},  {5.0, 0.9, 0.37652, 0.45061, 0.24, -0.24},
    {5.0, 0.95, 0.23745, 0.29220, 0.16, -0.28}, {5.0, 0.99, 0.06146, 0.07782, 0.07, -0.32},
};

// Three rows at once, in the three channels.
void expect_ball(Rows& rows, const Fireball* three) {
    const double radius = three[0].radius;
    const Traced traced(
        scattering_ball(kNodes, radius, Rgb(float(three[0].albedo), float(three[1].albedo), float(three[2].albedo))));
    const Estimate centre = estimate_to(kSharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
        traced.look(ray_through_middle(u.y, u.z), u.x, rng, out);
    });
    constexpr double wider = 1.05, area = wider * wider;
    const Estimate flux = estimate_to(kSharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
        traced.look(ray_through_disc(wider, u.y, u.z, rng), u.x, rng, out);
    });
    for (int c = 0; c < 3; ++c) {
        const Fireball& f = three[c];
        const std::string row = "R " + std::to_string(radius) + " albedo " + std::to_string(f.albedo);
        const double table = radius == 5.0 && f.albedo <= 0.5 ? 1e-4 : 3e-5;
        const double centre_truth = f.centre * (1.0 + 0.01 * f.centre_lattice);
        rows.expect(row + " centre", centre.mean[c], centre.error[c], centre_truth, kUneven * centre_truth + table);
        const double flux_truth = f.flux * (1.0 + 0.01 * f.flux_lattice);
        rows.expect(row + " flux", area * flux.mean[c], area * flux.error[c], flux_truth, kUneven * flux_truth + table);
    }
}

TEST(ModelFireballs, AreAsBrightAsTheIntegralEquationSays) {
    Rows rows("isothermal scattering balls");
    // Every radius and every albedo: dark smoke at radii 0.5 and 2, bright smoke at 1 and 5.
    for (const std::size_t i : {0, 9, 12, 21})
        expect_ball(rows, &kFireballs[i]);
}

}  // namespace
}  // namespace brisance
