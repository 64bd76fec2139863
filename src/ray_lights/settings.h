// Virtual ray lights: how many, how many of them a camera ray asks, and how thick they are.
#pragma once

#include <cstdint>

namespace brisance {

enum class RayLength {
    Short,  // to the particle's next collision: shines alike all along
    Long    // to the end of the medium or a surface, dimmed by the smoke on the way: less noise per light, dearer
};

struct RayLightSettings {
    int paths = 16384;   // particles that are followed
    int count = 131072;  // pieces of rays that are kept, on average
    int samples = 4;     // lights that a camera ray, or a point of a surface, asks
    RayLength length = RayLength::Short;
    std::uint32_t seed = 0;
    double radius = 0.0;            // of the first pass [m]; 0: rays, without bias; above: beams (beam.h)
    int passes = 1;                 // pictures that are averaged, each with lights of its own
    double radius_reduction = 0.7;  // alpha of radius_shrunk(): near 1 the radius stays
};

// Of RayLightSettings::radius: from the lights of the first pass, RayLights::radius().
constexpr double kAutomaticRadius = -1.0;

}  // namespace brisance
