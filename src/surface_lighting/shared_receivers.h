// Receivers that a pixel's surface samples share. What arrives past no surface changes slowly from place to place, as
// the distance from the smoke does: samples that lie close together and face the same way ask once, from their middle.
// What they find is right to the second order of how far they are apart.
#pragma once

#include <cstdint>
#include <vector>

#include "medium/lattice/local_bounds.h"
#include "medium_lighting/medium_lighting.h"

namespace brisance {

class SharedReceivers {
public:
    explicit SharedReceivers(const Medium& medium) : bounds_(local_bounds(medium)), voxel_(medium.spacing) {}

    // A sample after those before it; samples of one pixel come one after another. `normal`: unit.
    void add(std::uint32_t pixel, const vec3& local, const vec3& normal);
    // To be lit, once all samples are there.
    std::vector<SurfaceReceiver>& receivers();
    const SurfaceReceiver& of_sample(std::size_t sample) const { return receivers_[receiver_of_[sample]]; }

private:
    struct Group {
        vec3 first, facing;  // its first sample
        float reach;         // of others from there [m]
        int samples;
    };
    float reach_at(const vec3& local) const;

    LocalBounds bounds_;
    float voxel_;
    std::uint32_t pixel_ = 0;
    std::size_t first_of_pixel_ = 0;
    std::vector<Group> groups_;
    std::vector<SurfaceReceiver> receivers_;  // of each group: sums, until all samples are there
    std::vector<std::uint32_t> receiver_of_;
};

}  // namespace brisance
