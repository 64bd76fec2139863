// How the light of the fire's voxels is gathered in the smoke and on the surfaces that the camera sees.
#pragma once

#include <cstdint>
#include <string>

namespace brisance {

// Not in the table of samplings (samplings.h): the lighting grid brings the light to the medium's nodes and
// to surfaces.
constexpr const char* kFireByHierarchy = "hierarchy";

struct FireLightSettings {
    std::string sampling = kFireByHierarchy;  // a name of fire_light_sampling_names()
    int points = 4;                           // on every ray through smoke at which light is gathered
    int samples = 1;                          // sampling intensity, light_tree: lights at every point
    double lightcuts_error = 0.02;            // sampling lightcuts, multidimensional_lightcuts: what a node may err,
                                              // over the sum of all
    int lightcuts_most = 1000;                // ... and the most nodes of a cut, of a point or of a whole ray
    int stochastic_cut_size = 10;             // sampling stochastic_lightcuts: nodes of a cut, each with one light
    std::uint32_t seed = 0;                   // other seeds draw other random numbers
};

}  // namespace brisance
