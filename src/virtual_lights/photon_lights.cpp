#include "virtual_lights/photon_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "virtual_lights/packing_distance.h"
#include "virtual_lights/placement.h"

namespace brisance {

namespace {

constexpr std::size_t kPilotPaths = 4096;
constexpr int kReflectanceSamples = 16;
// Of flux that samples of the reflectance may have missed, so that no light is never asked.
constexpr float kLeastPower = 0.01f;

// Light paths that meet surfaces `count` times, about.
std::size_t paths_for(const DirectLight& scene, int count, std::uint32_t seed) {
    const std::size_t met = photon_arrivals(scene, kPilotPaths, Stream::LightCandidate, seed).arrivals.size();
    if (met == 0)
        return 0;
    return static_cast<std::size_t>(std::ceil(double(count) * double(kPilotPaths) / double(met)));
}

// Share of the light from its source that a glossy material reflects, by sampling; of Lambert surfaces exact.
Rgb reflectance(const VirtualLight& light, std::uint64_t index, std::uint32_t seed) {
    if (!needs_energy_tables(light.material))
        return light.material.base_colour;
    const Bsdf bsdf(light.material, light.frame);
    Rng rng(Stream::LightArea, index, seed);
    Rgb sum(0.0f);
    for (int i = 0; i < kReflectanceSamples; ++i) {
        const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
        if (const std::optional<BsdfSample> drawn = bsdf.sample(light.toward_source, {x, y, z}))
            sum += drawn->weight;
    }
    return sum / float(kReflectanceSamples);
}

VirtualLight light_of(const Scene& scene, const PhotonArrival& arrival, std::uint64_t index, std::uint32_t seed) {
    VirtualLight light = light_at(scene, arrival.place);
    light.toward_source = dvec3(arrival.place.toward_viewer);
    light.area = 1.0;
    light.irradiance = arrival.power;
    light.flux = arrival.power * reflectance(light, index, seed);
    light.base_flux = arrival.power * Bsdf(light.material, light.frame).base_albedo(light.toward_source);
    light.power = luminance(glm::max(light.flux, kLeastPower * arrival.power));
    light.intensity = light.power / std::numbers::pi;
    return light;
}

}  // namespace

PhotonLights lights_at_photons(const DirectLight& scene, int count, std::uint32_t seed) {
    const PhotonArrivals photons = photon_arrivals(scene, paths_for(scene, count, seed), Stream::Photon, seed);
    PhotonLights out;
    out.report = photons.report;
    out.lights.resize(photons.arrivals.size());
    const Scene& surfaces = scene.surroundings()->scene();
    parallel_for(
        out.lights.size(), [&](std::size_t i) { out.lights[i] = light_of(surfaces, photons.arrivals[i], i, seed); },
        64);
    return out;
}

// The BSDF holds the cosine of its second direction.
Rgb reflected_flux(const VirtualLight& light, const dvec3& toward) {
    if (!needs_energy_tables(light.material))
        return light.irradiance * light.material.base_colour *
               (float(std::max(0.0, glm::dot(light.frame.normal, toward))) / std::numbers::pi_v<float>);
    return light.irradiance * Bsdf(light.material, light.frame).evaluate(light.toward_source, toward);
}

void widen_to_neighbours(std::span<VirtualLight> lights, int k, double otherwise) {
    std::vector<vec3> points;
    for (const VirtualLight& light : lights)
        points.emplace_back(light.position);
    const std::vector<double> distances = distances_to_nearest(points, k);
    for (std::size_t i = 0; i < lights.size(); ++i)
        lights[i].radius = distances[i] > 0.0 ? distances[i] : otherwise;
}

}  // namespace brisance
