// Points sampled on ray lights and rays sampled from a glossy lobe estimate the same light, and their sum counts it
// once.
#include <gtest/gtest.h>

#include <cstdio>

#include "fixtures/ray_fixture.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kPointsAcross = 6;  // to a set, one in each cell of a grid
constexpr int kPoints = 4;

// `x` and `y` in [0, 1): where.
SurfacePoint on_metal(double x, double y, float roughness, const dvec3& normal = {0.0, 0.0, 1.0}) {
    SurfacePoint p;
    p.position = {x - 0.5, y - 2.0, -1.3};
    p.geometric_normal = {0.0, 0.0, 1.0};
    p.frame = frame_around(normal);
    p.material.metallic = 1.0f;
    p.material.roughness = roughness;
    p.material.base_colour = Rgb(0.9f, 0.8f, 0.6f);
    return p;
}

// Estimates the light of smoke, scattered twice or more, that metal reflects. `points`: of the split.
double reflected(const DirectLight& scene, const RayLights& lights, const SurfacePoint& point, double points,
                 Rng& rng) {
    const dvec3 viewer = glm::normalize(dvec3(0.0, -1.0, 0.8));
    const Bsdf base(point.material, point.frame, Lobes::Base), gloss(point.material, point.frame, Lobes::Specular);
    const GlossSplit split(point, gloss, viewer, points);
    double sum = lights.at_surface(point, ReceiverLobes(base, &split), viewer, rng).x;
    const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
    const std::optional<BsdfSample> drawn = gloss.sample(viewer, {x, y, z});
    const double left = drawn ? split.of_rays(drawn->wi) : 0.0;
    if (!(left > 0.0))
        return sum;
    const RaySegment segment = scene.segment_along(point.leaving(drawn->wi));
    RayMedium seen;
    seen.look(scene.field(), segment.ray, segment.end);
    return sum + drawn->weight.x * left * lights.along_ray(seen, rng).x;
}

struct Shared {
    double rays, points, both;  // relative deviation of one point's estimate, about
};

Shared expect_same(const Stage& stage, RayLightSettings settings, float roughness, const dvec3& normal) {
    settings.paths = 600;
    settings.samples = kPoints;
    constexpr double kSplits[] = {0.0, 1e12, kPoints};
    const Estimate e = estimate(3, 1, [&](const dvec3&, Rng& rng, double* out) {
        settings.seed = static_cast<std::uint32_t>(rng.next_double() * 0x1p32);
        const RayLights lights = stage.lights(settings, 16, settings.seed);
        std::fill(out, out + 3, 0.0);
        for (int i = 0; i < kPointsAcross * kPointsAcross; ++i)
            for (int k = 0; k < 3; ++k) {
                const glm::dvec2 at = point_in_cell(i, kPointsAcross, rng);
                const SurfacePoint point = on_metal(at.x, at.y, roughness, normal);
                out[k] +=
                    reflected(stage.scene(), lights, point, kSplits[k], rng) / double(kPointsAcross * kPointsAcross);
            }
    });
    std::printf("roughness %g: by rays %.4g +- %.2g %%, by points %.4g +- %.2g %%, by both %.4g +- %.2g %%\n",
                roughness, e.mean[0], 100.0 * e.error[0] / e.mean[0], e.mean[1], 100.0 * e.error[1] / e.mean[1],
                e.mean[2], 100.0 * e.error[2] / e.mean[2]);
    for (int k = 0; k < 2; ++k)
        EXPECT_NEAR(e.mean[k], e.mean[2], 3.0 * std::hypot(e.error[k], e.error[2])) << roughness << ", " << k;
    EXPECT_LT(e.error[2], 0.03 * e.mean[2]) << roughness << ": not sampled enough";
    return {e.error[0], e.error[1], e.error[2]};
}

TEST(GlossSplit, PointsAndRaysFindTheSameLight) {
    const Stage stage(lumpy_ball(8, 3.0f, 0.3f), {});
    const dvec3 up(0.0, 0.0, 1.0);
    for (const float roughness : {0.15f, 0.4f, 0.9f}) {
        const Shared noise = expect_same(stage, {}, roughness, up);
        EXPECT_LT(noise.both, 1.15 * std::min(noise.rays, noise.points)) << roughness;
    }
}

TEST(GlossSplit, HoldsForBentNormalsAndLongLights) {
    const Stage stage(lumpy_ball(8, 2.0f, 0.0f), {});
    const dvec3 bent = glm::normalize(dvec3(0.3, -0.4, 1.0));
    RayLightSettings settings;
    settings.length = RayLength::Long;
    expect_same(stage, settings, 0.4f, bent);
}

TEST(GlossSplit, PartsOfADirectionAddUp) {
    Rng rng(Stream::Points, 9);
    for (const float roughness : {0.1f, 0.5f, 1.0f}) {
        const double x = rng.next_double(), y = rng.next_double();
        const SurfacePoint point = on_metal(x, y, roughness);
        const Bsdf gloss(point.material, point.frame, Lobes::Specular);
        const dvec3 viewer = glm::normalize(dvec3(0.4, -1.0, 0.8));
        const GlossSplit split(point, gloss, viewer, kPoints);
        for (int i = 0; i < 1000; ++i) {
            const dvec3 to =
                glm::normalize(dvec3(rng.next_double() - 0.5, rng.next_double() - 0.5, rng.next_double() - 0.5));
            const Rgb whole = gloss.evaluate(viewer, to);
            const double of_rays = split.of_rays(to);
            EXPECT_GE(of_rays, 0.0);
            EXPECT_LE(of_rays, 1.0);
            EXPECT_NEAR(split.of_lights(to).x + of_rays * whole.x, whole.x, 1e-5 * whole.x);
            // The contribution of one light is bounded, however sharp the lobe.
            EXPECT_LE(split.of_lights(to).x, 1.0001 * kPoints / (2.0 * std::numbers::pi));
        }
        EXPECT_EQ(split.of_rays({0.0, 0.6, -0.8}), 1.0);
    }
}

}  // namespace
}  // namespace brisance
