// What of a light reaches the picture, estimated at points that camera paths see.
#pragma once

#include <vector>

#include "virtual_lights/placement/placement.h"

namespace brisance {

// Radiance that a vertex scatters of a deposit's light (light_of_deposit()), as a virtual point light with
// settings.point_bound, by a shadow ray [W/(m^2 sr)].
Rgb from_deposit(const DirectLight& scene, const VirtualLightSettings& settings, const PathVertex& vertex,
                 const VirtualLight& light, Rng& rng);

class CameraReceivers {
public:
    // Vertices of camera paths that are no mirrors: of surfaces, or in smoke. Keeps a reference to the scene.
    explicit CameraReceivers(const PlacementInput& input);

    // The mean luminance of a pixel that the light of a deposit adds [W/(m^2 sr)], if that became a virtual point light
    // (with settings.point_bound): at a few receivers, with shadow rays. An estimate without bias.
    double contribution(const Deposit& deposit, Rng& rng) const;
    // Of all deposits, in their order. Random numbers are those of a deposit's number.
    std::vector<double> contributions(const std::vector<Deposit>& deposits, Stream stream) const;

private:
    struct Receiver {
        PathVertex vertex;
        Rgb throughput;  // from the camera
    };

    const DirectLight& scene_;
    VirtualLightSettings settings_;
    std::vector<Receiver> receivers_;
    double found_ = 0.0;  // of all camera paths
};

}  // namespace brisance
