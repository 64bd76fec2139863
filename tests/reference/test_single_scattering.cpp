// One order of scattering in closed form: smoke lit from behind by a thin flame.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// Exponential integral, x > 0.
double e1(double x) {
    if (x < 1.0) {
        double sum = -0.57721566490153286 - std::log(x), term = 1.0;
        for (int k = 1; k < 30; ++k)
            sum -= (term *= -x / k) / k;
        return sum;
    }
    double fraction = 0.0;  // continued fraction from its tail
    for (int k = 80; k > 0; --k)
        fraction = k / (1.0 + k / (x + fraction));
    return std::exp(-x) / (x + fraction);
}

// Smoke of optical depth `depth` and albedo 1/2 before a flame that shines 1 straight ahead, 1 / mu aslant. Returns
// what is seen of it from the smoke's side along the normal, unscattered and scattered once.
Estimate light_through_smoke(double depth, const TracingSettings& settings, double sharp) {
    const auto density = [=](int z) { return float(z <= 24 ? depth / 24 : 0.0); };
    Recipe r = layers(27, density, [](int z) { return z == 27 ? 1.0f : 0.0f; });
    r.settings.fire.convention = EmissionConvention::Direct;
    r.settings.smoke.albedo = Rgb(0.5f);
    const Traced traced(r, settings, 1);
    return estimate_to(sharp, 2, [&](const dvec3& u, Rng& rng, double* out) {
        PathSum sum{};
        PathStatistics statistics;
        traced.tracer.trace(ray_into_layers(1.0), u.x, rng, sum, statistics);
        out[0] = sum[0].x, out[1] = sum[1].x;
    });
}

// At depth x before the flame smoke receives 2 pi E1(x); integrating exp(-(T - x)) E1(x) albedo / 2 over the smoke
// gives albedo / 2 e^-T (ln T + gamma + e^T E1(T)). Every depth adds alike, however little of it the camera sees: the
// hardest there is to sample.
TEST(SingleScattering, OfAFlameBehindSmokeIsClosed) {
    Rows rows("flame behind smoke, scattered once");
    for (const double depth : {0.5, 1.0, 2.0, 3.0}) {
        const double truth =
            0.25 * std::exp(-depth) * (std::log(depth) + 0.57721566490153286 + std::exp(depth) * e1(depth));
        const double sharp = depth < 2.0 ? kSharp : 0.005;
        const Estimate e = light_through_smoke(depth, {}, sharp);
        const std::string row = "depth " + std::to_string(depth);
        rows.expect(row + ", unscattered", e.mean[0], e.error[0], std::exp(-depth), 1e-6, sharp);
        rows.expect(row + ", scattered", e.mean[1], e.error[1], truth, 1e-6 * truth, sharp);
    }
}

}  // namespace
}  // namespace brisance
