// Small media, with and without a floor, and both ways to see them: by virtual lights in the smoke and by paths.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "fixtures/estimate.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "ray_lights/ray_lights.h"
#include "reference/path_tracer.h"

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
    Twice by_lights(const InScattering& lights, const Ray& ray, Rng& rng, bool all = false) const;
    // What stands for rays like these.
    std::vector<LightReceiver> receivers(int rays, std::uint64_t key) const;
    // New lights, for such rays.
    RayLights lights(const RayLightSettings& settings, int rays, std::uint64_t key) const;
    int bounces() const { return bounces_; }
    // A ray of the family that is compared: from above, somewhere through the ball of radius 1 m around the origin.
    Ray ray(Rng& rng) const;

private:
    std::unique_ptr<Medium> medium_;
    std::unique_ptr<Surroundings> surroundings_;
    PathTracer tracer_;
    int bounces_;
};

// MM and SM, three channels each, over the family of rays.
Estimate mean_by_paths(const Stage& stage, std::uint64_t samples);
// `make`: lights of that seed. A sample is a set of lights, as rays that ask the same ones are not independent.
using MakeLights = std::function<std::unique_ptr<InScattering>(std::uint32_t seed)>;
Estimate mean_by_lights(const Stage& stage, const MakeLights& make, std::uint64_t sets);

// The same mean of both, within three standard errors and a relative bias that is allowed, for all six; a standard
// error is below the part `sharp` of the mean.
void expect_same_means(const Estimate& lights, const Estimate& paths, const char* what, double sharp = 0.05,
                       double bias = 0.0);
// Gives the relative difference of the first of MM.
double expect_same_light(const Stage& stage, const RayLightSettings& settings, const char* what,
                         std::uint64_t path_samples = 400, std::uint64_t light_sets = 1, double bias = 0.0);

// Glowing balls of radius 1 m around the origin, `nodes` nodes to a radius.
Recipe coloured_ball(int nodes, float optical_radius, float mean_cosine);
Recipe lumpy_ball(int nodes, float optical_radius, float mean_cosine);
Scene floor_below(float colour);

}  // namespace brisance::testing
