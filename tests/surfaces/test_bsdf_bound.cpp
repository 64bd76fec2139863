// Upper bounds of BSDFs over cones.
#include "surfaces/bsdf_bound.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"
#include "surface_fixture.h"

namespace brisance {
namespace {

using testing::coloured_surfaces;
using testing::direction;
using testing::NamedSurface;

dvec3 somewhere(Rng& rng) {
    return direction(2.0 * rng.next_double() - 1.0, 6.283185 * rng.next_double());
}

// A direction within the angle of the axis.
dvec3 around(const dvec3& axis, double cos_around, Rng& rng) {
    const double cosine = 1.0 - rng.next_double() * (1.0 - cos_around);
    return frame_around(axis).world_from_local(direction(cosine, 6.283185 * rng.next_double()));
}

TEST(BsdfBound, IsNeverBelow) {
    Rng rng(Stream::Path, 7);
    for (NamedSurface surface : coloured_surfaces())
        for (const float roughness : {0.005f, 0.1f, 0.3f, 0.6f, 1.0f}) {
            surface.material.roughness = roughness;
            if (surface.material.transmission > 0.0f && !surface.material.thin)
                continue;  // rough glass has no bound
            const Bsdf bsdf(surface.material, ShadingFrame{});
            for (int i = 0; i < 400; ++i) {
                const dvec3 wo = somewhere(rng), axis = somewhere(rng);
                const double cos_around = std::cos(3.14159265 * std::pow(rng.next_double(), 3.0));
                const double bound = BsdfBound(bsdf, wo).over(axis, cos_around);
                for (int k = 0; k < 20; ++k) {
                    const Rgb value = bsdf.evaluate(wo, around(axis, cos_around, rng));
                    ASSERT_LE(std::max({value.x, value.y, value.z}), bound * 1.0001 + 1e-7)
                        << surface.name << " " << roughness << " " << cos_around << " " << wo.z;
                }
            }
        }
}

// Of those directions of a cone that lie no higher than that above the surface.
TEST(BsdfBound, IsNeverBelowNearTheSurface) {
    Rng rng(Stream::Path, 9);
    for (NamedSurface surface : coloured_surfaces())
        for (const float roughness : {0.05f, 0.3f, 1.0f}) {
            surface.material.roughness = roughness;
            if (surface.material.transmission > 0.0f && !surface.material.thin)
                continue;  // rough glass has no bound
            const Bsdf bsdf(surface.material, ShadingFrame{});
            for (int i = 0; i < 300; ++i) {
                const double most = std::pow(10.0, -4.0 * rng.next_double());
                const dvec3 wo = direction(std::pow(rng.next_double(), 3.0), 6.283185 * rng.next_double());
                const BsdfBound bounds(bsdf, wo);
                const double bound = bounds.over({0.0, 0.0, 1.0}, -1.0, most);
                EXPECT_LE(bound, bounds.over({0.0, 0.0, 1.0}, -1.0));
                for (int k = 0; k < 30; ++k) {
                    // Half of them across from wo, where lobes are.
                    const double turn = k % 2 == 0 ? 3.14159265 : 6.283185 * rng.next_double();
                    const dvec3 wi = direction(most * rng.next_double(), std::atan2(wo.y, wo.x) + turn);
                    const Rgb value = bsdf.evaluate(wo, wi);
                    ASSERT_LE(std::max({value.x, value.y, value.z}), bound * 1.0001 + 1e-7)
                        << surface.name << " " << roughness << " " << most << " " << wo.z;
                }
            }
        }
}

// Grazing directions scatter little, as facets mask them, in proportion to the cosine.
TEST(BsdfBound, FallsWithTheHeightAboveTheSurface) {
    SurfaceMaterial metal;
    metal.metallic = 1.0f;
    metal.roughness = 0.4f;
    const Bsdf bsdf(metal, ShadingFrame{});
    const BsdfBound bounds(bsdf, direction(0.7));
    const double all = bounds.over({0.0, 0.0, 1.0}, -1.0);
    EXPECT_LT(bounds.over({0.0, 0.0, 1.0}, -1.0, 0.01), 0.2 * all);
    EXPECT_LT(bounds.over({0.0, 0.0, 1.0}, -1.0, 0.001), 0.02 * all);
}

// Of one direction the bound is the value, up to masking and what facets lose.
TEST(BsdfBound, IsTightForOneDirection) {
    Rng rng(Stream::Path, 8);
    SurfaceMaterial metal;
    metal.metallic = 1.0f;
    metal.roughness = 0.3f;
    const Bsdf bsdf(metal, ShadingFrame{});
    const dvec3 wo = direction(0.8), mirrored = direction(0.8, 3.14159265);
    const double value = bsdf.evaluate(wo, mirrored).x, bound = BsdfBound(bsdf, wo).over(mirrored, 1.0);
    EXPECT_GE(bound, value);
    EXPECT_LT(bound, 1.2 * value);
    // Far from the lobe it is small.
    EXPECT_LT(BsdfBound(bsdf, wo).over(direction(0.8, 0.0), 0.999), 0.3 * value);
}

}  // namespace
}  // namespace brisance
