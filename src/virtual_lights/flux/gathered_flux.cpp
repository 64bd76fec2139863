#include "virtual_lights/flux/gathered_flux.h"

#include <numbers>
#include <optional>

#include "core/stopwatch.h"
#include "virtual_lights/flux/covered_area.h"

namespace brisance {

namespace {

// Of a spot, in the mean: what smoke shows of them is the light of many.
constexpr double kPhotonsOfSpot = 4.0;

// Seconds since the last call.
class Lap {
public:
    double take() {
        const double now = watch_.seconds(), passed = now - before_;
        before_ = now;
        return passed;
    }

private:
    Stopwatch watch_;
    double before_ = 0.0;
};

// Whether the scene still has the triangle.
bool is_there(const Scene& scene, const SurfaceHit& hit) {
    return hit.mesh < scene.meshes.size() && hit.triangle < scene.meshes[hit.mesh].triangles.size();
}

// Lights with a radius that hold no light yet.
void add_lights(const SharedPositions& from, LightSet& set) {
    const Scene& scene = set.scene().surroundings()->scene();
    const PlacedLights& placed = *from.lights;
    for (std::size_t i = 0; i < placed.deposits.size(); ++i) {
        if (!is_there(scene, placed.deposits[i].hit))
            continue;
        VirtualLight& light = set.lights.emplace_back(light_at(scene, placed.deposits[i]));
        light.radius = set.settings().radius_factor * placed.distance[i];
        light.share = from.share;
        light.number = from.group << 32 | i;
    }
}

// Lights whose area cannot be measured leave their surface to others, or to extended paths.
void measure_lights(LightSet& set) {
    const Intersector& surfaces = set.scene().surroundings()->intersector();
    set.partition = PartitionOfUnity(surfaces, set.lights);
    const std::vector<std::uint8_t> known = measure_areas(surfaces, set.partition, set.lights, set.settings().seed);
    std::vector<VirtualLight> kept;
    for (std::size_t i = 0; i < set.lights.size(); ++i)
        if (known[i])
            kept.push_back(set.lights[i]);
    if (kept.size() == set.lights.size())
        return;
    set.lights = std::move(kept);
    set.partition = PartitionOfUnity(surfaces, set.lights);
    measure_areas(surfaces, set.partition, set.lights, set.settings().seed);
}

void finish_lights(LightSet& set, const LightAccounts& accounts) {
    const int resolution = set.settings().profile_resolution;
    set.profiles = Profiles(set.lights, accounts, resolution);
    for (std::size_t i = 0; i < set.lights.size(); ++i) {
        VirtualLight& light = set.lights[i];
        if (light.profile >= 0) {
            light.flux = set.profiles.exitance(light) * float(light.area);
            light.base_flux = base_flux(light, i, accounts, resolution);
            light.intensity = set.profiles.brightest(light) * light.area;
            light.held = set.mean_held(light);
        } else {
            light.irradiance = accounts.whole(i) / float(light.area);
            light.flux = light.base_flux = light.irradiance * light.material.base_colour * float(light.area);
            light.intensity = luminance(light.flux) / std::numbers::pi;
        }
        light.power = luminance(light.flux);
        set.report.flux += light.flux;
    }
}

}  // namespace

void GatheredFlux::build(LightSet& set, const Placement&, const LightSources& sources) {
    VirtualLightReport& report = set.report;
    std::vector<SharedPositions> positions(sources.positions.begin(), sources.positions.end());
    if (positions.empty())
        positions.push_back(
            {std::make_shared<PlacedLights>(place_lights(set.scene(), std::span(&sources.camera, 1), set.settings()))});
    for (const SharedPositions& shared : positions) {
        report.candidates += shared.lights->candidates;
        report.candidate_seconds += shared.lights->candidate_seconds;
        report.elimination_seconds += shared.lights->elimination_seconds;
        report.acceptance = shared.lights->acceptance;
        add_lights(shared, set);
    }

    Lap lap;
    measure_lights(set);
    for (VirtualLight& light : set.lights)
        if (needs_energy_tables(light.material))
            light.profile = static_cast<std::int32_t>(report.profiles++);
    report.area_seconds = lap.take();

    const BoundingBall ball = ball_around(set.scene());
    const double power = emitted_power(set.scene(), ball);
    LightAccounts accounts(set.lights, set.settings().profile_resolution, power);
    const std::size_t photons =
        photons_needed(set.scene(), ball, set.partition, set.settings(), set.lights.size(), sources.camera.samples);
    std::optional<SpotAccounts> spots;
    if (set.settings().light_smoke)
        spots.emplace(set.lights, set.scene().field().medium(), photons, power);
    report.photons = trace_photons(set.scene(), ball, set.partition, photons, set.settings().seed, accounts,
                                   spots ? &*spots : nullptr);
    report.photon_bytes = accounts.bytes() + (spots ? spots->bytes() : 0);
    if (spots)
        set.spots = spots->spots(kPhotonsOfSpot, [&](std::size_t light) { return accounts.photons(light); });
    report.photon_seconds = lap.take();

    finish_lights(set, accounts);
    report.profile_seconds = lap.take();
}

Rgb GatheredFlux::intensity(const VirtualLight& light, const dvec3& toward) const {
    const double cosine = glm::dot(light.frame.normal, toward);
    return cosine > 0.0 ? set_.radiance(light, toward) * float(cosine * light.area) : Rgb(0.0f);
}

Rgb GatheredFlux::surface_light(const VirtualLight& light, const dvec3& toward) const {
    return light.profile >= 0 ? set_.profiles.radiance(light, toward) : light.irradiance;
}

}  // namespace brisance
