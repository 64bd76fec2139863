#include "virtual_lights/flux/covered_area.h"

#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/rng.h"

namespace brisance {

namespace {

// Rays come in rounds, until this many of them found surface that the light covers, or too many did not.
constexpr int kRays = 64;
constexpr int kRounds = 8;
constexpr int kEnough = 24;
constexpr int kTooFew = 8;

constexpr int kLayers = 8;  // surfaces one behind the other within one sphere

// What one ray through the sphere meets: the light's weight there over the cosine between ray and surface.
double weight_along(const Intersector& surfaces, const PartitionOfUnity& partition, Ray ray, double length,
                    std::uint32_t index, VirtualLight& light) {
    double sum = 0.0;
    for (int layer = 0; layer < kLayers; ++layer) {
        const std::optional<SurfaceHit> hit = surfaces.first_hit(ray, length);
        if (!hit)
            break;
        const SurfacePoint point = surface_point(surfaces.scene(), *hit, -ray.direction);
        const int material = surfaces.scene().meshes[hit->mesh].material;
        const dvec3 normal = lit_normal(point);
        const LightShares shares = partition.shares(point.position, normal, material);
        const double cosine = glm::dot(normal, light.frame.normal);
        for (int i = 0; i < shares.count; ++i)
            if (shares.light[i] == index) {
                sum += shares.weight[i] / cosine;
                light.spread = std::max(light.spread, std::acos(std::min(cosine, 1.0)));
            }
        ray = point.leaving(ray.direction);
        length -= hit->distance;
    }
    return sum;
}

// A round of rays, even over the disc by Vogel's spiral: the sum of their weights.
double round_of_rays(const Intersector& surfaces, const PartitionOfUnity& partition, std::uint32_t index, Rng& rng,
                     VirtualLight& light, int& found) {
    const double shift = rng.next_double(), turn = rng.next_double();
    double sum = 0.0;
    for (int k = 0; k < kRays; ++k) {
        const double square = (k + shift) / kRays;
        const double angle = 2.0 * std::numbers::pi * (turn + k * 0.6180339887498949);
        const double across = light.radius * std::sqrt(square), height = light.radius * std::sqrt(1.0 - square);
        const dvec3 start =
            light.position + light.frame.world_from_local({across * std::cos(angle), across * std::sin(angle), height});
        const double weight =
            weight_along(surfaces, partition, {start, -light.frame.normal}, 2.0 * height, index, light);
        sum += weight;
        found += weight > 0.0;
    }
    return sum;
}

// False: the rays found hardly any covered surface.
bool measure(const Intersector& surfaces, const PartitionOfUnity& partition, std::uint32_t index, std::uint32_t seed,
             VirtualLight& light) {
    Rng rng(Stream::LightArea, light.number, seed);
    double sum = 0.0;
    int found = 0, rays = 0;
    light.spread = 0.0;
    for (int round = 0; round < kRounds && found < kEnough; ++round, rays += kRays)
        sum += round_of_rays(surfaces, partition, index, rng, light, found);
    const double disc = std::numbers::pi * light.radius * light.radius;
    light.area = disc * std::max(sum, light.share) / rays;
    return found >= kTooFew;
}

}  // namespace

std::vector<std::uint8_t> measure_areas(const Intersector& surfaces, const PartitionOfUnity& partition,
                                        std::span<VirtualLight> lights, std::uint32_t seed) {
    std::vector<std::uint8_t> known(lights.size());
    parallel_for(
        lights.size(),
        [&](std::size_t i) { known[i] = measure(surfaces, partition, static_cast<std::uint32_t>(i), seed, lights[i]); },
        16);
    return known;
}

}  // namespace brisance
