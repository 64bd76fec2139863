// The white furnace: lossless surfaces return all energy, whatever the roughness, angle and side. No surface returns
// more than it receives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "surface_fixture.h"

namespace brisance {
namespace {

using testing::coloured_surfaces;
using testing::conserving_surfaces;
using testing::direction;
using testing::directional_albedo;
using testing::NamedSurface;

constexpr float kRoughnesses[] = {0.0f, 0.0101f, 0.03f, 0.1f, 0.2f, 0.45f, 0.7f, 1.0f};
constexpr double kCosines[] = {0.02, 0.1, 0.3, 0.6, 0.75, 0.95, 1.0};

TEST(Energy, WhiteFurnace) {
    for (NamedSurface surface : conserving_surfaces()) {
        double least = 1.0, largest = 1.0;
        for (const float roughness : kRoughnesses)
            for (const double cosine : kCosines) {
                surface.material.roughness = roughness;
                const Rgb albedo = directional_albedo(surface.material, direction(surface.side * cosine));
                EXPECT_NEAR(albedo.x, 1.0, surface.tolerance)
                    << surface.name << ", roughness " << roughness << ", cosine " << cosine;
                EXPECT_NEAR(albedo.y, albedo.x, 1e-6);
                least = std::min<double>(least, albedo.x);
                largest = std::max<double>(largest, albedo.x);
            }
        std::printf("%s: %+.3f %% to %+.3f %%\n", surface.name.c_str(), 100.0 * (least - 1.0), 100.0 * (largest - 1.0));
    }
}

// Within the tolerance of the furnace.
TEST(Energy, NothingReturnsMoreThanItGot) {
    for (NamedSurface surface : coloured_surfaces())
        for (const float roughness : {0.0f, 0.05f, 0.3f, 1.0f})
            for (const double cosine : {0.03, 0.5, 1.0}) {
                surface.material.roughness = roughness;
                const Rgb albedo = directional_albedo(surface.material, direction(surface.side * cosine));
                for (int c = 0; c < 3; ++c) {
                    EXPECT_LE(albedo[c], 1.001f) << surface.name << ", roughness " << roughness;
                    EXPECT_GE(albedo[c], 0.0f);
                }
            }
}

// A smooth interface is Fresnel's equations: what is not reflected is refracted by Snell's law.
TEST(Energy, SmoothGlassIsADeltaPair) {
    SurfaceMaterial glass;
    glass.transmission = 1.0f;
    glass.roughness = 0.0f;
    const Bsdf bsdf(glass, ShadingFrame{});
    const auto lobes = testing::delta_lobes(bsdf, direction(1.0));
    ASSERT_EQ(lobes.size(), 2u);
    for (const BsdfSample& lobe : lobes) {
        EXPECT_NEAR(lobe.weight.x * lobe.pdf, lobe.transmitted ? 0.96 : 0.04, 1e-6);
        EXPECT_NEAR(lobe.wi.z, lobe.transmitted ? -1.0 : 1.0, 1e-12);
    }
    const dvec3 slanted = direction(0.5);
    for (const BsdfSample& lobe : testing::delta_lobes(bsdf, slanted)) {
        const double eta = lobe.transmitted ? 1.5 : 1.0;
        EXPECT_NEAR(eta * lobe.wi.x, -slanted.x, 1e-12);
        EXPECT_NEAR(eta * lobe.wi.y, -slanted.y, 1e-12);
    }
    EXPECT_EQ(testing::delta_lobes(bsdf, direction(-0.5)).size(), 1u) << "beyond the critical angle";
}

// A smooth metal's colour at normal incidence is its base colour.
TEST(Energy, SmoothMetalHasItsColour) {
    SurfaceMaterial gold;
    gold.metallic = 1.0f;
    gold.roughness = 0.0f;
    gold.base_colour = Rgb(1.0f, 0.7f, 0.3f);
    const Rgb albedo = directional_albedo(gold, direction(1.0));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(albedo[c], gold.base_colour[c], 1e-6);
}

// Without a coat the base is Lambert's: base colour / pi times the cosine.
TEST(Energy, WithoutACoatTheBaseIsLambert) {
    SurfaceMaterial chalk;
    chalk.specular = 0.0f;
    chalk.base_colour = Rgb(0.8f, 0.4f, 0.0f);
    const Bsdf bsdf(chalk, ShadingFrame{});
    for (const double o : {0.0, 0.1, 1.0})
        for (const double i : {0.2, 0.9}) {
            const Rgb value = bsdf.evaluate(direction(o), direction(i, 2.0));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(value[c], chalk.base_colour[c] * i / 3.14159265, 1e-6);
        }
}

}  // namespace
}  // namespace brisance
