// Input and output of a scattering method: an estimator of light that scattered in the medium before its last
// scattering, the ledger's cells MM and SM.
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
    const DirectLight& scene;  // must outlive the estimator
    int bounces = -1;          // the most scatterings of a path; -1: all
    dvec3 eye{0.0};            // of the camera, local [m]
    // Receivers that represent all that the camera sees, if the method thins out its lights; else empty.
    std::span<const LightReceiver> receivers;
    int pass = 0;               // index among averaged pictures
    double first_radius = 0.0;  // MadeInScattering::radius of pass 0 [m]
};

struct MadeInScattering {
    std::unique_ptr<InScattering> estimator;
    std::uint64_t bytes = 0;
    nlohmann::ordered_json detail;  // counts, for the statistics
    double radius = 0.0;            // of beams or of another blur that shrinks [m]; 0: there is none
};

// A method of `brisance report` that is this scattering method with some settings ("KEY=VALUE", without the section).
struct MethodPreset {
    std::string label;
    std::vector<std::string> settings;
};

}  // namespace brisance
