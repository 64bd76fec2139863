// Small media, with and without a floor, and both ways to see them: by ray lights and by paths.
#pragma once

#include <memory>
#include <vector>

#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "ray_lights/ray_lights.h"
#include "tracing/estimate.h"
#include "tracing/path_tracer.h"

namespace brisance::testing {

// MM and SM.
struct Twice {
    Rgb medium{0.0f}, surface{0.0f};
};

// A medium and what is around it, which keep their places.
class Stage {
public:
    Stage(const Recipe& recipe, Scene scene, std::vector<LightSettings> lights = {}, int bounces = -1);

    const DirectLight& scene() const { return tracer_.direct(); }
    Twice by_paths(const Ray& ray, double place, Rng& rng) const;
    Twice by_lights(const RayLights& lights, const Ray& ray, Rng& rng, bool all = false) const;
    // New lights, for rays like these.
    RayLights lights(const RayLightSettings& settings, int rays, std::uint64_t key) const;
    // A ray of the family that is compared: from above, somewhere through the ball of radius 1 m around the origin.
    Ray ray(Rng& rng) const;

private:
    std::unique_ptr<Medium> medium_;
    std::unique_ptr<Surroundings> surroundings_;
    PathTracer tracer_;
    int bounces_;
};

// The same mean of both, within three standard errors and a relative bias that is allowed, for the three channels of MM
// and SM. Gives the relative difference of the first of MM.
double expect_same_light(const Stage& stage, const RayLightSettings& settings, const char* what,
                         std::uint64_t path_samples = 400, std::uint64_t light_sets = 1, double bias = 0.0);

// Glowing balls of radius 1 m around the origin, `nodes` nodes to a radius.
Recipe coloured_ball(int nodes, float optical_radius, float mean_cosine);
Recipe lumpy_ball(int nodes, float optical_radius, float mean_cosine);
Scene floor_below(float colour);

}  // namespace brisance::testing
