// Rays through smoke that emits and absorbs and does not scatter, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// The ball's lattice: 32 nodes to the radius. Its surface is a ramp of about two voxels: chords through the middle keep
// their length, but the limb of a thick ball grows opaque outside its radius, by half a percent and 0.2 % for every
// unit of optical depth. What the lattice's ball should look like is known exactly from its optical depths, because its
// source function is 1 everywhere: that is what rays are compared with, and the table is met as closely as the lattice
// allows.
constexpr int kBallNodes = 32;
constexpr double kChord = 5e-4, kLimb = 5e-3, kLimbPerDepth = 2e-3;

std::string depth_of(double depth) {
    return "optical depth " + std::to_string(depth);
}

struct Row {
    double depth;
    double slab, centre, emissivity, escape;  // escape: of a photon emitted in the ball of that optical radius
};

constexpr Row kRows[] = {
    {0.01, 0.0099502, 0.0198013, 0.0132339, 0.9925398}, {0.1, 0.0951626, 0.1812692, 0.1238452, 0.9288389},
    {0.5, 0.3934693, 0.6321206, 0.4715178, 0.7072766},  {1.0, 0.6321206, 0.8646647, 0.7030029, 0.5272522},
    {2.0, 0.8646647, 0.9816844, 0.8864473, 0.3324177},  {5.0, 0.9932621, 0.9999546, 0.9800100, 0.1470015},
    {10.0, 0.9999546, 1.0000000, 0.9950000, 0.0746250},
};
constexpr double kDigits = 5.1e-8;  // of the table
constexpr double kRounding = 1e-6;  // of single precision

TEST(EmittingLines, SlabsRadiateOneMinusTransmittance) {
    Rows rows("emitting slabs");
    for (const Row& row : kRows)
        for (const int nodes : {1, 6, 30}) {
            const Traced traced(slab(nodes, row.depth, Rgb(0.0f)));
            const Estimate e = estimate_to(kSharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
                traced.look(ray_into_layers(1.0), u.x, rng, out);
            });
            rows.expect(depth_of(row.depth), e.mean[0], e.error[0], row.slab, kDigits + kRounding * row.slab);
        }
}

TEST(EmittingLines, ALayerBehindALayerIsSeenThroughIt) {
    Rows rows("two layers");
    for (const double first : {0.1, 1.0, 3.0})
        for (const double second : {0.2, 2.0, 50.0}) {
            const auto density = [=](int z) { return float(z <= 4 ? first / 4 : z > 8 ? second / 6 : 0.0); };
            Recipe r = layers(14, density, [](int z) { return z <= 6 ? 3.0f : 0.5f; });
            const Traced traced(r);
            const Estimate e = estimate_to(kSharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
                traced.look(ray_into_layers(0.7), u.x, rng, out);
            });
            const double truth =
                -3.0 * std::expm1(-first / 0.7) - 0.5 * std::exp(-first / 0.7) * std::expm1(-second / 0.7);
            rows.expect(depth_of(first) + ", " + depth_of(second), e.mean[0], e.error[0], truth, kRounding * truth);
        }
}

// What rays see of a black ball, and what the same rays' optical depths say they should.
Estimate ball_and_truth(const Traced& traced, const std::function<Ray(const dvec3&, Rng&)>& ray_at) {
    return estimate_to(kSharp, 2, [&](const dvec3& u, Rng& rng, double* out) {
        const Ray ray = ray_at(u, rng);
        double seen[3];
        traced.look(ray, u.x, rng, seen);
        out[1] = -std::expm1(-optical_depth(traced.tracer.field(), ray, 1e9));
        out[0] = seen[0] - out[1] + 1.0;  // paired: the spread over the rays cancels
    });
}

// `lattice`: how far the lattice's ball may be from the table's, relative.
void expect_ball(Rows& rows, const std::string& row, const Estimate& e, double scale, double truth, double lattice) {
    const double own = scale * e.mean[1];
    rows.expect(row, own + scale * (e.mean[0] - 1.0), scale * e.error[0], own, kRounding * own);
    EXPECT_NEAR(own / truth, 1.0, lattice + kSigmas * scale * e.error[1] / truth) << row;
}

TEST(EmittingLines, BallsRadiateAsTheirChordsAndSurfacesSay) {
    Rows rows("emitting balls");
    for (const Row& row : kRows) {
        const Traced traced(scattering_ball(kBallNodes, row.depth, Rgb(0.0f)));
        const double limb = kLimb + kLimbPerDepth * row.depth;
        const Estimate centre =
            ball_and_truth(traced, [](const dvec3& u, Rng&) { return ray_through_middle(u.y, u.z); });
        expect_ball(rows, "centre, " + depth_of(row.depth), centre, 1.0, row.centre, kChord);
        constexpr double wider = 1.06;
        const Estimate flux =
            ball_and_truth(traced, [](const dvec3& u, Rng& rng) { return ray_through_disc(wider, u.y, u.z, rng); });
        expect_ball(rows, "flux, " + depth_of(row.depth), flux, wider * wider, row.emissivity, limb);
        // What leaves, over what is emitted: the one from rays, the other from nodes.
        const double leaving = 4.0 * kPi64 * kPi64 * wider * wider / emitted_power(*traced.medium).x;
        expect_ball(rows, "escape, " + depth_of(row.depth), flux, leaving, row.escape, limb);
    }
}

// From the middle of a ball all directions look the same.
TEST(EmittingLines, TheMiddleOfABallSeesOneRadius) {
    Rows rows("from the middle");
    for (const Row& row : kRows) {
        const Traced traced(scattering_ball(kBallNodes, row.depth, Rgb(0.0f)));
        const Estimate e = ball_and_truth(traced, [](const dvec3& u, Rng&) {
            return Ray{dvec3(0.0), uniform_direction(u.y, u.z)};
        });
        expect_ball(rows, depth_of(row.depth), e, 1.0, row.slab, kChord);
    }
}

// j = 1 whatever the density: (1 - exp(-tau)) / sigma, from transparent voxels to opaque ones.
TEST(EmittingLines, AFlameInSmokeIsDimmedByIt) {
    Rows rows("flame in smoke");
    for (const double voxel : {1e-6, 1e-2, 0.3, 3.0, 1e2, 1e4}) {
        const auto one = [](int) { return 1.0f; };
        Recipe r = layers(30, one, [](int z) { return z > 0 && z <= 30 ? 1.0f : 0.0f; });
        r.settings.smoke.extinction_per_metre = static_cast<float>(voxel);
        r.settings.fire.convention = EmissionConvention::Direct;
        const Traced traced(r);
        const Estimate e = estimate_to(kSharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
            traced.look(ray_into_layers(0.8), u.x, rng, out);
        });
        const double truth = -std::expm1(-30.0 * voxel / 0.8) / voxel;
        rows.expect(depth_of(voxel) + " of a voxel", e.mean[0], e.error[0], truth, kRounding * truth);
    }
}

// The same ramp of j and sigma would hide which is which: the flame ends where the smoke is thickest.
TEST(EmittingLines, AFlameBehindSmokeIsSeenThroughIt) {
    Rows rows("flame behind smoke");
    for (const double depth : {0.5, 5.0, 15.0, 18.0}) {
        const double sharp = depth > 16.0 ? 0.01 : kSharp;  // beyond 16 by Russian roulette
        const auto density = [=](int z) { return float(z <= 20 ? depth / 20 : 0.0); };
        Recipe r = layers(24, density, [](int z) { return z == 23 ? 1.0f : 0.0f; });
        r.settings.fire.convention = EmissionConvention::Direct;
        const Traced traced(r);
        const Estimate e = estimate_to(sharp, 1, [&](const dvec3& u, Rng& rng, double* out) {
            double seen[3];
            traced.look(ray_into_layers(1.0), u.x, rng, seen);
            out[0] = seen[0];
        });
        rows.expect(depth_of(depth), e.mean[0], e.error[0], std::exp(-depth), 2e-6 * std::exp(-depth), sharp);
    }
}

}  // namespace
}  // namespace brisance
