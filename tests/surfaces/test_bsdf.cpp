// Properties of every surface: reciprocity, finite values, and black where no light can come from.
#include <gtest/gtest.h>

#include <cmath>
#include <new>
#include <vector>

#include "core/rng.h"
#include "surface_fixture.h"

namespace brisance {
namespace {

using testing::coloured_surfaces;
using testing::direction;
using testing::NamedSurface;

bool finite_and_not_negative(const Rgb& c) {
    return c.x >= 0.0f && c.y >= 0.0f && c.z >= 0.0f && std::isfinite(c.x + c.y + c.z);
}

dvec3 any_direction(Rng& rng) {
    const double z = 2.0 * rng.next_double() - 1.0;
    return direction(z, 6.283185 * rng.next_double());
}

// In memory full of numbers that are none, so that a member without a value would be one.
TEST(Bsdf, LeavesNoMemberToChance) {
    alignas(Bsdf) static volatile unsigned char memory[sizeof(Bsdf)];
    SurfaceMaterial plain;
    plain.specular = 0.0f;
    std::vector<NamedSurface> surfaces = coloured_surfaces();
    surfaces.push_back({"Lambert alone", plain});
    for (const NamedSurface& surface : surfaces) {
        for (volatile unsigned char& byte : memory)
            byte = 0xff;
        const Bsdf* const bsdf = new (const_cast<unsigned char*>(memory)) Bsdf(surface.material, ShadingFrame{});
        const dvec3 wo = direction(0.7, 0.3), wi = direction(0.4, 2.0);
        EXPECT_TRUE(finite_and_not_negative(bsdf->evaluate(wo, wi))) << surface.name;
        EXPECT_EQ(bsdf->evaluate(wo, wi), Bsdf(surface.material, ShadingFrame{}).evaluate(wo, wi)) << surface.name;
        EXPECT_EQ(bsdf->pdf(wo, wi), Bsdf(surface.material, ShadingFrame{}).pdf(wo, wi)) << surface.name;
    }
}

// f(wo, wi) / index_o^2 = f(wi, wo) / index_i^2, with the index of the side that each direction lies on (Veach 1997,
// section 5.2).
TEST(Bsdf, IsReciprocal) {
    Rng rng(Stream::Path, 5);
    for (NamedSurface surface : coloured_surfaces())
        for (const float roughness : {0.05f, 0.3f, 1.0f}) {
            surface.material.roughness = roughness;
            const Bsdf bsdf(surface.material, ShadingFrame{});
            for (int i = 0; i < 100; ++i) {
                const dvec3 a = any_direction(rng), b = any_direction(rng);
                const double index_a = a.z > 0.0 ? 1.0 : surface.material.ior;
                const double index_b = b.z > 0.0 ? 1.0 : surface.material.ior;
                const dvec3 ab = dvec3(bsdf.evaluate(a, b)) / std::abs(b.z) / (index_a * index_a);
                const dvec3 ba = dvec3(bsdf.evaluate(b, a)) / std::abs(a.z) / (index_b * index_b);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(ab[c], ba[c], 2e-5 * (1e-4 + ab[c] + ba[c]))
                        << surface.name << " " << a.z << " " << b.z;
            }
        }
}

// Importance is radiance with the two directions swapped.
TEST(Bsdf, ImportanceIsTheAdjoint) {
    SurfaceMaterial glass;
    glass.transmission = 1.0f;
    glass.roughness = 0.5f;
    const Bsdf bsdf(glass, ShadingFrame{});
    const dvec3 a = direction(0.7), b = direction(-0.6, 3.0);
    const double forward = bsdf.evaluate(a, b, Transport::Importance).x / std::abs(b.z);
    const double backward = bsdf.evaluate(b, a, Transport::Radiance).x / std::abs(a.z);
    EXPECT_GT(forward, 0.0);
    EXPECT_NEAR(forward / backward, 1.0, 1e-5);
    EXPECT_NEAR(bsdf.evaluate(a, b, Transport::Radiance).x / bsdf.evaluate(a, b, Transport::Importance).x,
                1.0 / (1.5 * 1.5), 1e-6);
}

// The base and the other lobes, lit separately, add up to the whole surface. The base's share of power is its integral.
TEST(Bsdf, LobesAddUpToTheWhole) {
    Rng rng(Stream::Path, 7);
    for (NamedSurface surface : coloured_surfaces())
        for (const float roughness : {0.05f, 0.25f, 0.6f}) {
            surface.material.roughness = roughness;
            const Bsdf all(surface.material, {}), base(surface.material, {}, Lobes::Base),
                others(surface.material, {}, Lobes::Specular);
            for (int i = 0; i < 100; ++i) {
                const dvec3 a = any_direction(rng), b = any_direction(rng);
                const Rgb whole = all.evaluate(a, b), sum = base.evaluate(a, b) + others.evaluate(a, b);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(sum[c], whole[c], 1e-5f * (1e-3f + whole[c])) << surface.name;
            }
            const dvec3 wo = direction(0.1 + 0.8 * rng.next_double());
            dvec3 drawn(0.0);
            constexpr int kSamples = 20000;
            for (int i = 0; i < kSamples; ++i) {
                const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
                if (const std::optional<BsdfSample> s = base.sample(wo, {x, y, z}))
                    drawn += dvec3(s->weight) / double(kSamples);
            }
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(base.base_albedo(wo)[c], drawn[c], 0.01) << surface.name << " " << roughness;
        }
}

TEST(Bsdf, IsFiniteEverywhere) {
    Rng rng(Stream::Path, 6);
    const double cosines[] = {-1.0, -0.5, -1e-9, -0.0, 0.0, 1e-300, 1e-9, 1e-4, 0.5, 1.0};
    const double ends[] = {0.0, 1e-16, 0.5, 1.0 - 0x1p-53};
    for (NamedSurface surface : coloured_surfaces())
        for (const float roughness : {0.0f, 0.0099f, 0.0101f, 0.3f, 1.0f})
            for (const Rgb& base : {Rgb(0.0f), Rgb(1.0f), Rgb(0.9f, 0.5f, 0.0f)}) {
                surface.material.roughness = roughness;
                surface.material.base_colour = base;
                const Bsdf bsdf(surface.material, ShadingFrame{});
                for (const double o : cosines) {
                    for (const double i : cosines)
                        for (const double azimuth : {0.3, 0.3 + 3.14159265358979}) {
                            EXPECT_TRUE(finite_and_not_negative(bsdf.evaluate(direction(o), direction(i, azimuth))));
                            const double pdf = bsdf.pdf(direction(o), direction(i, azimuth));
                            EXPECT_TRUE(pdf >= 0.0 && std::isfinite(pdf)) << surface.name << " " << o << " " << i;
                        }
                    for (int k = 0; k < 24; ++k) {
                        const dvec3 u = k < 16 ? dvec3(rng.next_double(), ends[k / 4], ends[k % 4])
                                               : dvec3(ends[k % 4], rng.next_double(), rng.next_double());
                        if (const auto s = bsdf.sample(direction(o), u)) {
                            EXPECT_TRUE(finite_and_not_negative(s->weight))
                                << surface.name << ", roughness " << roughness << ", cosine " << o << ", numbers "
                                << u.x << " " << u.y << " " << u.z;
                            EXPECT_TRUE(s->pdf > 0.0 && std::isfinite(s->pdf));
                            EXPECT_NEAR(glm::length(s->wi), 1.0, 1e-9);
                        }
                    }
                }
            }
}

TEST(Bsdf, OpaqueSurfacesAreBlackFromBelow) {
    for (const float metallic : {0.0f, 0.5f, 1.0f}) {
        SurfaceMaterial opaque;
        opaque.metallic = metallic;
        const Bsdf bsdf(opaque, ShadingFrame{});
        EXPECT_EQ(bsdf.evaluate(direction(-0.5), direction(-0.5)), Rgb(0.0f));
        EXPECT_EQ(bsdf.evaluate(direction(-0.5), direction(0.5)), Rgb(0.0f));
        EXPECT_EQ(bsdf.evaluate(direction(0.5), direction(-0.5)), Rgb(0.0f));
        EXPECT_FALSE(bsdf.sample(direction(-0.5), dvec3(0.5)));
    }
}

// Inside and outside alike: light goes straight on, whatever the roughness.
TEST(Bsdf, MatchedIndexLetsLightThrough) {
    SurfaceMaterial water_in_water;
    water_in_water.transmission = 1.0f;
    water_in_water.ior = 1.0f;
    water_in_water.base_colour = Rgb(0.2f, 0.5f, 1.0f);
    for (const double cosine : {0.6, -0.6}) {
        const dvec3 wo = direction(cosine);
        const auto s = Bsdf(water_in_water, ShadingFrame{}).sample(wo, dvec3(0.5));
        ASSERT_TRUE(s && s->delta && s->transmitted);
        EXPECT_NEAR(glm::distance(s->wi, -wo), 0.0, 1e-12);
        EXPECT_EQ(s->weight, water_in_water.base_colour);
    }
}

}  // namespace
}  // namespace brisance
