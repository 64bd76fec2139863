// Virtual ray lights: how many, and how many of them a camera ray asks.
#pragma once

#include <cstdint>

namespace brisance {

// Who owns light that was scattered in the medium before its last scattering: MM and SM.
enum class ScatteringMethod { LightingGrid, RayLights, PointLights };
constexpr const char* name_of(ScatteringMethod method) {
    constexpr const char* kNames[] = {"lighting_grid", "ray_lights", "point_lights"};
    return kNames[static_cast<int>(method)];
}

enum class RayLength {
    Short,  // to the particle's next collision: shines alike all along
    Long    // to the end of the medium or a surface, dimmed by the smoke on the way: less noise per light, dearer
};

struct RayLightSettings {
    ScatteringMethod method = ScatteringMethod::LightingGrid;
    int paths = 16384;   // particles that are followed
    int count = 131072;  // pieces of rays that are kept, on average
    int samples = 4;     // lights that a camera ray, or a point of a surface, asks
    RayLength length = RayLength::Short;
    std::uint32_t seed = 0;
};

}  // namespace brisance
