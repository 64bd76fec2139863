#include "virtual_lights/placement/camera_receivers.h"

#include <algorithm>

#include "core/parallel.h"
#include "transport/particle_walk.h"
#include "virtual_lights/flux/deposit_flux.h"
#include "virtual_lights/kinds/bounded_geometry.h"
#include "virtual_lights/kinds/shadow_ray.h"

namespace brisance {

namespace {

constexpr Stream kReceivers = stream_of("virtual_lights/camera_receivers");
constexpr std::size_t kReceiverPaths = 4096;
// Receivers that each light is evaluated at: "a handful" (Georgiev and Slusallek).
constexpr int kReceiversPerLight = 8;
constexpr WalkRules kReceiverWalk{.transport = Transport::Radiance, .most_before = 15};

}  // namespace

Rgb from_deposit(const DirectLight& scene, const VirtualLightSettings& settings, const PathVertex& vertex,
                 const VirtualLight& light, Rng& rng) {
    const dvec3 offset = light.position - vertex.position();
    const double square = glm::dot(offset, offset);
    if (!(square > 0.0))
        return Rgb(0.0f);
    const dvec3 direction = offset / std::sqrt(square);
    const double cosine = -glm::dot(light.frame.normal, direction);
    if (!(cosine > 0.0))
        return Rgb(0.0f);
    Connection c{0, direction, vertex.at(direction), deposit_intensity(light, -direction)};
    const Rgb unbounded = c.scattered.value * c.radiance;
    if (unbounded == Rgb(0.0f))
        return Rgb(0.0f);
    const double kept = kept_by_bound(settings, vertex.lit(), direction, cosine, square) / square;
    const double of_all = kept_of_contribution(settings, unbounded * float(kept));
    return connect_by_shadow_ray(scene, vertex, light, c, float(kept * of_all), rng);
}

CameraReceivers::CameraReceivers(const PlacementInput& input) : scene_(input.scene), settings_(input.settings) {
    const std::span<const PixelCamera> cameras = input.cameras;
    if (cameras.empty() || std::ranges::any_of(cameras, without_pixels))
        return;
    for (std::size_t i = 0; i < kReceiverPaths; ++i) {
        Rng rng(kReceivers, i, settings_.seed);
        const PixelCamera& camera = cameras[i % cameras.size()];
        const double x = rng.next_double() * camera.width, y = rng.next_double() * camera.height;
        walk_particle(scene_, {camera.ray(x, y), Rgb(1.0f)}, i, kReceiverWalk, rng, [&](const ParticleFlight& flight) {
            if (flight.collision) {
                const Rgb albedo = scene_.field().albedo(flight.collision->brick, flight.collision->position);
                receivers_.push_back({scene_.in_smoke(flight.ray(), *flight.collision), flight.power * albedo});
                return false;
            }
            if (!flight.landing())
                return false;
            const PathVertex vertex(*flight.landing(), flight.ray().direction);
            if (!vertex.only_delta())
                receivers_.push_back({vertex, flight.power});
            return vertex.only_delta();
        });
    }
    found_ = double(receivers_.size()) / double(kReceiverPaths);
}

double CameraReceivers::contribution(const Deposit& deposit, Rng& rng) const {
    if (receivers_.empty())
        return 0.0;
    const VirtualLight light = light_of_deposit(scene_.surroundings()->scene(), deposit);
    double sum = 0.0;
    for (int i = 0; i < kReceiversPerLight; ++i) {
        const auto number = static_cast<std::size_t>(rng.next_double() * double(receivers_.size()));
        const auto& [vertex, throughput] = receivers_[std::min(number, receivers_.size() - 1)];
        sum += luminance(throughput * from_deposit(scene_, settings_, vertex, light, rng));
    }
    return found_ * sum / kReceiversPerLight;
}

std::vector<double> CameraReceivers::contributions(const std::vector<Deposit>& deposits, Stream stream) const {
    std::vector<double> out(deposits.size());
    parallel_for(
        deposits.size(),
        [&](std::size_t i) {
            Rng rng(stream, i, settings_.seed);
            out[i] = contribution(deposits[i], rng);
        },
        64);
    return out;
}

}  // namespace brisance
