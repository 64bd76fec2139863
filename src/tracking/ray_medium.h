// The medium at points of a ray, and its optical depth along the ray.
#pragma once

#include <optional>
#include <vector>

#include "tracking/medium_trackers.h"
#include "tracking/segment.h"

namespace brisance {

struct Coefficients {
    float extinction = 0.0f;  // [1/m]
    Rgb scattering{0.0f};     // [1/m]
};

// Coefficients of the medium at points of one ray.
class RayProbe {
public:
    RayProbe(const TrackingField& field, const Ray& ray) : field_(&field), path_(field.enter(ray)) {}
    // The coefficients at a distance [m]; zero scattering outside the medium.
    Coefficients at(double t) const;
    // The point as a collision; none outside the medium.
    std::optional<Collision> collision_at(double t) const;

private:
    const TrackingField* field_;
    LatticeRay path_;
};

// A ray of the camera with all voxels on it. Its transmittance is known everywhere, and collisions of free flights can
// be sampled. Nothing beyond an optical depth of 64 contributes (e^-64 is below single precision).
class RayMedium {
public:
    // Overwrites the previous ray; reuse the object to keep its memory. `end`: of the ray [m], where a surface is.
    void look(const TrackingField& field, const Ray& ray, double end);

    bool empty() const { return voxels_.empty(); }
    // From the first to the last voxel with extinction.
    const Segment& segment() const { return segment_; }
    double begin() const { return begin_; }  // of the segment, from the ray's origin [m]
    double transmittance(double t) const;    // from the ray's origin to t along the segment
    Coefficients coefficients(double t) const { return probe_->at(begin_ + t); }
    // Its distance is from the ray's origin.
    std::optional<Collision> collision_at(double t) const { return probe_->collision_at(begin_ + t); }
    double opacity() const;                        // of the whole segment
    double sample_flight(double xi) const;         // t along the segment, of a flight that collides on it
    double pdf_of_flight(double t) const;          // [1/m]
    double distance_to_depth(double depth) const;  // t where that optical depth is reached, or the segment's length

private:
    struct Voxel {
        VoxelSegment segment;
        Cubic extinction;
        double begin_depth, end_depth;
    };
    const Voxel& voxel_at(double t) const;
    double depth_at(double t) const;

    std::vector<Voxel> voxels_;
    Segment segment_;
    double begin_ = 0.0;  // of the segment on the ray [m]
    std::optional<RayProbe> probe_;
};

}  // namespace brisance
