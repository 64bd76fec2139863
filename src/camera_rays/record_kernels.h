// The vector kernel of camera rays: adds what parts of a ray in one brick show, records as a whole.
#pragma once

#include <cstddef>

#include "camera_rays/source_field.h"

namespace brisance {

// A ray in a brick, and the brick's records (SourceField).
struct RayInBrick {
    const SourceRecord* own;
    const SurroundingsRecord* outside;  // null: the surroundings send no light
    vec3 start;                         // where it enters, in nodes from the brick's first node
    vec3 per_metre;                     // nodes
    float distance;                     // of that from the ray's origin [m]
};

// A part of it inside one voxel. Its light is that of its middle, unless it splits.
struct RayPart {
    float along, length;  // of its middle from where the ray enters the brick, and of the part [m]
    bool splits;          // into halves, whose light is that of two Gauss points: its optical depth is exact then
};

// What the parts of a ray show, from its near end.
struct RecordSums {
    float transmittance = 1.0f, depth = 0.0f;
    float opacity = 0.0f, distance = 0.0f;  // gathered, and times the distance along the ray [m]
    // Records, each times its part's opacity, ...
    alignas(64) float own[SourceRecord::Size] = {};
    alignas(64) float outside[SurroundingsRecord::Size] = {};
    // ... and times the integral of transmittance along it [m], where that is asked for.
    alignas(64) float emitted[SourceRecord::Size] = {};
};

// Extinction and source are constant on every part, or on the halves of one that splits. They are integrated in closed
// form with phi1. `emits`: RecordSums::emitted is wanted. Returns whether what lies behind can be seen; the parts that
// it cannot are left out.
bool add_parts(const RayInBrick& ray, bool emits, const RayPart* parts, std::size_t count, RecordSums& sums);

}  // namespace brisance
