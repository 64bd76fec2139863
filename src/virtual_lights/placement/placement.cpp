#include "virtual_lights/placement/placement.h"

#include <algorithm>
#include <cmath>

#include "virtual_lights/placement/reject_unimportant.h"

namespace brisance {

namespace {

// Fewer deposits than this per light leave elimination little to choose from.
constexpr double kLeastDeposits = 8.0;
// Light paths per light, of whose deposits those near the camera's are kept.
constexpr double kPathsToReject = 32.0;
constexpr std::size_t kPilotPaths = 4096;

std::vector<Deposit> along_light_paths(const PlacementInput& input, double paths_per_light) {
    const VirtualLightSettings& s = input.settings;
    return photon_arrivals(input.scene, static_cast<std::size_t>(paths_per_light * s.count), Stream::LightCandidate,
                           s.seed)
        .arrivals;
}

// Light paths that meet surfaces `count` times, about.
std::size_t paths_for(const DirectLight& scene, int count, std::uint32_t seed) {
    const std::size_t met = photon_arrivals(scene, kPilotPaths, Stream::LightCandidate, seed).arrivals.size();
    if (met == 0)
        return 0;
    return static_cast<std::size_t>(std::ceil(double(count) * double(kPilotPaths) / double(met)));
}

}  // namespace

std::vector<Deposit> camera_deposits(const PlacementInput& input) {
    const VirtualLightSettings& s = input.settings;
    if (input.cameras.empty())
        return {};
    const PixelCamera& camera = input.cameras.front();
    const double paths = std::max(s.candidates_per_pixel * camera.width * camera.height, kLeastDeposits * s.count);
    return light_candidates(input.scene, input.cameras, static_cast<std::size_t>(paths), s.seed);
}

std::vector<Deposit> light_path_deposits(const PlacementInput& input) {
    return along_light_paths(input, kLeastDeposits);
}

std::vector<Deposit> relaxed_light_path_deposits(const PlacementInput& input) {
    const auto target = static_cast<std::size_t>(kLeastDeposits * input.settings.count);
    return reject_unimportant(along_light_paths(input, kPathsToReject), camera_deposits(input), target,
                              input.settings.seed);
}

PhotonArrivals light_path_flux(const PlacementInput& input) {
    const VirtualLightSettings& s = input.settings;
    return photon_arrivals(input.scene, paths_for(input.scene, s.count, s.seed), Stream::Photon, s.seed);
}

double power_per_area(const VirtualLight& light) {
    return light.held * light.share * light.power / light.area;
}

double power_alone(const VirtualLight& light) {
    return light.held * light.power;
}

double equal_importance(const VirtualLight& light) {
    return light.power > 0.0 ? light.share : 0.0;
}

}  // namespace brisance
