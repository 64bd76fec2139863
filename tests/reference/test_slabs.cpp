// Plane-parallel layers that emit, absorb and scatter: emissivities by adding and doubling, and Chandrasekhar's H.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

std::string name(const std::string& what, double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%s %g ", what.c_str(), value);
    return text;
}

// Of an isothermal slab that scatters isotropically: what a black body of its temperature would shine, seen along its
// normal and at 60 degrees to it. Kirchhoff: 1 - reflection - transmission.
struct Emissivity {
    double thickness;
    double at_1, at_half;
};

struct SlabTable {
    double albedo;
    Emissivity rows[8];
};

constexpr SlabTable kSlabs[] = {
    {0.2,
     {{0.1, 0.07869, 0.14990},
      {0.25, 0.18821, 0.33477},
      {0.5, 0.34539, 0.55476},
      {1.0, 0.57576, 0.78653},
      {2.0, 0.81489, 0.91976},
      {4.0, 0.94327, 0.94766},
      {8.0, 0.96435, 0.94913},
      {16.0, 0.96477, 0.94915}}},
    {0.5,
     {{0.1, 0.05180, 0.09867},
      {0.25, 0.13003, 0.23129},
      {0.5, 0.25282, 0.40595},
      {1.0, 0.45482, 0.61996},
      {2.0, 0.69785, 0.77935},
      {4.0, 0.85284, 0.83355},
      {8.0, 0.88395, 0.83974},
      {16.0, 0.88477, 0.83986}}},
    {0.8,
     {{0.1, 0.02189, 0.04169},
      {0.25, 0.05815, 0.10343},
      {0.5, 0.12208, 0.19595},
      {1.0, 0.24775, 0.33687},
      {2.0, 0.44811, 0.49369},
      {4.0, 0.64089, 0.59945},
      {8.0, 0.71010, 0.63014},
      {16.0, 0.71473, 0.63202}}},
    {0.9,
     {{0.1, 0.01115, 0.02124},
      {0.25, 0.03027, 0.05383},
      {0.5, 0.06558, 0.10524},
      {1.0, 0.14096, 0.19150},
      {2.0, 0.28185, 0.30882},
      {4.0, 0.46333, 0.42408},
      {8.0, 0.56914, 0.48341},
      {16.0, 0.58481, 0.49193}}},
    {0.95,
     {{0.1, 0.00563, 0.01072},
      {0.25, 0.01545, 0.02748},
      {0.5, 0.03406, 0.05465},
      {1.0, 0.07572, 0.10281},
      {2.0, 0.16197, 0.17695},
      {4.0, 0.30066, 0.27163},
      {8.0, 0.42481, 0.34936},
      {16.0, 0.46250, 0.37262}}},
    {0.99,
     {{0.1, 0.00113, 0.00216},
      {0.25, 0.00314, 0.00559},
      {0.5, 0.00703, 0.01128},
      {1.0, 0.01610, 0.02185},
      {2.0, 0.03681, 0.04012},
      {4.0, 0.07947, 0.07096},
      {8.0, 0.14918, 0.11844},
      {16.0, 0.21914, 0.16581}}},
    {0.999,
     {{0.1, 0.00011, 0.00022},
      {0.25, 0.00032, 0.00056},
      {0.5, 0.00071, 0.00114},
      {1.0, 0.00163, 0.00222},
      {2.0, 0.00380, 0.00414},
      {4.0, 0.00858, 0.00764},
      {8.0, 0.01822, 0.01433},
      {16.0, 0.03587, 0.02652}}},
};

// The digits printed, and as much again for the table's own convergence.
constexpr double kSlabDigits = 1e-5;

// Three rows of the table at once, in the three channels.
void expect_slabs(Rows& rows, const std::array<int, 3>& tables, double sharp, FreeFlight flight) {
    TracingSettings settings;
    settings.free_flight = flight;
    Rgb albedo;
    for (int c = 0; c < 3; ++c)
        albedo[c] = static_cast<float>(kSlabs[tables[c]].albedo);
    for (int i = 0; i < 8; ++i) {
        const double thickness = kSlabs[0].rows[i].thickness;
        const Traced traced(slab(1 + i % 6, thickness, albedo), settings);
        for (const double mu : {1.0, 0.5}) {
            const Ray ray = ray_into_layers(mu);
            const Estimate e =
                estimate_to(sharp, 3, [&](const dvec3& u, Rng& rng, double* out) { traced.look(ray, u.x, rng, out); });
            for (int c = 0; c < 3; ++c) {
                const Emissivity& truth = kSlabs[tables[c]].rows[i];
                rows.expect(name("albedo", albedo[c]) + name("thickness", thickness) + name("mu", mu), e.mean[c],
                            e.error[c], mu == 1.0 ? truth.at_1 : truth.at_half, kSlabDigits, sharp);
            }
        }
    }
}

TEST(Slabs, ShineByTheirEmissivity) {
    Rows rows("slabs");
    expect_slabs(rows, {0, 1, 2}, kSharp, FreeFlight::NullCollision);
}

TEST(Slabs, ShineByTheirEmissivityWithExactFlights) {
    Rows rows("slabs, exact flights");
    expect_slabs(rows, {0, 1, 2}, kSharp, FreeFlight::Exact);
}

TEST(Slabs, OfBrightSmokeShineByTheirEmissivity) {
    Rows rows("slabs, high albedo");
    expect_slabs(rows, {3, 4, 4}, kSharp, FreeFlight::NullCollision);
}

// Hundreds of scatterings to a path: sampled to half a percent.
TEST(Slabs, OfTheBrightestSmokeShineByTheirEmissivity) {
    Rows rows("slabs, highest albedo");
    expect_slabs(rows, {5, 5, 6}, 0.005, FreeFlight::NullCollision);
}

// Van de Hulst's slab, as quoted with MCML: reflection 0.097395, transmission 0.660958.
TEST(Slabs, ThatScatterForwardShineByTheirEmissivity) {
    Rows rows("slab, g = 0.75");
    Recipe r = slab(5, 2.0, Rgb(0.9f));
    r.settings.smoke.mean_cosine = 0.75f;
    const Traced traced(r);
    const Estimate e = estimate_to(
        kSharp, 3, [&](const dvec3& u, Rng& rng, double* out) { traced.look(ray_into_layers(1.0), u.x, rng, out); });
    rows.expect("albedo 0.9, thickness 2", e.mean[0], e.error[0], 1.0 - 0.097395 - 0.660958, 1e-6);
}

// Chandrasekhar's H: an isothermal half space shines by sqrt(1 - albedo) H(mu).
constexpr double kMu[] = {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};

struct HTable {
    double albedo;
    double h[11];
};

constexpr HTable kH[] = {
    {0.2, {1.01605, 1.02562, 1.03892, 1.04830, 1.05546, 1.06118, 1.06588, 1.06982, 1.07319, 1.07610, 1.07865}},
    {0.5, {1.04427, 1.07237, 1.11346, 1.14389, 1.16797, 1.18774, 1.20435, 1.21856, 1.23089, 1.24169, 1.25126}},
    {0.8, {1.08191, 1.13881, 1.22864, 1.30059, 1.36109, 1.41326, 1.45899, 1.49954, 1.53583, 1.56854, 1.59822}},
    {0.9, {1.09968, 1.17214, 1.29143, 1.39135, 1.47850, 1.55603, 1.62588, 1.68935, 1.74740, 1.80079, 1.85010}},
    {0.95, {1.11151, 1.19523, 1.33734, 1.46045, 1.57095, 1.67179, 1.76471, 1.85092, 1.93129, 2.00650, 2.07712}},
    {0.99, {1.12607, 1.22488, 1.39977, 1.55871, 1.70750, 1.84860, 1.98336, 2.11262, 2.23700, 2.35694, 2.47279}},
    {0.999, {1.13339, 1.24042, 1.43442, 1.61567, 1.78969, 1.95869, 2.12382, 2.28575, 2.44492, 2.60162, 2.75607}},
};

// `voxel` is the optical depth of one voxel; six of them are as good as endless.
void expect_half_space(Rows& rows, const std::array<int, 3>& tables, std::initializer_list<int> mus, double voxel,
                       double sharp) {
    Rgb albedo;
    for (int c = 0; c < 3; ++c)
        albedo[c] = static_cast<float>(kH[tables[c]].albedo);
    const Traced traced(slab(6, 6.0 * voxel, albedo));
    for (const int i : mus) {
        const Ray ray = ray_into_layers(kMu[i]);
        const Estimate e =
            estimate_to(sharp, 3, [&](const dvec3& u, Rng& rng, double* out) { traced.look(ray, u.x, rng, out); });
        for (int c = 0; c < 3; ++c) {
            const double cold = std::sqrt(1.0 - kH[tables[c]].albedo);
            rows.expect(name("albedo", albedo[c]) + name("mu", kMu[i]) + name("voxel", voxel), e.mean[c], e.error[c],
                        cold * kH[tables[c]].h[i], 1e-5 * cold, sharp);
        }
    }
}

TEST(HalfSpace, ShinesByChandrasekharsH) {
    Rows rows("half space");
    expect_half_space(rows, {0, 1, 2}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 6.0, kSharp);
}

TEST(HalfSpace, OfBrightSmokeShinesByChandrasekharsH) {
    Rows rows("half space, high albedo");
    expect_half_space(rows, {3, 4, 4}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 6.0, kSharp);
}

// A path's scatterings are many and very unequal: sampled to one percent.
TEST(HalfSpace, OfTheBrightestSmokeShinesByChandrasekharsH) {
    Rows rows("half space, highest albedo");
    expect_half_space(rows, {4, 4, 5}, {1, 5, 10}, 12.0, 0.005);
    expect_half_space(rows, {6, 6, 6}, {10}, 40.0, 0.02);
}

// All light comes from a skin far thinner than a voxel.
TEST(HalfSpace, OfStiffSmokeShinesTheSame) {
    Rows rows("half space, stiff voxels");
    for (const double voxel : {1e2, 1e4, 1e6})
        expect_half_space(rows, {0, 1, 2}, {1, 10}, voxel, kSharp);
}

}  // namespace
}  // namespace brisance
