// Emission along a whole line, and the next collision on it.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "tracking/medium_trackers.h"
#include "tracking/settings.h"

namespace brisance {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

struct LineResult {
    Rgb radiance{0.0f};                  // emission along the line, seen from its origin [W/(m^2 sr)]
    Rgb scattered{0.0f};                 // likewise of what the smoke scatters, where that is known
    std::optional<Collision> collision;  // the end of a free flight along the line
};

struct PassedVoxel {
    VoxelSegment segment;
    double begin_depth, end_depth;  // optical depth
};

// A ray of the camera and all voxels on it, to choose collisions from.
struct CameraLine {
    Rgb radiance{0.0f};
    std::vector<PassedVoxel> voxels;
    // The chance that a flight along the ray collides, 1 - T.
    double opacity() const { return voxels.empty() ? 0.0 : -std::expm1(-voxels.back().end_depth); }
    double transmittance() const { return voxels.empty() ? 1.0 : std::exp(-voxels.back().end_depth); }
};

// Lines end at `end` metres, where a surface is.
class LineTracker {
public:
    LineTracker(const TrackingField& field, const TracingSettings& settings);

    // A path's next segment: a free flight, which estimates the emission along the whole line by that before its end,
    // voxel by voxel, or at the null collisions where those are many. No collision: the ray escapes.
    LineResult follow_path(const Ray& ray, Rng& rng, double end = kNoEnd) const;

    // The same, with the emission along all of the line, and with the integral of transmittance times extinction times
    // `scattering` [W/(m^2 sr)]: what the smoke scatters if that is its source function. Russian roulette ends both
    // deep in the smoke.
    LineResult follow_lit(const Ray& ray, const CoarseField& scattering, Rng& rng, double end = kNoEnd) const;

    // The emission along the whole line. Russian roulette ends it deep in the smoke.
    Rgb follow_line(const Ray& ray, Rng& rng, double end = kNoEnd) const;

    // The emission along the whole line without roulette, and its voxels. `line` is overwritten; keep it for its
    // memory.
    void follow_camera(const Ray& ray, Rng& rng, CameraLine& line, double end = kNoEnd) const;

    // Of [0, end] [m], by the estimator that the settings name.
    double transmittance(const Ray& ray, double end, Rng& rng) const;

    // A collision forced to lie on the line, whose opacity must be above 0: `position` in [0, 1) inverts the
    // distribution of free flights that collide there.
    Collision choose(const CameraLine& line, double position) const;
    // The point of the voxel at that optical depth behind its entry.
    Collision choose_in(const PassedVoxel& voxel, double depth) const;

private:
    double end_of_fire(const LatticeRay& ray) const;
    Rgb radiance_by_estimates(const LatticeRay& ray, Rng& rng) const;

    const TrackingField& field_;
    TracingSettings settings_;
    dvec3 fire_low_{0.0}, fire_high_{0.0};  // box of all that burns, in nodes from the lattice's first node
};

}  // namespace brisance
