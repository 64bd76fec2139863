#include "virtual_lights/virtual_lights.h"

#include <algorithm>
#include <numbers>

#include "core/error.h"
#include "core/stopwatch.h"
#include "virtual_lights/covered_area.h"
#include "virtual_lights/photon_lights.h"
#include "virtual_lights/placement.h"
#include "virtual_lights/reject_unimportant.h"

namespace brisance {

namespace {

// Fewer candidates than this per light leave elimination little to choose from.
constexpr double kLeastCandidates = 8.0;
// Light paths per light, of whose ends those near the camera's candidates are kept.
constexpr double kPathsToJudge = 32.0;
// Of the scene's radius, for the sphere of a single light.
constexpr double kLonelyRadius = 0.1;

void require(bool holds, const char* what) {
    if (!holds)
        throw Error(ExitCode::Usage, std::string("virtual lights: ") + what);
}

void check_kind(const VirtualLightSettings& s) {
    require(s.kind == VirtualLightKind::Patch || (!draws_rays(s.sampling) && !s.extension),
            "kinds sphere and point need sampling power, light_tree, resampled or all, and no extension: no ray finds "
            "them");
    require(s.flux == LightFlux::Gathered || s.kind != VirtualLightKind::Patch,
            "flux own needs kind sphere or point: a patch is lit by all photons that it meets");
    require(s.flux == LightFlux::Gathered || s.placement == LightPlacement::LightPaths,
            "flux own needs placement light_paths: nothing arrives elsewhere");
    require(s.point_bound > 0.0, "point_bound must be above 0");
    require(s.sphere_neighbours >= 1, "sphere_neighbours must be at least 1");
    require(s.sphere_samples >= 1, "sphere_samples must be at least 1");
    require(s.resampling_candidates >= 1, "resampling_candidates must be at least 1");
}

void check(const VirtualLightSettings& s) {
    require(s.count >= 0, "count must not be negative");
    require(s.photons >= 0, "photons must not be negative");
    require(s.candidates_per_pixel >= 0.0 && s.candidates_per_pixel <= 1e3, "candidates_per_pixel must lie in 0..1000");
    require(s.neighbours >= 1, "neighbours must be at least 1");
    require(s.radius_factor > 0.0 && s.radius_factor <= 10.0, "radius_factor must lie above 0 and not above 10");
    require(s.profile_resolution >= 2 && s.profile_resolution <= 128, "profile_resolution must lie in 2..128");
    require(s.n_min >= 0.0 && s.n_max >= s.n_min, "n_min must not be negative, and n_max not below it");
    check_kind(s);
}

std::vector<LightCandidate> places_of(const PhotonArrivals& photons) {
    std::vector<LightCandidate> out;
    out.reserve(photons.arrivals.size());
    for (const PhotonArrival& arrival : photons.arrivals)
        out.push_back(arrival.place);
    return out;
}

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

}  // namespace

VirtualLights::VirtualLights(const DirectLight& scene, const PixelCamera& camera, const VirtualLightSettings& settings)
    : scene_(scene), settings_(settings), choice_({}, settings) {
    check(settings);
    shines_ = scene.lights_surfaces();
    if (shines_ && settings.count > 0 && settings.photons > 0)
        build(camera);
}

void VirtualLights::build(const PixelCamera& camera) {
    if (settings_.flux == LightFlux::Own)
        build_of_photons();
    else
        build_of_places(camera);
    const Stopwatch watch;
    if (settings_.kind == VirtualLightKind::Sphere)
        widen_to_neighbours(lights_, settings_.sphere_neighbours, kLonelyRadius * ball_around(scene_).radius);
    if (settings_.kind == VirtualLightKind::Point)
        for (VirtualLight& light : lights_)
            light.radius = 0.0;
    choice_ = LightChoice(lights_, settings_);
    report_.choice_seconds = watch.seconds();
    report_.lights = lights_.size();
    report_.bytes = lights_.size() * sizeof(VirtualLight) + cover_.bytes() + profiles_.bytes() + choice_.bytes();
}

void VirtualLights::build_of_photons() {
    const Stopwatch watch;
    PhotonLights photons = lights_at_photons(scene_, settings_.count, settings_.seed);
    lights_ = std::move(photons.lights);
    for (const VirtualLight& light : lights_)
        report_.flux += light.flux;
    report_.photons = photons.report;
    report_.photon_seconds = watch.seconds();
}

std::vector<LightCandidate> VirtualLights::candidates(const PixelCamera& camera) const {
    const std::size_t least = static_cast<std::size_t>(kLeastCandidates * settings_.count);
    const auto along_light = [&](double paths_per_light) {
        return places_of(photon_arrivals(scene_, static_cast<std::size_t>(paths_per_light * settings_.count),
                                         Stream::LightCandidate, settings_.seed));
    };
    if (settings_.placement == LightPlacement::LightPaths)
        return along_light(kLeastCandidates);
    const double paths =
        std::max(settings_.candidates_per_pixel * camera.width * camera.height, kLeastCandidates * settings_.count);
    std::vector<LightCandidate> from_camera =
        light_candidates(scene_, camera, static_cast<std::size_t>(paths), settings_.seed);
    if (settings_.placement == LightPlacement::RelaxedLightPaths)
        return reject_unimportant(along_light(kPathsToJudge), from_camera, least, settings_.seed);
    return from_camera;
}

void VirtualLights::build_of_places(const PixelCamera& camera) {
    Lap lap;
    const std::vector<LightCandidate> places = candidates(camera);
    report_.candidates = places.size();
    report_.candidate_seconds = lap.take();
    lights_ = place_lights(scene_.surroundings()->scene(), places, settings_);
    report_.elimination_seconds = lap.take();

    measure_lights();
    for (VirtualLight& light : lights_)
        if (needs_energy_tables(light.material))
            light.profile = static_cast<std::int32_t>(report_.profiles++);
    report_.area_seconds = lap.take();

    const BoundingBall ball = ball_around(scene_);
    LightAccounts accounts(lights_, settings_.profile_resolution, emitted_power(scene_, ball));
    report_.photons = trace_photons(scene_, ball, cover_, settings_, accounts);
    report_.photon_bytes = accounts.bytes();
    report_.photon_seconds = lap.take();

    finish_lights(accounts);
    report_.profile_seconds = lap.take();
}

// Lights whose area cannot be told leave their surface to others, or to extended paths.
void VirtualLights::measure_lights() {
    const Intersector& surfaces = scene_.surroundings()->intersector();
    cover_ = PartitionOfUnity(surfaces, lights_);
    const std::vector<std::uint8_t> known = measure_areas(surfaces, cover_, lights_, settings_.seed);
    std::vector<VirtualLight> kept;
    for (std::size_t i = 0; i < lights_.size(); ++i)
        if (known[i])
            kept.push_back(lights_[i]);
    if (kept.size() == lights_.size())
        return;
    lights_ = std::move(kept);
    cover_ = PartitionOfUnity(surfaces, lights_);
    measure_areas(surfaces, cover_, lights_, settings_.seed);
}

void VirtualLights::finish_lights(const LightAccounts& accounts) {
    profiles_ = Profiles(lights_, accounts, settings_.profile_resolution);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        VirtualLight& light = lights_[i];
        if (light.profile >= 0) {
            light.flux = profiles_.exitance(light) * float(light.area);
            light.base_flux = base_flux(light, i, accounts, settings_.profile_resolution);
            light.intensity = profiles_.brightest(light) * light.area;
        } else {
            light.irradiance = accounts.whole(i) / float(light.area);
            light.flux = light.base_flux = light.irradiance * light.material.base_colour * float(light.area);
            light.intensity = luminance(light.flux) / std::numbers::pi;
        }
        light.power = luminance(light.flux);
        report_.flux += light.flux;
    }
}

}  // namespace brisance
