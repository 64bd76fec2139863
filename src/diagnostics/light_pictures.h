// Pictures of the many-light method: the positions of virtual lights, their contents, and the lengths of paths.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "emitters/surroundings.h"
#include "film/image.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

struct LightPictures {
    struct Light {
        dvec3 position{0.0};           // world [m]
        dvec3 normal{0.0, 0.0, 1.0};   // unit, on the lit side
        dvec3 tangent{1.0, 0.0, 0.0};  // the first axis of its profile
        double radius = 0.0;           // [m]
        double area = 0.0;             // [m^2]
        Rgb flux{0.0f};                // reflected [W]
        int profile = -1;              // its tile in `profiles`; -1: Lambert, it has none
    };
    std::vector<Light> lights;

    // Layers: beauty, the lights seen as discs over the picture in dim gray; "lights", the discs alone, with the
    // radiance that each sends to the camera and alpha; "light", the number of the light seen, from 1, else 0; "count",
    // the number of lights that cover the surface point behind the pixel's middle (0 to LightShares::kMost; 0: none, or
    // no surface); "path_length", mean number of vertices of the pixel's paths, 0 where there were none.
    Image image;

    // Profiles side by side: tile t lies in column t % columns and row t / columns; a tile is one light's map of the
    // radiance that it reflects (virtual_lights/octahedral_map.h, around tangent and normal). Without layers where no
    // light has a profile.
    Image profiles;
    int tile = 0;     // texels along a tile's side
    int columns = 0;  // tiles in a row

    std::size_t seen = 0;  // lights that have a disc
};

// `picture`: the frame's beauty. `lengths`: as of PathLengths. Surfaces hide lights, smoke does not.
LightPictures make_light_pictures(const VirtualLights& lights, const Surroundings& surroundings, const Camera& camera,
                                  const Layer& picture, std::vector<float> lengths);

}  // namespace brisance
