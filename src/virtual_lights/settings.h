// How light from surfaces is gathered: where virtual lights lie, what they hold, and who is asked.
#pragma once

#include <cstdint>

namespace brisance {

enum class LightPlacement {
    BlueNoise,         // camera paths' second vertices, thinned out by weighted sample elimination
    Random,            // the same, any of them
    LightPaths,        // any of the places where particles of light arrive: instant radiosity, as a baseline
    RelaxedLightPaths  // those of them where the camera may see their work, thinned out: rich virtual lights' places
};

// Whose light a light holds.
enum class LightFlux {
    Gathered,  // of all photons around it: rich lights
    Own        // of the one that arrived where it lies: plain virtual point and spherical lights
};

// What a light is for those who ask.
enum class VirtualLightKind {
    Patch,   // the surface itself, between lights interpolated
    Sphere,  // a ball with a kernel of fixed area and one ray for its visibility: virtual spherical lights
    Point    // a point with a bound on its geometric term: virtual point lights
};

enum class LightRadius {
    Adaptive,  // small where many camera paths arrive
    Uniform    // one for all
};

enum class LightSampling {
    Power,         // a light by its power and what the camera sees of it (light_sampler.h), a direction toward it
    LightTree,     // a light by what it may send to the place, a direction toward it
    Bsdf,          // a ray by BSDF or phase function, and all lights where it arrives
    Combined,      // Power and Bsdf by the balance heuristic
    CombinedTree,  // LightTree and Bsdf
    Resampled,     // of several by power one, by what it would send if nothing stood between: ReSTIR without reuse
    All            // every light: no noise of choice, at a price
};

struct VirtualLightSettings {
    int count = 12000;  // virtual lights; 0: none, all surface light is found by paths
    LightPlacement placement = LightPlacement::BlueNoise;
    LightFlux flux = LightFlux::Gathered;  // Own: with LightPaths alone, about `count` lights; not a Patch
    VirtualLightKind kind =
        VirtualLightKind::Patch;         // the others are baselines: no ray finds them, and paths are not extended
    double point_bound = 100.0;          // Point: the greatest cosine over squared distance [1/m^2]; the rest is lost
    int sphere_neighbours = 10;          // Sphere: its radius is the distance to the light that is this near
    int sphere_samples = 4;              // Sphere: directions into one that is asked
    double candidates_per_pixel = 0.25;  // camera paths; never fewer than eight per light
    LightRadius radius = LightRadius::Adaptive;
    int neighbours = 128;         // candidates from whose distance their density is taken
    double radius_factor = 1.1;   // radius over the distance that a light would keep from others
    int photons = 1000000;        // particles from fire and emitters; 0: no lights
    int profile_resolution = 16;  // of directions of lights that are not plain Lambert: texels along a side
    LightSampling sampling = LightSampling::Combined;
    int resampling_candidates = 32;  // Resampled: lights to choose from
    bool extension = true;           // paths go on where a ray's footprint covers few lights
    double n_min = 40.0;             // lights in the footprint: with fewer the path goes on, ...
    double n_max = 80.0;             // ... with more it ends; between them it does both in part
    std::uint32_t seed = 0;          // other seeds draw other random numbers
};

}  // namespace brisance
