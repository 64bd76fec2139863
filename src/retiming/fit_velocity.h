// What a unit of velocity means, from how neighbouring frames do differ.
#pragma once

#include <string>
#include <vector>

#include "retiming/settings.h"
#include "retiming/source_frame.h"

namespace brisance {

// Two neighbouring frames of a sequence.
struct NeighbourFrames {
    int first_number = 0, second_number = 0;
    SourceFrame first, second;
};

struct VelocityFit {
    double metres_per_frame = 0.0;  // per unit of the file: the scale of VelocityUnit::Frame
    double voxel_metres = 0.0;      // of the velocity grid
    double low = 0.0, high = 0.0;   // quartiles of metres_per_frame among places
    double explained = 0.0;         // share of the squared difference of neighbours that motion explains
    std::vector<int> places;        // first frames
    std::string why_not;            // empty: the fit can be relied on

    double voxels_per_frame() const { return metres_per_frame / voxel_metres; }
    std::string nearest_unit(double frames_per_second) const;  // in words, or that it is none
    std::string describe(double frames_per_second) const;      // one line: value, spread, what it explains
};

constexpr double kLeastExplained = 0.2;  // of a fit that can be relied on
constexpr double kWidestSpread = 1.6;    // ratio of the quartiles of the places' scales, likewise

// The scale for which the first frame's field of role `role`, moved along the velocity, is nearest to the second's, and
// the second's, moved back, nearest to the first's, in the sum of squares over some nodes of a place; the median of the
// places. What counts as explained is what is nearer than without motion and than with motion the other way, since
// blurring a field by random motion brings it nearer, too. The same for any number of threads.
VelocityFit fit_velocity(const std::vector<NeighbourFrames>& places, std::size_t role);

}  // namespace brisance
