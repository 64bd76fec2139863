#include "ray_fixture.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace brisance::testing {

namespace {

constexpr int kRaysToASet = 64;

}  // namespace

Stage::Stage(const Recipe& recipe, Scene scene, std::vector<LightSettings> lights, int bounces)
    : medium_(std::make_unique<Medium>(make_medium(recipe))),
      surroundings_(std::make_unique<Surroundings>(std::move(scene), std::move(lights))),
      tracer_(*medium_, {}, bounces, surroundings_.get()),
      bounces_(bounces) {}

Twice Stage::by_paths(const Ray& ray, double place, Rng& rng) const {
    PathSum sum{};
    PathStatistics statistics;
    tracer_.trace(ray, place, rng, sum, statistics);
    return {sum.cells.at(Cell::MM), sum.cells.at(Cell::SM)};
}

Twice Stage::by_lights(const InScattering& lights, const Ray& ray, Rng& rng, bool all) const {
    const RaySegment segment = scene().segment_along(ray);
    RayMedium seen;
    seen.look(scene().field(), ray, segment.end);
    Twice out;
    out.medium = all ? lights.along_ray_from_all(seen, rng) : lights.along_ray(seen, rng);
    if (!segment.point)
        return out;
    const float through = seen.empty() ? 1.0f : float(seen.transmittance(seen.segment().length));
    const Bsdf bsdf(segment.point->material, segment.point->frame);
    const dvec3 toward_viewer = -ray.direction;
    out.surface = through * (all ? lights.at_surface_from_all(*segment.point, bsdf, toward_viewer, rng)
                                 : lights.at_surface(*segment.point, bsdf, toward_viewer, rng));
    return out;
}

RayLights Stage::lights(const RayLightSettings& settings, int rays, std::uint64_t key) const {
    return RayLights(scene(), settings, bounces_, receivers(rays, key));
}

std::vector<LightReceiver> Stage::receivers(int rays, std::uint64_t key) const {
    std::vector<LightReceiver> receivers;
    Rng rng(Stream::Points, key);
    for (int i = 0; i < rays; ++i) {
        const Ray r = ray(rng);
        const RaySegment segment = scene().segment_along(r);
        RayMedium seen;
        seen.look(scene().field(), r, segment.end);
        if (!seen.empty())
            receivers.push_back(receiver_along(seen));
        if (segment.point)
            receivers.push_back(LightReceiver::at(segment.point->position, segment.point->frame.normal));
    }
    return receivers;
}

Ray Stage::ray(Rng& rng) const {
    const dvec3 target(1.6 * rng.next_double() - 0.8, 1.6 * rng.next_double() - 0.8, 0.0);
    const dvec3 eye(0.5, -3.0, 2.5);
    return {eye, glm::normalize(target - eye)};
}

namespace {

void put(const Twice& t, double weight, double* out) {
    for (int c = 0; c < 3; ++c) {
        out[c] += weight * t.medium[c];
        out[3 + c] += weight * t.surface[c];
    }
}

}  // namespace

Estimate mean_by_paths(const Stage& stage, std::uint64_t samples) {
    return estimate(6, samples, [&](const dvec3& place, Rng& rng, double* out) {
        std::fill(out, out + 6, 0.0);
        const Ray ray = stage.ray(rng);
        put(stage.by_paths(ray, place.z, rng), 1.0, out);
    });
}

Estimate mean_by_lights(const Stage& stage, const MakeLights& make, std::uint64_t sets) {
    return estimate(6, sets, [&](const dvec3&, Rng& rng, double* out) {
        std::fill(out, out + 6, 0.0);
        const auto set = make(static_cast<std::uint32_t>(rng.next_double() * 4294967296.0));
        for (int i = 0; i < kRaysToASet; ++i) {
            const Ray ray = stage.ray(rng);
            put(stage.by_lights(*set, ray, rng), 1.0 / kRaysToASet, out);
        }
    });
}

void expect_same_means(const Estimate& lights, const Estimate& paths, const char* what, double sharp, double bias) {
    for (int k = 0; k < 6; ++k) {
        const double error = std::hypot(lights.error[k], paths.error[k]);
        EXPECT_NEAR(lights.mean[k], paths.mean[k], 3.0 * error + bias * paths.mean[k]) << what << ", number " << k;
        if (k % 3 == 0 && paths.mean[k] > 0.0) {
            EXPECT_LT(error, sharp * paths.mean[k]) << what << ": not sampled enough";
            std::printf("%s, %s: paths %.5g +- %.2g %%, lights %.5g +- %.2g %%, %+.2f standard errors\n", what,
                        k == 0 ? "MM" : "SM", paths.mean[k], 100.0 * paths.error[k] / paths.mean[k], lights.mean[k],
                        100.0 * lights.error[k] / lights.mean[k], (lights.mean[k] - paths.mean[k]) / error);
        }
    }
}

double expect_same_light(const Stage& stage, const RayLightSettings& settings, const char* what,
                         std::uint64_t path_samples, std::uint64_t light_sets, double bias) {
    const Estimate paths = mean_by_paths(stage, path_samples);
    const auto make = [&](std::uint32_t seed) {
        RayLightSettings own = settings;
        own.seed = seed;
        return std::make_unique<RayLights>(stage.scene(), own, stage.bounces(), stage.receivers(16, seed));
    };
    const Estimate lights = mean_by_lights(stage, make, light_sets);
    expect_same_means(lights, paths, what, 0.05, bias);
    return lights.mean[0] / paths.mean[0] - 1.0;
}

Recipe coloured_ball(int nodes, float optical_radius, float mean_cosine) {
    Recipe r = glowing_ball(nodes, optical_radius);
    r.settings.smoke.albedo = Rgb(0.8f, 0.6f, 0.3f);
    r.settings.smoke.mean_cosine = mean_cosine;
    return r;
}

// Smoke in lumps of noise, with holes, and fire at one side only.
Recipe lumpy_ball(int nodes, float optical_radius, float mean_cosine) {
    Recipe r = coloured_ball(nodes, optical_radius, mean_cosine);
    const NodeScalar whole = r.density;
    r.density = [=](const ivec3& n) { return 2.5f * whole(n) * std::max(0.0f, noise(n >> 1, 1) - 0.35f); };
    r.flame = [=](const ivec3& n) { return n.x > 0 ? 3.0f * whole(n) * noise(n, 2) : 0.0f; };
    return r;
}

Scene floor_below(float colour) {
    Scene scene;
    add_quad(scene, {-4, -4, -1.2f}, {8, 0, 0}, {0, 8, 0}, lambert(colour));
    return scene;
}

}  // namespace brisance::testing
