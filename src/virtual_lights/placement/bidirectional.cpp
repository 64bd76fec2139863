#include "virtual_lights/placement/bidirectional.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "virtual_lights/flux/deposit_flux.h"
#include "virtual_lights/placement/camera_receivers.h"

namespace brisance {

namespace {

constexpr Stream kBidirectionalPaths = stream_of("virtual_lights/bidirectional/paths");
constexpr Stream kForward = stream_of("virtual_lights/bidirectional/forward");
constexpr Stream kBackward = stream_of("virtual_lights/bidirectional/backward");
constexpr Stream kShift = stream_of("virtual_lights/bidirectional/shift");
// Of either kind, per light.
constexpr std::size_t kCandidatesPerLight = 4;
// Candidates of light paths that light one of the camera's.
constexpr int kLightsPerCandidate = 8;
constexpr double kRegardless = 0.1;

// Radiance toward the camera path that left the deposit, luminance [W/(m^2 sr)]: direct light by one line, indirect
// light from some of the deposits of light paths.
double leaving_radiance(const PlacementInput& input, const Deposit& deposit, const std::vector<Deposit>& lit,
                        Rng& rng) {
    const DirectLight& scene = input.scene;
    const Scene& surfaces = scene.surroundings()->scene();
    const PathVertex vertex(surface_point(surfaces, deposit.hit, dvec3(deposit.direction)), -dvec3(deposit.direction));
    Rgb sum(0.0f);
    if (scene.has_emitters())
        sum += scene.from_emitters(vertex, rng);
    if (const float lines = scene.fire().empty() ? 0.0f : scene.fire_lines_on_surface(vertex); lines > 0.0f)
        sum += scene.from_fire(vertex, lines, rng);
    const float each = float(lit.size()) / kLightsPerCandidate;
    for (int i = 0; i < kLightsPerCandidate && !lit.empty(); ++i) {
        const auto number = static_cast<std::size_t>(rng.next_double() * double(lit.size()));
        const VirtualLight light = light_of_deposit(surfaces, lit[std::min(number, lit.size() - 1)]);
        sum += each * from_deposit(scene, input.settings, vertex, light, rng);
    }
    return luminance(sum);
}

// Chances in proportion to weights, as far as they are not 1, that add up to `count`.
std::vector<double> chances_of(std::vector<double> weight, double count) {
    const double all = std::accumulate(weight.begin(), weight.end(), 0.0);
    for (double& w : weight)
        w = all > 0.0 ? std::lerp(w / all, 1.0 / double(weight.size()), kRegardless) : 1.0 / double(weight.size());
    double low = 0.0, high = count;
    const auto sum = [&](double factor) {
        double out = 0.0;
        for (const double w : weight)
            out += std::min(1.0, factor * w);
        return out;
    };
    for (int i = 0; i < 60 && sum(high) < std::min(count, double(weight.size())) * (1.0 - 1e-9); ++i)
        high *= 2.0;
    for (int i = 0; i < 50; ++i)
        (sum(0.5 * (low + high)) < count ? low : high) = 0.5 * (low + high);
    for (double& w : weight)
        w = std::min(1.0, high * w);
    return weight;
}

// Evenly spaced through the chances.
void resample(const std::vector<Deposit>& from, const std::vector<double>& chance, double shift,
              std::vector<Deposit>& out) {
    double passed = shift;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const double next = passed + chance[i];
        if (std::floor(next) > std::floor(passed))
            out.push_back(from[i]);
        passed = next;
    }
}

}  // namespace

std::vector<Deposit> bidirectional_deposits(const PlacementInput& input) {
    const VirtualLightSettings& s = input.settings;
    const std::size_t candidates = kCandidatesPerLight * static_cast<std::size_t>(s.count);
    const std::vector<Deposit> forward = photon_arrivals(input.scene, candidates, kBidirectionalPaths, s.seed).arrivals;
    const std::vector<Deposit> backward = light_candidates(input.scene, input.cameras, candidates, s.seed);
    const std::vector<double> seen = CameraReceivers(input).contributions(forward, kForward);
    std::vector<double> radiance(backward.size());
    parallel_for(
        backward.size(),
        [&](std::size_t i) {
            Rng rng(kBackward, i, s.seed);
            radiance[i] = leaving_radiance(input, backward[i], forward, rng);
        },
        64);
    const double half = 0.5 * s.count;
    std::vector<Deposit> out;
    resample(forward, chances_of(seen, backward.empty() ? s.count : half), Rng(kShift, 0, s.seed).next_double(), out);
    resample(backward, chances_of(radiance, forward.empty() ? s.count : half), Rng(kShift, 1, s.seed).next_double(),
             out);
    input.report.acceptance = out.empty() ? 1.0 : double(out.size()) / double(forward.size() + backward.size());
    return out;
}

}  // namespace brisance
