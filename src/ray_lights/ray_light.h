// A virtual ray light: a flight of a particle through the medium, or a piece of one, whose light scatters all along it.
#pragma once

#include "tracing/pair_sampling.h"

namespace brisance {

struct RayLight {
    Segment segment;
    Rgb power{0.0f};          // that arrives at its start, over the number of particles [W]
    bool from_smoke = false;  // its particle set out where it had collided
    bool dimmed = false;      // of a long flight: what arrives at v passed the smoke from the start to there
    double extinction = 0.0;  // mean along it [1/m]
    double scattered = 0.0;   // luminance [W] that scatters along it, about: the optical depth times its power
    double radius = 0.0;      // of a beam [m] (beam.h)
};

// Who is lit: a ray of the camera through the medium, or a point of a surface.
struct RayLightReceiver {
    bool is_ray = true;
    Segment ray;  // the part that is mostly seen
    dvec3 point{0.0}, normal{0.0};
    static RayLightReceiver along(const Segment& seen) { return {true, seen, {}, {}}; }
    // A point of the medium that is seen along `direction` (unit). `short_way`: against all it sees [m].
    static RayLightReceiver in_smoke(const dvec3& point, const dvec3& direction, double short_way) {
        return along({point, direction, short_way});
    }
    static RayLightReceiver at(const dvec3& point, const dvec3& normal) { return {false, {}, point, normal}; }
};

}  // namespace brisance
