// A floor, a wall, a fire, lamps and virtual lights, lit by each kind of light by itself and by all together.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fire_lights/sampled_fire.h"
#include "fixtures/instant_radiosity.h"
#include "fixtures/ray_fixture.h"
#include "unified_lights/unified_lights.h"

namespace brisance::testing {

constexpr double kPointBound = 1.0;  // [1/m^2]

// A floor and a wall beside a fire of some hundred voxels, in thin smoke.
inline Recipe small_fire(float brightness) {
    Recipe r = lumpy_ball(6, 1.0f, 0.3f);
    const NodeScalar whole = r.flame;
    r.flame = [whole, brightness](const ivec3& n) { return n.y < 1 && n.z < 2 ? brightness * whole(n) : 0.0f; };
    return r;
}

inline Scene floor_and_wall(float gloss) {
    Scene set;
    SceneMaterial floor = lambert(0.6f);
    if (gloss > 0.0f) {
        floor.surface.specular = gloss;
        floor.surface.roughness = 0.4f;
    }
    add_quad(set, {-4, -4, -1.6f}, {8, 0, 0}, {0, 8, 0}, floor);
    add_quad(set, {-4, 2.5f, -1.6f}, {8, 0, 0}, {0, 0, 3}, lambert(0.5f));
    return set;
}

// A ceiling of n by n quads that emit, 4 m wide.
inline void add_ceiling(Scene& set, int n, float radiance) {
    const float side = 4.0f / float(n);
    for (int i = 0; i < n * n; ++i)
        add_quad(set, {side * float(i % n) - 2.0f, side * float(i / n) - 2.0f, 3.0f}, {0, 0.9f * side, 0},
                 {0.9f * side, 0, 0}, emitting(Rgb(radiance)));
}

inline std::vector<LightSettings> lamp_sun_and_sky() {
    LightSettings lamp, sun, sky;
    lamp.position = {1.5, -1.0, 1.0};
    lamp.power = Rgb(0.6f, 0.4f, 0.3f);
    sun.kind = LightKind::Sun;
    sun.direction = {0.5, 0.3, -1.0};
    sun.angle_degrees = 3.0;
    sun.power = Rgb(0.2f, 0.3f, 0.5f);
    sky.kind = LightKind::Environment;
    sky.power = Rgb(0.1f, 0.15f, 0.2f);
    return {lamp, sun, sky};
}

// Of what `draw` gives, which is called with the numbers from 0 to times - 1: over the square of its mean.
template <class Draw>
double relative_variance(int times, const Draw& draw) {
    double sum = 0.0, square = 0.0;
    for (int i = 0; i < times; ++i) {
        const double x = draw(std::uint64_t(i));
        sum += x / times;
        square += x * x / times;
    }
    return square / (sum * sum) - 1.0;
}

// The lights of instant radiosity, the rays of a camera that looks down on the floor.
struct LitSet {
    explicit LitSet(const Recipe& recipe, Scene set, std::vector<LightSettings> lamps = {}, int virtual_count = 40)
        : stage(recipe, std::move(set), std::move(lamps), 1) {
        VirtualLightSettings s = instant_radiosity("point", virtual_count, 4000);
        s.point_bound = kPointBound;
        s.sampling = "all";
        const PixelCamera camera{16, 16, [this](double x, double y) { return ray({x, y, 0.0}); }, 1024.0};
        lights = std::make_unique<VirtualLights>(stage.scene(), camera, s);
    }

    Ray ray(const dvec3& u) const { return {{3.0 * u.x - 1.5, 3.0 * u.y - 1.5, -1.55}, {0.0, 0.0, -1.0}}; }
    PathVertex vertex(const dvec3& u) const {
        const Ray r = ray(u);
        return {*stage.scene().segment_along(r).point, r.direction};
    }
    PathVertex base(const dvec3& u) const {
        const Ray r = ray(u);
        const SurfacePoint point = *stage.scene().segment_along(r).point;
        return {point, Bsdf(point.material, point.frame, Lobes::Base), r.direction};
    }

    // SA by a ray by BSDF, of the two techniques.
    Rgb by_ray(const PathVertex& vertex, Rng& rng) const {
        const auto turn = vertex.sample(rng);
        if (!turn)
            return Rgb(0.0f);
        const RaySegment segment = stage.scene().segment_along(vertex.leaving(turn->wi));
        return turn->weight * stage.scene().at_end(segment, turn->pdf, turn->delta, &vertex) *
               float(stage.scene().lines().transmittance(segment.ray, segment.end, rng));
    }

    // Luminance of SS by all virtual lights, SV of the base by a tree of the fire alone, SA as without unified lights.
    Estimate apart(double relative) const {
        const SampledFire fire(stage.scene(), *find_fire_light_sampling("stochastic_lightcuts"), {});
        return estimate_to(relative, 3, [&](const dvec3& u, Rng& rng, double* out) {
            const PathVertex v = vertex(u);
            out[0] = luminance(lights->shade(v, rng));
            out[1] = luminance(fire.on_surface(base(u), rng));
            out[2] = luminance(stage.scene().from_emitters(v, rng) + by_ray(v, rng));
        });
    }

    UnifiedLights unified(const std::string& sampling, const UnifiedLightSettings& settings,
                          const CellSet& cells = {Cell::SS, Cell::SV, Cell::SA}) const {
        return {stage.scene(), stage.scene(), lights.get(), kPointBound, cells, *find_unified_light_sampling(sampling),
                settings};
    }

    Estimate together(const UnifiedLights& unified, double relative) const {
        VirtualLights::Shading how;
        how.lights_apart = true;
        return estimate_to(relative, 3, [&](const dvec3& u, Rng& rng, double* out) {
            const PathVertex v = vertex(u), b = base(u);
            const LightBySender light = unified.at({v, &b}, rng);
            out[0] = luminance(light.surfaces + lights->shade(v, rng, how));
            out[1] = luminance(light.fire);
            out[2] = luminance(light.emitters + by_ray(v, rng));
        });
    }

    Stage stage;
    std::unique_ptr<VirtualLights> lights;
};

}  // namespace brisance::testing
