// Settings of virtual ray lights: their number, how many are evaluated per camera ray, and their radius.
#pragma once

#include <cstdint>

namespace brisance {

enum class RayLength {
    Short,  // to the particle's next collision: uniform along its length
    Long    // to the end of the medium or a surface, attenuated by the smoke: less noise per light, more time
};

// How points on ray lights are drawn (pair_sampling.h).
enum class RaySampling {
    ClosedForm,  // by densities that are inverted in closed form
    Tabulated    // by tables of the integrand that are made for each pair
};

struct RayLightSettings {
    int paths = 16384;                 // particles that are followed
    int count = 131072;                // mean number of pieces of rays that are kept
    bool roulette_visibility = false;  // what surfaces hide from the camera's rays is kept less often
    int samples = 4;                   // lights evaluated per camera ray and per point of a surface
    RayLength length = RayLength::Short;
    RaySampling sampling = RaySampling::ClosedForm;
    std::uint32_t seed = 0;
    double radius = 0.0;            // of the first pass [m]; 0: rays, without bias; above: beams (beam.h)
    int passes = 1;                 // pictures that are averaged, each with lights of its own
    double radius_reduction = 0.7;  // alpha of radius_shrunk(): near 1 the radius stays
};

// A value of RayLightSettings::radius: the radius is derived from the lights of the first pass, see
// RayLights::radius().
constexpr double kAutomaticRadius = -1.0;

}  // namespace brisance
