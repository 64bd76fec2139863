// The picture of one frame by many lights: lighting grids in the medium, virtual lights on surfaces.
#pragma once

#include <optional>

#include "camera/camera.h"
#include "core/stopwatch.h"
#include "diagnostics/light_pictures.h"
#include "emitters/surroundings.h"
#include "film/write_image.h"
#include "forecast/plan.h"
#include "render/shutter/open_shutter.h"
#include "shot/shot.h"
#include "statistics/statistics.h"
#include "virtual_lights/bounded_light.h"
#include "virtual_lights/placed_lights.h"

namespace brisance {

// Until when the camera may work.
struct CameraTime {
    const Stopwatch& watch;  // of the frame
    double end;              // on that [s]
    double left() const { return end - watch.seconds(); }
};

// Input of a picture, by reference.
struct DrawInput {
    const Shot& shot;
    const Plan& plan;
    const Medium& medium;
    const Surroundings* surroundings;  // null: none
    const Camera& camera;
    const OpenShutter* shutter = nullptr;                   // null: nothing moves
    std::span<const SharedPositions> light_positions = {};  // of virtual lights; empty: the frame places its own
    const CameraTime* time = nullptr;                       // null: the camera takes the samples of its settings

    std::span<const Moment> moments() const {  // empty: nothing moves
        return shutter ? shutter->moments() : std::span<const Moment>{};
    }
};

struct Drawn {
    Image image;
    std::optional<LightPictures> light_pictures;  // if output.virtual_lights is set and there are lights
    double samples_per_pixel = 0.0;
    BoundTally bound_costs;  // of the layers of output.layers.bound
};

// Builds the lights, renders the picture and adds its layers. Throws Error Usage for settings that are incompatible.
Drawn draw_by_many_lights(const DrawInput& input, Statistics& statistics, Progress& progress);

// The reason why a shot has no virtual lights to make pictures of, as half a sentence; none if it has some.
std::optional<std::string> why_no_virtual_lights(const Shot& shot, const Plan& plan);

inline constexpr const char* kNoLightPictures = "no pictures of virtual lights are written: ";

}  // namespace brisance
