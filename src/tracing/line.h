// Emission along a whole line, and the next collision on it.
#pragma once

#include <optional>

#include "tracing/settings.h"
#include "tracing/trackers.h"

namespace brisance {

struct LineResult {
    Rgb radiance{0.0f};                  // what glows along the line, seen from its origin [W/(m^2 sr)]
    std::optional<Collision> collision;  // where a path along the line collides next
    double weight = 1.0;                 // of what follows from the collision
};

class LineTracker {
public:
    LineTracker(const TrackingField& field, const TracingSettings& settings);

    // For rays inside the path: radiance exact near the origin and followed with Russian roulette deeper in the smoke;
    // the collision is that of an analog flight, and absent when the ray escapes.
    LineResult follow(const Ray& ray, bool with_collision, Rng& rng) const;

    // For the camera's rays: the whole line, and a collision that is forced to happen on it, `place` in [0, 1) of the
    // way through its distribution; its weight is the chance 1 - T.
    LineResult follow_camera(const Ray& ray, double place, Rng& rng) const;

private:
    double end_of_fire(const LatticeRay& ray) const;
    Rgb radiance_by_estimates(const LatticeRay& ray, Rng& rng) const;

    const TrackingField& field_;
    TracingSettings settings_;
    dvec3 fire_low_{0.0}, fire_high_{0.0};  // box of all that burns, in nodes from the lattice's first node
};

}  // namespace brisance
