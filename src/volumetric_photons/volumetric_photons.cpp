#include "volumetric_photons/volumetric_photons.h"

#include <cmath>

namespace brisance {

namespace {

// Of a ray, where its light is asked for.
constexpr int kPlaces = 8;
// A ray whose line passes the eye nearer than this part of how far it is away comes from there.
constexpr double kSameLine = 1e-5;

// Where a flight lands after it was scattered in smoke.
void leave_landing(const ParticleFlight& flight, std::vector<SurfacePhoton>& landings) {
    const SurfacePoint* point = flight.landing();
    if (!point)
        return;
    const dvec3 &normal = point->frame.normal, &direction = flight.ray().direction;
    const bool above = glm::dot(normal, direction) < 0.0;
    landings.push_back({vec3(point->position), vec3(above ? normal : -normal), vec3(direction), flight.power});
}

}  // namespace

VolumetricPhotons::VolumetricPhotons(const DirectLight& scene, const VolumetricPhotonSettings& settings, int bounces,
                                     const dvec3& eye, bool other_rays)
    : InScattering(settings.seed),
      scene_(scene),
      settings_(settings),
      eye_(eye),
      laid_(scene.field().medium(), eye, emitted_power(scene, ball_around(scene)), other_rays),
      landings_(follow(bounces < 0 ? -1 : bounces - 1)) {
    laid_.finish();
    report_.landings = landings_.size();
}

std::vector<SurfacePhoton> VolumetricPhotons::follow(int most_before) {
    return lights_of_flights<SurfacePhoton>(
        scene_, {Stream::VolumetricPhoton, settings_.paths, settings_.seed}, most_before,
        [&](const ParticleFlight& flight, std::vector<SurfacePhoton>& landings) {
            if (!flight.from_medium)
                return;
            Rng keep_rng(Stream::StoredTrack, flight.particle, settings_.seed | std::uint64_t(flight.before) << 32);
            laid_.add(flight.ray(), flight.segment.end, flight.power, keep_rng);
            leave_landing(flight, landings);
        },
        report_);
}

bool VolumetricPhotons::from_eye(const Segment& ray) const {
    const dvec3 way = ray.start - eye_;
    const double along = glm::dot(way, ray.direction);
    return along >= 0.0 && glm::length(way - along * ray.direction) <= kSameLine * along;
}

Rgb VolumetricPhotons::along_ray(const RayMedium& seen, Rng& rng, SelectionCost*) const {
    if (seen.empty())
        return Rgb(0.0f);
    const bool to_eye = from_eye(seen.segment());
    const vec3 backward(-seen.segment().direction);
    const double shift = rng.next_double();
    Rgb sum(0.0f);
    for (int i = 0; i < kPlaces; ++i) {
        const double t = seen.sample_flight((i + shift) / kPlaces);
        const Coefficients at = seen.coefficients(t);
        const std::optional<Collision> place = seen.place(t);
        if (!place || !(at.extinction > 0.0f))
            continue;
        const dvec3 node = dvec3(scene_.field().bricks().first_node(place->brick)) + dvec3(place->position);
        sum += at.scattering / at.extinction *
               (to_eye ? laid_.toward_eye(node) : laid_.toward(backward, node, rng.next()));
    }
    return sum * float(seen.opacity() / kPlaces);
}

Rgb VolumetricPhotons::at_surface(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer, Rng&,
                                  SelectionCost*) const {
    return landings_.scattered(point, lobes.whole, toward_viewer, settings_.neighbours);
}

}  // namespace brisance
