// Sampled directions follow pdf(), weights are values divided by it, and it integrates to the share of samples that
// are not empty.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "core/rng.h"
#include "fixtures/estimate.h"
#include "surface_fixture.h"

namespace brisance {
namespace {

using testing::coloured_surfaces;
using testing::direction;
using testing::NamedSurface;

constexpr double kPi64 = std::numbers::pi;
constexpr double kLeastChance =
    1e-5;  // of each chi-square: about 1 in 500 for all of them together, and seeds are fixed
constexpr int kSamples = 20'000;

// Rings and sectors around one direction. Rings grow from `width` [rad] at the middle by a constant factor.
class Target {
public:
    static constexpr int kRings = 20, kSectors = 8, kBins = kRings * kSectors;

    Target(const dvec3& middle, double width)
        : frame_(frame_around(middle)), square_(width * width), log_(std::log1p(2.0 / square_)) {}

    int bin_of(const dvec3& wi) const {
        const dvec3 w = frame_.local_from_world(wi);
        const double off = std::max(0.0, w.z > 0.0 ? (w.x * w.x + w.y * w.y) / (1.0 + w.z) : 1.0 - w.z);  // 1 - cosine
        const double ring = std::log1p(off / square_) / log_ * kRings;
        const double sector = (std::atan2(w.y, w.x) / (2.0 * kPi64) + 0.5) * kSectors;
        return std::min(int(ring), kRings - 1) * kSectors + std::min(int(sector), kSectors - 1);
    }

    // Integral over a bin, by the midpoints of a grid.
    template <class Function>
    double integrate(int bin, const Function& f) const {
        constexpr int n = 8;
        const int ring = bin / kSectors, sector = bin % kSectors;
        double sum = 0.0;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k) {
                const double growth = (ring + (i + 0.5) / n) / kRings * log_;
                const double off = square_ * std::expm1(growth), azimuth_step = 2.0 * kPi64 / kSectors / n;
                const double azimuth = (sector * n + k + 0.5) * azimuth_step - kPi64;
                const double sine = std::sqrt(off * (2.0 - off));
                const double solid_angle = log_ * (off + square_) / kRings / n * azimuth_step;
                const dvec3 w(sine * std::cos(azimuth), sine * std::sin(azimuth), 1.0 - off);
                sum += f(frame_.world_from_local(w)) * solid_angle;
            }
        return sum;
    }

private:
    ShadingFrame frame_;
    double square_, log_;
};

struct ChiSquare {
    double sum = 0.0;
    int bins = 0;

    void add(double count, double expected) {
        sum += (count - expected) * (count - expected) / expected;
        ++bins;
    }
};

// Over bins that expect enough, and all others as one.
double chance_of(const std::vector<double>& counts, const std::vector<double>& expected) {
    ChiSquare chi;
    double rest = 0.0, rest_expected = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (expected[i] >= 8.0) {
            chi.add(counts[i], expected[i]);
        } else {
            rest += counts[i];
            rest_expected += expected[i];
        }
    if (rest_expected >= 8.0)
        chi.add(rest, rest_expected);
    return chi.bins > 1 ? testing::chi_square_tail(chi.sum, chi.bins - 1) : 1.0;
}

// Compares what is drawn on one side with its density; the rest of the samples is one more bin.
double chance(const SurfaceMaterial& material, const dvec3& wo, bool transmitted, std::uint64_t seed) {
    const Bsdf bsdf(material, ShadingFrame{});
    const double eta = wo.z > 0.0 ? material.ior : 1.0 / material.ior;
    dvec3 middle(-wo.x, -wo.y, wo.z);
    if (transmitted) {
        const double x = -wo.x / eta, y = -wo.y / eta, square = 1.0 - x * x - y * y;
        middle = square > 0.0 ? dvec3(x, y, std::copysign(std::sqrt(square), -wo.z))
                              : glm::normalize(dvec3(-wo.x, -wo.y, -0.1 * wo.z));
    }
    const Target target(middle, 0.25 * testing::alpha_of(material));
    std::vector<double> counts(Target::kBins + 1), expected(Target::kBins + 1);
    Rng rng(Stream::Path, seed);
    for (int i = 0; i < kSamples; ++i) {
        const double u = rng.next_double(), v = rng.next_double(), w = rng.next_double();
        const auto s = bsdf.sample(wo, dvec3(u, v, w));
        const bool counted = s && !s->delta && s->transmitted == transmitted;
        counts[counted ? target.bin_of(s->wi) : Target::kBins] += 1.0;
    }
    expected.back() = kSamples;
    for (int bin = 0; bin < Target::kBins; ++bin) {
        expected[bin] = kSamples * target.integrate(bin, [&](const dvec3& wi) {
            return (wi.z * wo.z < 0.0) == transmitted ? bsdf.pdf(wo, wi) : 0.0;
        });
        expected.back() -= expected[bin];
    }
    return chance_of(counts, expected);
}

SurfaceMaterial only(float metallic, float transmission, float roughness) {
    SurfaceMaterial m;
    m.metallic = metallic;
    m.transmission = transmission;
    m.roughness = roughness;
    return m;
}

TEST(Sampling, FollowsItsDensity) {
    struct Lobe {
        const char* name;
        float metallic, transmission;
        double side;
        bool transmitted;
    };
    constexpr Lobe lobes[] = {{"metal", 1.0f, 0.0f, 1.0, false},
                              {"coated diffuse", 0.0f, 0.0f, 1.0, false},
                              {"glass, reflected", 0.0f, 1.0f, 1.0, false},
                              {"glass, refracted", 0.0f, 1.0f, 1.0, true},
                              {"glass from inside, reflected", 0.0f, 1.0f, -1.0, false},
                              {"glass from inside, refracted", 0.0f, 1.0f, -1.0, true},
                              {"blend, reflected", 0.3f, 0.5f, 1.0, false}};
    double least = 1.0;
    std::uint64_t seed = 0;
    for (const Lobe& lobe : lobes)
        for (const float roughness : {0.02f, 0.1f, 0.3f, 0.6f, 1.0f})
            for (const double cosine : {0.15, 0.5, 0.8, 0.99}) {
                const double p = chance(only(lobe.metallic, lobe.transmission, roughness),
                                        direction(lobe.side * cosine), lobe.transmitted, ++seed);
                EXPECT_GT(p, kLeastChance) << lobe.name << ", roughness " << roughness << ", cosine " << cosine;
                least = std::min(least, p);
            }
    std::printf("least of %d chances: %.4f\n", int(seed), least);
}

// The density integrates to the share of samples that are drawn and are no deltas, within four standard errors and the
// quadrature's 5e-4.
TEST(Sampling, DensityIntegratesToWhatIsDrawn) {
    constexpr int n = 20'000;
    std::uint64_t seed = 1000;
    for (NamedSurface surface : coloured_surfaces())
        for (const float roughness : {0.05f, 0.4f, 1.0f}) {
            surface.material.roughness = roughness;
            const dvec3 wo = direction(surface.side * 0.4);
            const Bsdf bsdf(surface.material, ShadingFrame{});
            const double integral = testing::integrate_sphere(surface.material, wo, [&](const dvec3& wi) {
                                        return Rgb(float(bsdf.pdf(wo, wi)));
                                    }).x;
            Rng rng(Stream::Path, ++seed);
            double drawn = 0.0;
            for (int i = 0; i < n; ++i) {
                const double u = rng.next_double(), v = rng.next_double(), w = rng.next_double();
                const auto s = bsdf.sample(wo, dvec3(u, v, w));
                drawn += s && !s->delta ? 1.0 / n : 0.0;
            }
            const double error = std::sqrt(std::max(0.0, integral * (1.0 - integral)) / n);
            EXPECT_NEAR(drawn, integral, 4.0 * error + 5e-4) << surface.name << ", roughness " << roughness;
        }
}

// Where every sample is used the density integrates to 1.
TEST(Sampling, DensityOfLambertIntegratesToOne) {
    SurfaceMaterial chalk;
    chalk.specular = 0.0f;
    const Bsdf bsdf(chalk, ShadingFrame{});
    const dvec3 wo = direction(0.4);
    const Rgb integral =
        testing::integrate_sphere(chalk, wo, [&](const dvec3& wi) { return Rgb(float(bsdf.pdf(wo, wi))); });
    EXPECT_NEAR(integral.x, 1.0, 2e-4);
}

TEST(Sampling, WeightIsValueOverDensity) {
    Rng rng(Stream::Path, 77);
    const ShadingFrame frame = frame_around(glm::normalize(dvec3(0.3, -0.5, 0.2)));
    for (NamedSurface surface : coloured_surfaces())
        for (const float roughness : {0.0f, 0.02f, 0.3f, 1.0f})
            for (const Transport transport : {Transport::Radiance, Transport::Importance}) {
                surface.material.roughness = roughness;
                const Bsdf bsdf(surface.material, frame);
                for (int i = 0; i < 40; ++i) {
                    const double cosine = surface.side * (0.02 + 0.98 * rng.next_double());
                    const dvec3 wo = frame.world_from_local(direction(cosine, 6.0 * rng.next_double()));
                    const double u = rng.next_double(), v = rng.next_double(), w = rng.next_double();
                    const auto s = bsdf.sample(wo, dvec3(u, v, w), transport);
                    if (!s || s->delta)
                        continue;
                    const double pdf = bsdf.pdf(wo, s->wi);
                    const Rgb weight = bsdf.evaluate(wo, s->wi, transport) / float(pdf);
                    EXPECT_NEAR(pdf / s->pdf, 1.0, 1e-4) << surface.name << ", roughness " << roughness;
                    for (int c = 0; c < 3; ++c)
                        EXPECT_NEAR(weight[c], s->weight[c], 1e-4f * (1.0f + s->weight[c])) << surface.name;
                    EXPECT_NEAR(glm::length(s->wi), 1.0, 1e-12);
                    EXPECT_EQ(s->transmitted, glm::dot(s->wi, frame.normal) * cosine < 0.0);
                }
            }
}

}  // namespace
}  // namespace brisance
