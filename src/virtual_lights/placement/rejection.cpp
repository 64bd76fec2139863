#include "virtual_lights/placement/rejection.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "virtual_lights/placement/camera_receivers.h"

namespace brisance {

namespace {

constexpr Stream kRejectionPilot = stream_of("virtual_lights/rejection/pilot");
constexpr Stream kRejectionPilotReceivers = stream_of("virtual_lights/rejection/pilot_receivers");
constexpr Stream kRejectionReceivers = stream_of("virtual_lights/rejection/receivers");
constexpr Stream kRejectionChance = stream_of("virtual_lights/rejection/chance");
constexpr Stream kRejectionPositions = stream_of("virtual_lights/rejection/positions");
constexpr double kMostPathsPerLight = 256.0;
constexpr double kSurvivorsPerLight = 2.0;

// What a pilot says of one light path; contributions are those of a deposit's power times the number of paths.
struct RejectionPilot {
    double mean = 0.0;       // contribution of a deposit
    double survivors = 0.0;  // of a path
};

RejectionPilot rejection_pilot(const PlacementInput& input, const CameraReceivers& receivers) {
    const std::size_t paths = std::clamp<std::size_t>(static_cast<std::size_t>(input.settings.count), 512, 4096);
    const auto arrivals = photon_arrivals(input.scene, paths, kRejectionPilot, input.settings.seed).arrivals;
    std::vector<double> contribution = receivers.contributions(arrivals, kRejectionPilotReceivers);
    if (contribution.empty())
        return {};
    RejectionPilot out;
    for (double& c : contribution)
        c *= double(paths);
    out.mean = std::accumulate(contribution.begin(), contribution.end(), 0.0) / double(arrivals.size());
    for (const double c : contribution)
        out.survivors += survival_probability(c, out.mean, input.settings.importance_floor) / double(paths);
    return out;
}

// `stream`: of the light paths. Lights that photons find later must not lie where those photons are.
PhotonArrivals survivors(const PlacementInput& input, double count, Stream stream) {
    const CameraReceivers receivers(input);
    const RejectionPilot pilot = rejection_pilot(input, receivers);
    if (!(pilot.survivors > 0.0))
        return {};
    const VirtualLightSettings& s = input.settings;
    const double paths = std::ceil(std::min(count / pilot.survivors, kMostPathsPerLight * count));
    PhotonArrivals all = photon_arrivals(input.scene, static_cast<std::size_t>(paths), stream, s.seed);
    const std::vector<double> contribution = receivers.contributions(all.arrivals, kRejectionReceivers);
    std::vector<Deposit> kept;
    for (std::size_t i = 0; i < all.arrivals.size(); ++i) {
        const double chance = survival_probability(contribution[i] * paths, pilot.mean, s.importance_floor);
        if (!(Rng(kRejectionChance, i, s.seed).next_double() < chance))
            continue;
        kept.push_back(all.arrivals[i]);
        kept.back().power /= float(chance);
    }
    input.report.acceptance = all.arrivals.empty() ? 1.0 : double(kept.size()) / double(all.arrivals.size());
    all.arrivals = std::move(kept);
    return all;
}

}  // namespace

double survival_probability(double contribution, double mean, double floor) {
    return mean > 0.0 ? std::min(contribution / mean + floor, 1.0) : 1.0;
}

PhotonArrivals rejected_flux(const PlacementInput& input) {
    return survivors(input, double(input.settings.count), Stream::Photon);
}

std::vector<Deposit> rejected_deposits(const PlacementInput& input) {
    return survivors(input, kSurvivorsPerLight * input.settings.count, kRejectionPositions).arrivals;
}

}  // namespace brisance
