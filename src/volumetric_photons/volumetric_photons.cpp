#include "volumetric_photons/volumetric_photons.h"

#include <cmath>

namespace brisance {

namespace {

// Points of a ray at which the cache is evaluated.
constexpr int kSamples = 8;
// A ray starts at the eye if its line passes the eye within this fraction of its distance.
constexpr double kSameLine = 1e-5;

}  // namespace

VolumetricPhotons::VolumetricPhotons(const DirectLight& scene, const VolumetricPhotonSettings& settings, int bounces,
                                     const dvec3& eye, bool other_rays)
    : InScattering(settings.seed),
      scene_(scene),
      settings_(settings),
      eye_(eye),
      cache_(scene.field().medium(), eye, emitted_power(scene, ball_around(scene)), other_rays),
      photon_map_(follow(bounces < 0 ? -1 : bounces - 1)) {
    cache_.finish(settings_.filter_radius);
    report_.surface_photons = photon_map_.size();
}

std::vector<SurfacePhoton> VolumetricPhotons::follow(int most_before) {
    return lights_of_flights<SurfacePhoton>(
        scene_, {Stream::VolumetricPhoton, settings_.paths, settings_.seed}, most_before,
        [&](const ParticleFlight& flight, std::vector<SurfacePhoton>& photons) {
            if (!flight.from_medium)
                return;
            Rng keep_rng(Stream::StoredTrack, flight.particle, settings_.seed | std::uint64_t(flight.before) << 32);
            cache_.add(flight.ray(), flight.segment.end, flight.power, keep_rng);
            if (const std::optional<SurfacePhoton> photon = landed_photon(flight))
                photons.push_back(*photon);
        },
        report_);
}

bool VolumetricPhotons::from_eye(const Segment& ray) const {
    const dvec3 offset = ray.start - eye_;
    const double along = glm::dot(offset, ray.direction);
    return along >= 0.0 && glm::length(offset - along * ray.direction) <= kSameLine * along;
}

Rgb VolumetricPhotons::along_ray(const RayMedium& seen, Rng& rng, SelectionCost*) const {
    if (seen.empty())
        return Rgb(0.0f);
    const bool to_eye = from_eye(seen.segment());
    const vec3 backward(-seen.segment().direction);
    const double shift = rng.next_double();
    Rgb sum(0.0f);
    for (int i = 0; i < kSamples; ++i) {
        const double t = seen.sample_flight((i + shift) / kSamples);
        const Coefficients at = seen.coefficients(t);
        const std::optional<Collision> collision = seen.collision_at(t);
        if (!collision || !(at.extinction > 0.0f))
            continue;
        const dvec3 node = dvec3(scene_.field().bricks().first_node(collision->brick)) + dvec3(collision->position);
        sum += at.scattering / at.extinction *
               (to_eye ? cache_.toward_eye(node) : cache_.toward(backward, node, rng.next()));
    }
    return sum * float(seen.opacity() / kSamples);
}

Rgb VolumetricPhotons::at_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer,
                                  Rng&, SelectionCost*) const {
    return photon_map_.scattered(point, lobes.whole, toward_viewer, settings_.neighbours);
}

}  // namespace brisance
