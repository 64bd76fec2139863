#include "virtual_lights/flux/deposit_flux.h"

#include <algorithm>
#include <numbers>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "surfaces/bsdf_bound.h"

namespace brisance {

namespace {

constexpr int kReflectanceSamples = 16;
// Of flux that samples of the reflectance may have missed, so that every light is sampled sometimes.
constexpr float kLeastPower = 0.01f;

// Fraction of the light from its source that a glossy material reflects, by sampling; exact for Lambert surfaces.
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

// Over all directions, luminance [W/sr].
double largest_intensity(const VirtualLight& light) {
    const Bsdf bsdf(light.material, light.frame);
    return luminance(light.irradiance) * BsdfBound(bsdf, light.toward_source).over(light.frame.normal, -1.0);
}

VirtualLight light_of(const Scene& scene, const Deposit& deposit, std::uint64_t index, std::uint32_t seed) {
    VirtualLight light = light_of_deposit(scene, deposit);
    light.flux = deposit.power * reflectance(light, index, seed);
    light.base_flux = deposit.power * Bsdf(light.material, light.frame).base_albedo(light.toward_source);
    light.power = luminance(glm::max(light.flux, kLeastPower * deposit.power));
    light.intensity = light.power / std::numbers::pi;
    if (needs_energy_tables(light.material))
        light.intensity = std::max(light.intensity, largest_intensity(light));
    return light;
}

}  // namespace

void DepositFlux::build(LightSet& set, const Placement& placement, const LightSources& sources) {
    const Stopwatch watch;
    PlacementReport placed;
    const PhotonArrivals photons =
        placement.flux_deposits({set.scene(), std::span(&sources.camera, 1), set.settings(), placed});
    set.report.acceptance = placed.acceptance;
    set.report.photons = photons.report;
    set.lights.resize(photons.arrivals.size());
    const Scene& surfaces = set.scene().surroundings()->scene();
    parallel_for(
        set.lights.size(),
        [&](std::size_t i) { set.lights[i] = light_of(surfaces, photons.arrivals[i], i, set.settings().seed); }, 64);
    for (const VirtualLight& light : set.lights)
        set.report.flux += light.flux;
    // Particles leave deposits wherever light can be held.
    set.complete = true;
    set.report.photon_seconds = watch.seconds();
}

VirtualLight light_of_deposit(const Scene& scene, const Deposit& deposit) {
    VirtualLight light = light_at(scene, deposit);
    light.toward_source = dvec3(deposit.direction);
    light.area = 1.0;
    light.irradiance = deposit.power;
    return light;
}

// The BSDF includes the cosine to its second direction.
Rgb deposit_intensity(const VirtualLight& light, const dvec3& toward) {
    if (!needs_energy_tables(light.material))
        return light.irradiance * light.material.base_colour *
               (float(std::max(0.0, glm::dot(light.frame.normal, toward))) / std::numbers::pi_v<float>);
    return light.irradiance * Bsdf(light.material, light.frame).evaluate(light.toward_source, toward);
}

std::optional<Bsdf> DepositFlux::lobes(const VirtualLight& light) const {
    if (!needs_energy_tables(light.material))
        return std::nullopt;
    return std::optional<Bsdf>(std::in_place, light.material, light.frame);
}

}  // namespace brisance
