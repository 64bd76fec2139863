// Fluence around a small source in an infinite medium that scatters isotropically (Case and Zweifel's exact form).
//
// The source is one glowing node, a tent of two voxels' width, and the medium a box of 128 voxels of half a mean free
// path: light that would have come back from farther away than 30 mean free paths is missing, exp(-0.17 * 56) of it at
// albedo 0.99 and far less otherwise. That the source is no point is taken into account exactly: what is expected is
// the mean over the tent of the point's fluence.
#include <gtest/gtest.h>

#include <cmath>

#include "tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

constexpr double kSpacing = 0.5;  // mean free paths
constexpr int kHalf = 63;         // nodes from the source to the box's faces

// Gauss-Legendre, eight points, on [a, b].
template <class F>
double integral(double a, double b, const F& f) {
    constexpr double x[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    constexpr double w[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    double sum = 0.0;
    for (int i = 0; i < 4; ++i)
        sum += w[i] * (f(0.5 * (a + b) - 0.5 * (b - a) * x[i]) + f(0.5 * (a + b) + 0.5 * (b - a) * x[i]));
    return 0.5 * (b - a) * sum;
}

// Root of c atanh(k) = k.
double discrete_decay(double c) {
    double low = 1e-6, high = 1.0 - 1e-12;
    for (int i = 0; i < 200; ++i) {
        const double k = 0.5 * (low + high);
        (c * std::atanh(k) < k ? low : high) = k;
    }
    return low;
}

// Of unit power at distance r, without what comes straight, exp(-r) / (4 pi r^2).
double scattered_fluence(double c, double r) {
    const double k0 = discrete_decay(c);
    const double discrete =
        k0 * k0 * (1.0 - k0 * k0) * std::exp(-k0 * r) / (2.0 * kPi64 * r * c * (k0 * k0 + c - 1.0));
    // k = 1 / (1 - t) turns [1, infinity) into [0, 1); what comes straight is 1 in place of 1 / (...).
    const auto continuum = [&](double t) {
        const double k = 1.0 / (1.0 - t), a = 0.5 * std::log((k + 1.0) / (k - 1.0));
        const double bracket = std::pow(1.0 - c * a / k, 2) + std::pow(c * kPi64 / (2.0 * k), 2);
        return std::exp(-k * r) * (1.0 / bracket - 1.0) * k * k;
    };
    double sum = 0.0, begin = 0.0;
    for (double end = 1e-12; begin < 1.0; begin = end, end = std::min(1.0, end < 0.1 ? 2.0 * end : end + 0.02))
        sum += integral(begin, end, continuum);
    return discrete + sum / (4.0 * kPi64 * r);
}

double fluence(double c, double r) {
    return std::exp(-r) / (4.0 * kPi64 * r * r) + scattered_fluence(c, r);
}

struct PointSource {
    double albedo;
    double at[6];  // 0.25, 0.5, 1, 2, 4, 8 mean free paths
};

constexpr double kRadii[] = {0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
constexpr PointSource kPoints[] = {
    {0.2, {1.086507e+00, 2.256029e-01, 3.759504e-02, 3.924729e-03, 1.553577e-04, 8.542587e-07}},
    {0.5, {1.264881e+00, 2.947631e-01, 5.869514e-02, 7.927624e-03, 4.493863e-04, 4.076416e-06}},
    {0.8, {1.518878e+00, 4.145873e-01, 1.074126e-01, 2.206581e-02, 2.452642e-03, 6.970685e-05}},
    {0.9, {1.639311e+00, 4.828327e-01, 1.432839e-01, 3.712640e-02, 6.194053e-03, 3.751829e-04}},
    {0.95, {1.716441e+00, 5.320569e-01, 1.737110e-01, 5.331722e-02, 1.209057e-02, 1.319156e-03}},
    {0.99, {1.803145e+00, 5.953856e-01, 2.201946e-01, 8.497689e-02, 2.950600e-02, 7.386958e-03}},
};

TEST(PointSource, ExactFormIsThatOfTheTable) {
    for (const PointSource& row : kPoints)
        for (int i = 0; i < 6; ++i)
            EXPECT_NEAR(fluence(row.albedo, kRadii[i]) / row.at[i], 1.0, 2e-6) << row.albedo << ", " << kRadii[i];
}

// The mean of the point's fluence over the glowing node's tent, over the fluence of the point.
double tent_over_point(double c, const dvec3& receiver) {
    const double r = glm::length(receiver);
    const auto along = [&](const auto& f) {
        const auto weighted = [&](double s) { return (1.0 - std::abs(s)) * f(s * kSpacing); };
        return integral(-1.0, 0.0, weighted) + integral(0.0, 1.0, weighted);
    };
    const double mean = along([&](double x) {
        return along([&](double y) {
            return along([&](double z) { return fluence(c, glm::length(receiver - dvec3(x, y, z))); });
        });
    });
    return mean / fluence(c, r);
}

Recipe medium_around_a_point(int first) {
    Recipe r;
    r.box = cube(-kHalf, kHalf);
    r.world_from_index = cubic(kSpacing);
    r.density = [](const ivec3&) { return 1.0f; };
    r.flame = [](const ivec3& n) { return n == ivec3(0) ? 1.0f : 0.0f; };
    r.settings.fire.convention = EmissionConvention::Direct;
    for (int c = 0; c < 3; ++c)
        r.settings.smoke.albedo[c] = static_cast<float>(kPoints[first + c].albedo);
    return r;
}

// Half of the directions toward the source, from where it fills a cone, half to all other sides.
Estimate fluence_at(const Traced& traced, const dvec3& receiver, double sharp) {
    const double r = glm::length(receiver), cosine = std::sqrt(std::max(0.0, 1.0 - 0.75 / (r * r)));
    const dvec3 axis = -receiver / r, x = glm::normalize(glm::cross(axis, dvec3(0, 1, 0))), y = glm::cross(axis, x);
    const double toward = 0.5 * (1.0 - cosine);  // of all directions
    return estimate_to(sharp, 3, 1, [&](const dvec3& place, Rng& rng, double* out) {
        const bool near = place.y < 0.5;
        const double u = near ? 2.0 * place.y * toward : toward + (2.0 * place.y - 1.0) * (1.0 - toward);
        const dvec3 d = uniform_direction(u, place.z);
        traced.look({receiver, d.z * axis + d.x * x + d.y * y}, place.x, rng, out);
        for (int c = 0; c < 3; ++c)
            out[c] *= 8.0 * kPi64 * (near ? toward : 1.0 - toward);
    });
}

// Three albedos at once.
void expect_fluence(Rows& rows, int first, double sharp) {
    const Traced traced(medium_around_a_point(first));
    const double power = emitted_power(*traced.medium).x;
    for (const int i : {2, 3, 4}) {
        const dvec3 receiver = kRadii[i] * glm::normalize(dvec3(0.64, 0.36, -0.68));
        const Estimate e = fluence_at(traced, receiver, sharp);
        for (int c = 0; c < 3; ++c) {
            const PointSource& point = kPoints[first + c];
            const double truth = power * point.at[i] * tent_over_point(point.albedo, receiver);
            rows.expect("albedo " + std::to_string(point.albedo) + ", r " + std::to_string(kRadii[i]), e.mean[c],
                        e.error[c], truth, 1e-4 * truth, sharp);
        }
    }
}

TEST(PointSource, LightsAnInfiniteMediumAsCaseAndZweifelSay) {
    Rows rows("point source");
    expect_fluence(rows, 0, kSharp);
    expect_fluence(rows, 3, kSharp);
}

}  // namespace
}  // namespace brisance
