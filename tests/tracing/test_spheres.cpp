// An isothermal ball that emits, absorbs and scatters isotropically: the closed problem nearest to a fireball. With
// f = x S(x) and optical radius R, f(x) = (1 - a) x + a / 2 integral over [-R, R] of E1|x - y| f(y) dy.
#include <gtest/gtest.h>

#include <cmath>

#include "tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// 40 nodes to the radius: the surface is smeared with a variance of a quarter of a voxel, 3/4 / 40^2 = 0.05 % of the
// volume. The table itself is good to 3e-5, with radius 5 to 1e-4.
constexpr int kNodes = 40;
constexpr double kBall = 1e-3;

struct Fireball {
    double radius, albedo;
    double flux, centre;  // over those of a black body
};

constexpr Fireball kFireballs[] = {
    {0.5, 0.2, 0.40039, 0.54229},  {0.5, 0.5, 0.27583, 0.37982}, {0.5, 0.8, 0.12302, 0.17250},
    {0.5, 0.9, 0.06398, 0.09029},  {0.5, 0.95, 0.03265, 0.04622}, {0.5, 0.99, 0.00664, 0.00943},
    {1.0, 0.2, 0.61940, 0.77479},  {1.0, 0.5, 0.45774, 0.58950}, {1.0, 0.8, 0.22504, 0.30013},
    {1.0, 0.9, 0.12199, 0.16488},  {1.0, 0.95, 0.06370, 0.08669}, {1.0, 0.99, 0.01321, 0.01808},
    {2.0, 0.2, 0.81091, 0.91708},  {2.0, 0.5, 0.65108, 0.76677}, {2.0, 0.8, 0.37160, 0.46372},
    {2.0, 0.9, 0.21838, 0.27951},  {2.0, 0.95, 0.11996, 0.15573}, {2.0, 0.99, 0.02608, 0.03428},
    {5.0, 0.2, 0.92168, 0.95631},  {5.0, 0.5, 0.79481, 0.85490}, {5.0, 0.8, 0.54684, 0.62872},
    {5.0, 0.9, 0.37652, 0.45061},  {5.0, 0.95, 0.23745, 0.29220}, {5.0, 0.99, 0.06146, 0.07782},
};

// Three rows at once, in the three channels.
void expect_ball(Rows& rows, const Fireball* three) {
    const double radius = three[0].radius;
    const Traced traced(
        scattering_ball(kNodes, radius, Rgb(float(three[0].albedo), float(three[1].albedo), float(three[2].albedo))));
    const Estimate centre = estimate_to(kSharp, 3, 1, [&](const dvec3& place, Rng& rng, double* out) {
        traced.look(ray_through_middle(place.y, place.z), place.x, rng, out);
    });
    constexpr double wider = 1.05;
    const Estimate flux = estimate_to(kSharp, 3, 2, [&](const dvec3& place, Rng& rng, double* out) {
        traced.look(ray_through_disc(wider, place.y, place.z, rng), place.x, rng, out);
    });
    for (int c = 0; c < 3; ++c) {
        const Fireball& truth = three[c];
        const std::string row = "R " + std::to_string(radius) + " albedo " + std::to_string(truth.albedo);
        const double table = radius == 5.0 && truth.albedo <= 0.5 ? 1e-4 : 3e-5;
        rows.expect(row + " centre", centre.mean[c], centre.error[c], truth.centre, kBall * truth.centre + table);
        rows.expect(row + " flux", wider * wider * flux.mean[c], wider * wider * flux.error[c], truth.flux,
                    kBall * truth.flux + table);
    }
}

TEST(ModelFireballs, AreAsBrightAsTheIntegralEquationSays) {
    Rows rows("isothermal scattering balls");
    for (std::size_t i = 0; i < std::size(kFireballs); i += 3)
        expect_ball(rows, &kFireballs[i]);
}

}  // namespace
}  // namespace brisance
