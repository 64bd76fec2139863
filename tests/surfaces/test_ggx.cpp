// The distribution of normals: its normalisation, and its masking.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "surfaces/ggx.h"

namespace brisance {
namespace {

constexpr double kAlphas[] = {1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0};

// Facets project onto the whole surface: integral of D(h) cos(h) = 1. In t with tan^2 = alpha^2 t / (1 - t), which
// makes the integrand 1 and thereby checks D everywhere.
TEST(Ggx, FacetsProjectOntoTheSurface) {
    for (const double alpha : kAlphas) {
        double sum = 0.0;
        constexpr int n = 1000;
        for (int i = 0; i < n; ++i) {
            const double t = (i + 0.5) / n, tangent = alpha * std::sqrt(t / (1.0 - t));
            const double z = 1.0 / std::sqrt(1.0 + tangent * tangent), x = tangent * z;
            const double steradians_per_t = std::numbers::pi * alpha * alpha * z * z * z / ((1.0 - t) * (1.0 - t));
            sum += Ggx{alpha}.density(dvec3(x, 0.0, z)) * z * steradians_per_t / n;
        }
        EXPECT_NEAR(sum, 1.0, 1e-9) << alpha;
    }
}

TEST(Ggx, PeakIsOneOverPiAlphaSquared) {
    for (const double alpha : kAlphas)
        EXPECT_NEAR(Ggx{alpha}.density(dvec3(0.0, 0.0, 1.0)) * std::numbers::pi * alpha * alpha, 1.0, 1e-12);
}

// Facets that can be seen project onto what the surface shows of itself: integral of G1 D max(0, o.h) = cos.
TEST(Ggx, VisibleFacetsProjectOntoTheView) {
    for (const double alpha : kAlphas)
        for (const double cosine : {0.02, 0.3, 0.8, 1.0}) {
            const dvec3 wo(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
            constexpr int n = 1200, m = 400;
            double sum = 0.0;
            for (int i = 0; i < n; ++i)
                for (int k = 0; k < m; ++k) {
                    const double s = (i + 0.5) / n, t = 1.0 - (1.0 - s) * (1.0 - s) * (1.0 - s);
                    const double tangent = alpha * std::sqrt(t / (1.0 - t)),
                                 z = 1.0 / std::sqrt(1.0 + tangent * tangent);
                    const double azimuth = std::numbers::pi * (k + 0.5) / m;
                    const dvec3 h(tangent * z * std::cos(azimuth), tangent * z * std::sin(azimuth), z);
                    // D times solid angle is 1 / cos(h) per t.
                    sum += std::max(0.0, glm::dot(wo, h)) / z * 3.0 * (1.0 - s) * (1.0 - s) / (double(n) * m);
                }
            EXPECT_NEAR(Ggx{alpha}.masking(cosine) * sum / cosine, 1.0, 2e-4) << alpha << " " << cosine;
        }
}

TEST(Ggx, MaskingIsOneSeenFromAboveAndZeroSeenFromTheSide) {
    for (const double alpha : kAlphas) {
        const Ggx ggx{alpha};
        EXPECT_NEAR(ggx.masking(1.0), 1.0, 1e-15);
        EXPECT_EQ(ggx.masking(0.0), 0.0);
        // Of both directions it is at most that of one.
        for (const double o : {0.01, 0.3, 1.0})
            for (const double i : {0.01, 0.3, 1.0})
                EXPECT_LE(ggx.correlated_masking_per_cosines(o, i) * o * i, ggx.masking(std::min(o, i)) + 1e-15);
        EXPECT_NEAR(ggx.correlated_masking_per_cosines(1.0, 0.3) * 0.3, ggx.masking(0.3), 1e-12);
    }
}

}  // namespace
}  // namespace brisance
