// Light that smoke scattered, counted along the tracks of particles: how many, and how many of them make an estimate.
#pragma once

#include <cstdint>

namespace brisance {

struct VolumetricPhotonSettings {
    int paths = 2000000;   // particles that are followed
    int neighbours = 128;  // of them that land around a point of a surface tell how much arrives there
    std::uint32_t seed = 0;
};

}  // namespace brisance
