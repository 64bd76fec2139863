// Positions of virtual lights, apart from the light that they hold: several frames may share them.
//
// Lights that each frame places for itself lie elsewhere in every frame, and so does their noise. A frame may instead
// take positions that were placed for a stretch of frames, by camera paths of them all. Where two stretches meet, the
// lights of one fade out while those of the other fade in: in the partition of unity (partition_of_unity.h) each
// light's weight is multiplied by its share.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "transport/direct_light.h"
#include "virtual_lights/placement/camera_candidates.h"
#include "virtual_lights/settings.h"

namespace brisance {

struct PlacedLights {
    std::vector<Deposit> deposits;  // on the triangles of their scene: surfaces that move carry them along
    std::vector<float> distance;    // that each keeps from others [m]
    std::uint64_t candidates = 0;   // that they were chosen from
    double acceptance = 1.0;        // PlacementReport
    double candidate_seconds = 0.0, elimination_seconds = 0.0;
};

// Of the settings' placement, seen by all cameras, whose pictures have equal size. None where nothing shines or nothing
// is placed. Throws Error Usage as check().
PlacedLights place_lights(const DirectLight& scene, std::span<const PixelCamera> cameras,
                          const VirtualLightSettings& settings);

// As bytes for this program's build on this kind of processor, and back. Nothing where they are not of such lights.
std::string to_bytes(const PlacedLights& lights);
std::optional<PlacedLights> placed_lights_of(std::string_view bytes);

// Whether a technique has positions that do not depend on the light that a frame holds.
bool has_positions(const VirtualLightSettings& settings);

// Positions that a frame takes.
struct SharedPositions {
    std::shared_ptr<const PlacedLights> lights;
    double share = 1.0;       // above 0
    std::uint64_t group = 0;  // of random numbers: different ones for sets that a frame takes together
};

}  // namespace brisance
