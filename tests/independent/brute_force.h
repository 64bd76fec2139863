// Radiance along rays by plain Monte Carlo, to validate the path tracer.
//
// The path tracer shares its particle walk, its path step, its sampling and its geometry with the methods that it
// judges, so an error in one of them could pass unnoticed. This estimator shares none of that code. It reads the node
// arrays of a Medium and does the rest itself, slowly: delta tracking against one majorant (Woodcock et al. 1965),
// emission counted at every tentative collision, scattering by the Henyey-Greenstein phase function, parallelograms
// that reflect as Lambert's law says. Light that paths can hit by chance is found by chance alone; lamps without extent
// are sampled directly, through ratio-tracked transmittance (Novak et al. 2014).
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "smoke_box.h"

namespace brisance::independent {

using Random = std::mt19937_64;

// A parallelogram. Both sides reflect; the front emits, the side toward which cross(u, v) points.
struct Quad {
    dvec3 corner{0.0}, u{0.0}, v{0.0};  // world [m]
    dvec3 reflectance{0.0};             // [1]
    dvec3 emission{0.0};                // radiance [W/(m^2 sr)]
};

// A lamp without extent. A spot has its full intensity within the inner half angle around the axis and none beyond the
// outer one; between them it falls as glTF's KHR_lights_punctual says.
struct Lamp {
    dvec3 position{0.0};   // world [m]
    dvec3 intensity{0.0};  // [W/sr]
    bool spot = false;
    dvec3 axis{0.0, 0.0, -1.0};  // unit
    double inner_degrees = 30.0, outer_degrees = 45.0;
};

struct World {
    SmokeBox smoke;
    std::vector<Quad> quads;
    std::vector<Lamp> lamps;
};

struct Line {
    dvec3 origin{0.0};     // world [m]
    dvec3 direction{0.0};  // unit
};

// One sample of the radiance [W/(m^2 sr)] that arrives against the line's direction. `most_scatterings`: of a path; -1:
// no limit.
dvec3 sample_radiance(const World& world, Line line, int most_scatterings, Random& random);

// Uniform in [0, 1).
double uniform(Random& random);

// Per solid angle [1/sr], and a sample of it; cosines are between the directions of travel.
double phase_function(double cosine, double mean_cosine);
dvec3 sample_phase_function(const dvec3& direction, double mean_cosine, Random& random);

// Rays from one point to a parallelogram, uniform over its area.
struct View {
    dvec3 eye{0.0};
    dvec3 corner{0.0}, u{0.0}, v{0.0};
    Line line(double x, double y) const;
};

// Mean radiance of a view, and its standard error, from independent batches with a generator each.
struct Mean {
    dvec3 value{0.0}, error{0.0};
};
Mean measure(const World& world, const View& view, std::uint64_t paths, std::uint64_t seed, int most_scatterings = -1);

}  // namespace brisance::independent
