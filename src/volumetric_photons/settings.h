// Settings of volumetric photons: how many particles are traced, and how many make an estimate on a surface.
#pragma once

#include <cstdint>

namespace brisance {

struct VolumetricPhotonSettings {
    int paths = 2000000;         // particles that are followed
    int neighbours = 128;        // photons around a point of a surface that estimate the light arriving there
    float filter_radius = 0.0f;  // standard deviation of a Gaussian over the medium's nodes [voxels]; 0: not filtered
    std::uint32_t seed = 0;
};

}  // namespace brisance
