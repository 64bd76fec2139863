// How light from surfaces is gathered: where virtual lights lie, what they hold, and who is asked.
#pragma once

#include <cstdint>

namespace brisance {

enum class LightPlacement {
    BlueNoise,  // camera paths' second vertices, thinned out by weighted sample elimination
    Random,     // the same, any of them
    LightPaths  // any of the places where particles of light arrive: instant radiosity, as a baseline
};

// What a light is for those who ask; all are given light by the photons around them.
enum class VirtualLightKind {
    Patch,   // the surface itself, between lights interpolated
    Sphere,  // a ball with a kernel of fixed area and one ray for its visibility: rich virtual spherical lights
    Point    // a point with a bound on its geometric term: rich virtual point lights
};

enum class LightRadius {
    Adaptive,  // small where many camera paths arrive
    Uniform    // one for all
};

enum class LightSampling {
    Power,        // a light in proportion to its power per area, a direction toward it: the camera sees all about alike
    LightTree,    // a light by what it may send to the place, a direction toward it
    Bsdf,         // a ray by BSDF or phase function, and all lights where it arrives
    Combined,     // Power and Bsdf by the balance heuristic
    CombinedTree  // LightTree and Bsdf
};

struct VirtualLightSettings {
    int count = 12000;  // virtual lights; 0: none, all surface light is found by paths
    LightPlacement placement = LightPlacement::BlueNoise;
    VirtualLightKind kind =
        VirtualLightKind::Patch;         // the others are baselines: asked by Power or LightTree, without extension
    double point_bound = 100.0;          // Point: the greatest cosine over squared distance [1/m^2]; the rest is lost
    double candidates_per_pixel = 0.25;  // camera paths; never fewer than eight per light
    LightRadius radius = LightRadius::Adaptive;
    int neighbours = 128;         // candidates from whose distance their density is taken
    double radius_factor = 1.1;   // radius over the distance that a light would keep from others
    int photons = 1000000;        // particles from fire and emitters
    int profile_resolution = 16;  // of directions of lights that are not plain Lambert: texels along a side
    LightSampling sampling = LightSampling::Combined;
    bool extension = true;   // paths go on where a ray's footprint covers few lights
    double n_min = 40.0;     // lights in the footprint: with fewer the path goes on, ...
    double n_max = 80.0;     // ... with more it ends; between them it does both in part
    std::uint32_t seed = 0;  // other seeds draw other random numbers
};

}  // namespace brisance
