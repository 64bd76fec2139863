// Follows particles of fire and emitters through medium and surfaces, and keeps their flights that start in the medium:
// light that was scattered there before, the ledger's cells MM and SM.
#pragma once

#include <vector>

#include "photon_density/settings.h"
#include "transport/particle_walk.h"
#include "volumetric_photons/photon_map.h"

namespace brisance {

// Up to where its particle collided, or a little beyond the smoke.
struct PhotonFlight {
    vec3 start;      // local [m]
    vec3 direction;  // unit, of travel
    Rgb power;       // [W]
    float length;    // [m]
    bool collides;   // at its end
    dvec3 at(double t) const { return dvec3(start) + t * dvec3(direction); }
};

struct TracedPhotons {
    std::vector<PhotonFlight> flights;
    std::vector<SurfacePhoton> landed;
};

// `margin`: how far flights are kept beyond the smoke [m]; `bounces`: the most scatterings of a path, -1: no limit.
TracedPhotons trace_photons(const DirectLight& scene, const PhotonDensitySettings& settings, double margin, int bounces,
                            FlightReport& report);

}  // namespace brisance
