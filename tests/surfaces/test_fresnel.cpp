// Closed forms of Fresnel's equations.
#include <gtest/gtest.h>

#include <cmath>

#include "surfaces/fresnel.h"

namespace brisance {
namespace {

TEST(Fresnel, NormalIncidenceIsTheSquareOfTheIndexContrast) {
    for (const double eta : {1.0, 1.33, 1.5, 2.4, 1.0 / 1.5})
        EXPECT_NEAR(dielectric_fresnel(1.0, eta), std::pow((eta - 1.0) / (eta + 1.0), 2), 1e-15);
}

// At Brewster's angle only light polarised across the plane of incidence comes back: half of the square of
// (eta^2 - 1) / (eta^2 + 1).
TEST(Fresnel, BrewstersAngleReflectsOnePolarisation) {
    for (const double eta : {1.33, 1.5, 2.4}) {
        const double cosine = 1.0 / std::sqrt(1.0 + eta * eta), ratio = (eta * eta - 1.0) / (eta * eta + 1.0);
        EXPECT_NEAR(dielectric_fresnel(cosine, eta), 0.5 * ratio * ratio, 1e-14);
    }
}

TEST(Fresnel, EverythingIsReflectedInsideBeyondTheCriticalAngle) {
    const double eta = 1.0 / 1.5, critical = std::sqrt(1.0 - eta * eta);
    EXPECT_EQ(dielectric_fresnel(critical - 1e-9, eta), 1.0);
    EXPECT_FALSE(refracted_cosine(critical - 1e-9, eta));
    EXPECT_LT(dielectric_fresnel(critical + 1e-3, eta), 0.8);
    EXPECT_EQ(dielectric_fresnel(0.0, eta), 1.0);
}

TEST(Fresnel, IsTheSameFromBothSides) {
    for (const double cosine : {0.05, 0.4, 0.9}) {
        const double inside = *refracted_cosine(cosine, 1.5);
        EXPECT_NEAR(dielectric_fresnel(cosine, 1.5), dielectric_fresnel(inside, 1.0 / 1.5), 1e-13);
    }
}

TEST(Fresnel, GrazingIncidenceReflectsEverythingUnlessIndicesMatch) {
    EXPECT_EQ(dielectric_fresnel(0.0, 1.5), 1.0);
    EXPECT_EQ(dielectric_fresnel(0.0, 1.0), 0.0);
    EXPECT_EQ(dielectric_blend(0.0, 1.0), 0.0);
}

TEST(Fresnel, SchlicksMeanIsItsIntegral) {
    const Rgb f0(0.04f, 0.5f, 1.0f);
    dvec3 sum(0.0);
    constexpr int n = 2000;
    for (int i = 0; i < n; ++i) {
        const double cosine = (i + 0.5) / n;
        sum += dvec3(schlick_fresnel(f0, cosine)) * (2.0 * cosine / n);
    }
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c], mean_schlick_fresnel(f0)[c], 1e-6);
}

}  // namespace
}  // namespace brisance
