// Receivers shared by surface samples of one pixel. Unoccluded irradiance changes slowly with position, on the scale of
// the distance from the smoke. Samples that lie close together and have nearly the same normal therefore share one
// receiver at their mean position. The error is of second order in their distance.
#pragma once

#include <cstdint>
#include <vector>

#include "medium/lattice/local_bounds.h"
#include "medium_lighting/medium_lighting.h"

namespace brisance {

class SharedReceivers {
public:
    explicit SharedReceivers(const Medium& medium) : bounds_(local_bounds(medium)), voxel_(medium.spacing) {}

    // Adds the next sample; samples of one pixel must be consecutive. `normal`: unit.
    void add(std::uint32_t pixel, const vec3& local, const vec3& normal);
    // The receivers to light, to be called after all samples are added.
    std::vector<SurfaceReceiver>& receivers();
    std::size_t count() const { return receivers_.size(); }
    const SurfaceReceiver& operator[](std::size_t receiver) const { return receivers_[receiver]; }
    const std::vector<std::uint32_t>& receiver_of() const { return receiver_of_; }  // of each sample

private:
    struct Group {
        vec3 first, facing;  // of its first sample
        float reach;         // largest distance of other samples from it [m]
        int samples;
    };
    float reach_at(const vec3& local) const;

    LocalBounds bounds_;
    float voxel_;
    std::uint32_t pixel_ = 0;
    std::size_t first_of_pixel_ = 0;
    std::vector<Group> groups_;
    std::vector<SurfaceReceiver> receivers_;  // of each group: sums, until all samples are added
    std::vector<std::uint32_t> receiver_of_;
};

}  // namespace brisance
