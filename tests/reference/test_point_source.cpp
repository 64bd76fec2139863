// Fluence around a point source in an infinite medium that scatters isotropically (Case and Zweifel's exact form).
//
// Light that went from a point to a point would have gone back the same way: a shell of sources around the receiver is
// as good as one source with a shell of receivers, and every ray meets it. What is expected is the integral over the
// lattice's own shell of the fluence of points, which varies with distance as the table says. The medium is a box of
// 127 voxels of half a mean free path, or a third: what would have come back from beyond its faces is missing.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kHalf = 63;          // nodes from the middle to the box's faces
constexpr double kMissing = 3e-4;  // at most: 6 exp(-0.17 * 47) * 8 / 55, for albedo 0.99 at a distance of 8

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
    const double discrete = k0 * k0 * (1.0 - k0 * k0) * std::exp(-k0 * r) / (2.0 * kPi64 * r * c * (k0 * k0 + c - 1.0));
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

// The point's fluence around a distance, tabulated: the logarithm is nearly straight.
class FluenceTable {
public:
    FluenceTable(double c, double begin, double end) : begin_(begin), step_((end - begin) / kSteps) {
        for (int i = 0; i <= kSteps + 1; ++i)
            log_.push_back(std::log(fluence(c, begin + i * step_)));
    }
    double operator()(double r) const {
        const double x = (r - begin_) / step_;
        const auto i = static_cast<std::size_t>(x);
        return std::exp(log_.at(i) + (x - i) * (log_.at(i + 1) - log_.at(i)));
    }

private:
    static constexpr int kSteps = 1000;
    double begin_, step_;
    std::vector<double> log_;
};

// Extinction 1, and a shell of glowing nodes about two voxels thick.
Recipe shell(double radius, double spacing) {
    Recipe r;
    r.box = cube(-kHalf, kHalf);
    r.world_from_index = cubic(spacing);
    r.density = [](const ivec3&) { return 1.0f; };
    r.flame = [=](const ivec3& n) {
        return static_cast<float>(std::max(0.0, 1.0 - std::abs(glm::length(dvec3(n)) - radius / spacing)));
    };
    r.settings.fire.convention = EmissionConvention::Direct;
    return r;
}

// The integral of 4 pi j(x) times the point's fluence at |x|: three Gauss points to an axis of every glowing cell.
double expected_fluence(const Traced& traced, double c, double radius, double spacing) {
    constexpr double x[] = {0.1127016653792583, 0.5, 0.8872983346207417}, w[] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    const FluenceTable table(c, std::max(0.05, radius - 3.0 * spacing), radius + 3.0 * spacing);
    const TrackingField& field = traced.tracer.field();
    double sum = 0.0;
    for (std::size_t b = 0; b < field.bricks().brick_count(); ++b)
        for (int n = 0; field.burns(b) && n < BrickLattice::kNodes; ++n)
            for (int k = 0; k < 27; ++k) {
                const dvec3 p = dvec3(BrickLattice::node_in_brick(n)) + dvec3(x[k / 9], x[k / 3 % 3], x[k % 3]);
                const float j = field.emission(b, vec3(p)).x;
                const double r = spacing * glm::length(dvec3(field.bricks().first_node(b)) + p);
                if (j > 0.0f)
                    sum += w[k / 9] * w[k / 3 % 3] * w[k % 3] * j * table(r);
            }
    return 4.0 * kPi64 * sum * std::pow(spacing, 3);
}

// Three albedos at once, seen from the middle of a shell.
void expect_fluence(Rows& rows, int first, int distance) {
    const double radius = kRadii[distance], spacing = radius > 1.0 ? 0.5 : 1.0 / 3.0;
    Recipe r = shell(radius, spacing);
    for (int c = 0; c < 3; ++c)
        r.settings.smoke.albedo[c] = static_cast<float>(kPoints[first + c].albedo);
    const Traced traced(r);
    const double sharp = radius > 4.0 ? 0.005 : kSharp;
    const Estimate e = estimate_to(sharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
        traced.look({dvec3(0.0), uniform_direction(u.y, u.z)}, u.x, rng, out);
    });
    for (int c = 0; c < 3; ++c) {
        const double albedo = kPoints[first + c].albedo;
        const double truth = expected_fluence(traced, albedo, radius, spacing);
        rows.expect("albedo " + std::to_string(albedo) + ", r " + std::to_string(radius), 4.0 * kPi64 * e.mean[c],
                    4.0 * kPi64 * e.error[c], truth, kMissing * truth, sharp);
    }
}

TEST(PointSource, LightsAnInfiniteMediumAsCaseAndZweifelSay) {
    Rows rows("point source");
    // Every albedo, and every distance from one mean free path on: near and middling ones in dark smoke, where few
    // paths get any further; others in bright smoke.
    for (const auto& [first, distance] : {std::pair(0, 2), {0, 4}, {3, 3}, {3, 5}})
        expect_fluence(rows, first, distance);
}

// One glowing node, so small that lines are drawn toward it: a tent of two voxels' width. Voxels of an eighth of a mean
// free path, so that its brick is no thicker than one.
constexpr double kFine = 0.125;
constexpr int kNear = 3;  // rows of the table: albedo 0.9 and less, at distances up to one

Recipe one_node() {
    Recipe r;
    r.box = cube(-kHalf, kHalf);
    r.world_from_index = cubic(kFine);
    r.density = [](const ivec3&) { return 1.0f; };
    r.flame = [](const ivec3& n) { return n == ivec3(4) ? 1.0f : 0.0f; };
    r.settings.fire.convention = EmissionConvention::Direct;
    for (int c = 0; c < 3; ++c)
        r.settings.smoke.albedo[c] = static_cast<float>(kPoints[kNear - c].albedo);
    return r;
}

// The mean over the node's tent of the point's fluence.
double fluence_of_tent(double c, const dvec3& from_node) {
    const double r = glm::length(from_node);
    const FluenceTable table(c, r - 2.0 * kFine, r + 2.0 * kFine);
    const auto along = [](const auto& f) {
        const auto weighted = [&](double s) { return (1.0 - std::abs(s)) * f(s * kFine); };
        return integral(-1.0, 0.0, weighted) + integral(0.0, 1.0, weighted);
    };
    return along([&](double x) {
        return along(
            [&](double y) { return along([&](double z) { return table(glm::length(from_node - dvec3(x, y, z))); }); });
    });
}

// Half of the directions toward the node, half to all other sides; 4 pi times their mean.
Estimate fluence_at(const Traced& traced, const dvec3& from_node, double sharp) {
    const double r = glm::length(from_node), cosine = std::sqrt(1.0 - 3.0 * kFine * kFine / (r * r));
    const dvec3 axis = -from_node / r, x = glm::normalize(glm::cross(axis, dvec3(0, 1, 0))), y = glm::cross(axis, x);
    const double toward = 0.5 * (1.0 - cosine);  // of all directions
    return estimate_to(sharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
        const bool near = u.y < 0.5;
        const double polar = near ? 2.0 * u.y * toward : toward + (2.0 * u.y - 1.0) * (1.0 - toward);
        const dvec3 d = uniform_direction(polar, u.z);
        traced.look({from_node + dvec3(4.0 * kFine), d.z * axis + d.x * x + d.y * y}, u.x, rng, out);
        for (int c = 0; c < 3; ++c)
            out[c] *= 8.0 * kPi64 * (near ? toward : 1.0 - toward);
    });
}

// By every estimate of the transmittance on the lines to the fire. To a percent: light from so small a source is noisy.
TEST(PointSource, ThatIsSmallLightsTheMediumTheSame) {
    Rows rows("small source");
    constexpr double sharp = 0.01;
    for (const auto transmittance :
         {TransmittanceEstimator::Exact, TransmittanceEstimator::RayMarch, TransmittanceEstimator::Ratio}) {
        TracingSettings settings;
        settings.transmittance = transmittance;
        const Traced traced(one_node(), settings);
        const double power = emitted_power(*traced.medium).x;
        const bool exact = transmittance == TransmittanceEstimator::Exact;
        for (const int i : exact ? std::vector<int>{1, 2} : std::vector<int>{2}) {
            const dvec3 from_node = kRadii[i] * glm::normalize(dvec3(0.64, 0.36, -0.68));
            const Estimate e = fluence_at(traced, from_node, sharp);
            for (int c = 0; c < 3; ++c) {
                const double albedo = kPoints[kNear - c].albedo, truth = power * fluence_of_tent(albedo, from_node);
                rows.expect("albedo " + std::to_string(albedo) + ", r " + std::to_string(kRadii[i]), e.mean[c],
                            e.error[c], truth, kMissing * truth, sharp);
            }
        }
    }
}

}  // namespace
}  // namespace brisance
