// Rooms of a few quads, with a camera inside.
#pragma once

#include <memory>
#include <string>

#include "fixtures/estimate.h"
#include "reference/path_tracer.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance::testing {

QuickMaterial lambert(const Rgb& colour);
QuickMaterial rough_metal(const Rgb& colour, float roughness);

// The inner side of the box from `low` to `high`, all walls of one material; their fronts look inward.
void add_walls(SceneSettings& scene, const dvec3& low, const dvec3& high, const QuickMaterial& material);
// The outer side of a box.
void add_block(SceneSettings& scene, const dvec3& low, const dvec3& high, const QuickMaterial& material);
void add_lamp(SceneSettings& scene, const dvec3& low, const dvec3& high, double height, const Rgb& radiance);

// A cube of 2 m with a red and a green wall, a lamp under its ceiling and a block on its floor.
SceneSettings coloured_room();
SceneSettings glossy_room();  // the same with a floor of rough metal

struct Room {
    explicit Room(const SceneSettings& settings, Medium m = {});
    Room(const Room&) = delete;
    Room& operator=(const Room&) = delete;

    // From the middle of the front wall through the whole room; 64 x 64 pixels.
    Ray ray(double x, double y) const;
    PixelCamera camera() const;
    VirtualLights lights(const VirtualLightSettings& settings) const;

    // The radiance in the cell SS along one camera ray through [0, 1]^2, by virtual lights or the path tracer.
    Rgb by_lights(const VirtualLights& lights, double x, double y, Rng& rng) const;
    Rgb by_paths(double x, double y, Rng& rng, Cell cell = Cell::SS) const;
    // The cell MS: a collision is forced on the ray.
    Rgb in_smoke_by_lights(const VirtualLights& lights, double x, double y, Rng& rng) const;

    Medium medium;
    dvec3 origin;  // of local space, world [m]
    Surroundings surroundings;
    DirectLight direct;
    PathTracer tracer;
};

// Smoke in a ball of 0.45 m around a point of the room, which glows with source function `glow` (or not, for 0).
Medium smoke_ball(const dvec3& centre, float density, const Rgb& albedo, float glow);

// Few lights and photons, for tests that compare with each other.
VirtualLightSettings few_lights();
// The same without path extension, gathered and of a kind as named.
VirtualLightSettings sampled_by(const std::string& sampling, const std::string& kind);
// Those that photons place, each with its own flux.
VirtualLightSettings of_photons(const std::string& kind, const std::string& sampling = "power");

}  // namespace brisance::testing
