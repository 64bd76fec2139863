// How all kinds of light are chosen together at the surfaces and in the smoke that the camera sees.
#pragma once

#include <cstdint>
#include <string>

namespace brisance {

// Not in the table of samplings (samplings.h): each kind of light has its own choice.
constexpr const char* kLightsApart = "none";

struct UnifiedLightSettings {
    std::string sampling = kLightsApart;  // a name of unified_light_sampling_names()
    bool smoke = true;                    // also in smoke, along the camera's rays; false: on surfaces alone
    int points = 4;                       // on every ray through smoke at which light is gathered
    int samples = 1;                      // sampling intensity, light_tree: lights at every point
    double lightcuts_error = 0.02;        // sampling lightcuts, multidimensional_lightcuts: what a node may err, over
                                          // the sum of all
    int lightcuts_most = 1000;            // ... and the most nodes of a cut, of a point or of a whole ray
    int stochastic_cut_size = 10;         // sampling stochastic_lightcuts: nodes of a cut, each with one light
    std::uint32_t seed = 0;               // other seeds draw other random numbers
};

}  // namespace brisance
