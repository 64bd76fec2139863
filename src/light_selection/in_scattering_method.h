// What a scattering method is given, and what it makes: an estimator of the light that the medium scattered before its
// last scattering, the ledger's cells MM and SM.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "light_selection/in_scattering.h"
#include "statistics/statistics.h"

namespace brisance {

class DirectLight;

struct InScatteringRequest {
    const DirectLight& scene;  // must outlive what is made
    int bounces = -1;          // the most scatterings of a path; -1: all
    dvec3 eye{0.0};            // of the camera, local [m]
    // What stands for all that the camera sees, where the method thins its lights out for it; else empty.
    std::span<const LightReceiver> receivers;
    int pass = 0;               // of several pictures that are averaged
    double first_radius = 0.0;  // MadeInScattering::radius of pass 0 [m]
};

struct MadeInScattering {
    std::unique_ptr<InScattering> estimator;
    std::uint64_t bytes = 0;
    nlohmann::ordered_json detail;  // counts, for the statistics
    double radius = 0.0;            // of beams [m]; 0: there are none
};

// A method of `brisance report` that is this scattering method with some settings ("KEY=VALUE", without the section).
struct MethodPreset {
    std::string label;
    std::vector<std::string> settings;
};

}  // namespace brisance
