#include "photon_density/trace_photons.h"

#include <algorithm>
#include <variant>

namespace brisance {

namespace {

constexpr Stream kPhotons = stream_of("photon_density/photon");

using Stored = std::variant<PhotonFlight, SurfacePhoton>;

// Where the ray leaves the smoke for the last time before `end`; 0: it meets none [m].
double end_of_smoke(const TrackingField& field, const Ray& ray, double end) {
    double last = 0.0;
    walk_bricks(field.bricks(), field.enter(ray, end), [&](const VoxelSegment& brick) {
        if (field.majorant(brick.brick) > 0.0f)
            last = brick.end;
        return true;
    });
    return last;
}

void store(const DirectLight& scene, const ParticleFlight& flight, double margin, std::vector<Stored>& stored) {
    if (!flight.from_medium)
        return;
    const Ray& ray = flight.ray();
    const double end =
        flight.collision ? flight.collision->distance
                         : std::min(flight.segment.end, end_of_smoke(scene.field(), ray, flight.segment.end) + margin);
    stored.emplace_back(
        PhotonFlight{vec3(ray.origin), vec3(ray.direction), flight.power, float(end), flight.collision.has_value()});
    if (const std::optional<SurfacePhoton> photon = landed_photon(flight))
        stored.emplace_back(*photon);
}

}  // namespace

TracedPhotons trace_photons(const DirectLight& scene, const PhotonDensitySettings& settings, double margin, int bounces,
                            FlightReport& report) {
    TracedPhotons photons;
    if (bounces >= 0 && bounces < 2)
        return photons;
    const std::vector<Stored> all = lights_of_flights<Stored>(
        scene, {kPhotons, settings.paths, settings.seed}, bounces < 0 ? -1 : bounces - 1,
        [&](const ParticleFlight& flight, std::vector<Stored>& stored) { store(scene, flight, margin, stored); },
        report);
    for (const Stored& one : all)
        if (const auto* flight = std::get_if<PhotonFlight>(&one))
            photons.flights.push_back(*flight);
        else
            photons.landed.push_back(std::get<SurfacePhoton>(one));
    return photons;
}

}  // namespace brisance
