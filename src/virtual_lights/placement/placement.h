// Placements: where virtual lights lie, as deposits on surfaces, and how many deposits become few lights.
#pragma once

#include "virtual_lights/flux/photon_splitting.h"
#include "virtual_lights/placed_lights.h"
#include "virtual_lights/placement/camera_candidates.h"
#include "virtual_lights/placement/thinning.h"

namespace brisance {

struct PlacementReport {
    // Of candidates that were weighed, those that became deposits; of mutations, those that moved. 1: none was weighed.
    double acceptance = 1.0;
};

struct PlacementInput {
    const DirectLight& scene;
    std::span<const PixelCamera> cameras;  // of pictures of equal size
    const VirtualLightSettings& settings;
    PlacementReport& report;
};

// Where the lights of a frame come from.
struct LightSources {
    const PixelCamera& camera;                   // of the frame
    std::span<const SharedPositions> positions;  // instead of those that it would place; empty: it places its own
};

// What a light contributes to the picture, up to a factor: the weight by which lights are sampled by power.
using LightImportance = double (*)(const VirtualLight&);

// One row of the table of placements (technique.cpp).
struct Placement {
    const char* name;
    const char* help;
    // More deposits than there will be lights, and which of them become lights.
    std::vector<Deposit> (*deposits)(const PlacementInput&);
    Survivors (*thin)(const std::vector<vec3>& positions, const VirtualLightSettings&);
    LightImportance importance;
    // About settings.count deposits that carry, together, all power that arrives at surfaces. Null: deposits of this
    // placement carry no flux.
    PhotonArrivals (*flux_deposits)(const PlacementInput&);
};

// Where camera paths meet surfaces once they were scattered.
std::vector<Deposit> camera_deposits(const PlacementInput& input);
// Where particles from the fire and the emitters meet surfaces.
std::vector<Deposit> light_path_deposits(const PlacementInput& input);
// Those of many light paths that lie where camera paths arrive (reject_unimportant.h).
std::vector<Deposit> relaxed_light_path_deposits(const PlacementInput& input);

// As many light paths as yield about settings.count deposits, which a pilot estimates: all deposits of all of them, so
// that the mean is right whatever their number.
PhotonArrivals light_path_flux(const PlacementInput& input);

// For lights that camera paths placed. Lights that lie close together are those whose light the camera sees: by power
// alone, large lights far off would be sampled in vain.
double power_per_area(const VirtualLight& light);
// For lights that photons placed.
double power_alone(const VirtualLight& light);
// For lights that photons placed near the camera's paths: all contribute about the same.
double equal_importance(const VirtualLight& light);

}  // namespace brisance
