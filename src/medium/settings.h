// Settings that turn grid values into optical coefficients.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/vec.h"

namespace brisance {

struct SmokeSettings {
    float extinction_per_metre = 1.0f;  // sigma_t of density 1 [1/m]
    Rgb albedo{0.8f};          // sigma_s / sigma_t [1]; multiplied by the colour grid where one is mapped as albedo
    float mean_cosine = 0.0f;  // Henyey-Greenstein g, forward > 0
};

enum class FireModel {
    None,                // nothing emits
    Flame,               // L_e = strength * max(0, flame - threshold) * ramp colour
    Blackbody,           // L_e = strength * Planck(T), absolute [W/(m^2 sr)]
    NormalizedBlackbody  // L_e = strength * Planck(T) with its spectral peak set to 1
};

enum class EmissionConvention {
    TimesAbsorption,  // j = sigma_a * L_e: what absorbs radiates
    Direct            // j = L_e read as emission per metre, whatever the density
};

enum class ColourRole { Albedo, Emission };

struct RampStop {
    float value;  // flame value as stored in the grid
    Rgb colour;   // linear Rec. 709
};

struct FireSettings {
    FireModel model = FireModel::Flame;
    EmissionConvention convention = EmissionConvention::TimesAbsorption;
    float strength = 1.0f;
    float threshold = 0.0f;           // in the emitting grid's own values, before interpolation
    Rgb colour{1.0f};                 // multiplies everything emitted
    std::vector<RampStop> ramp;       // empty: white
    bool modulate_by_flame = false;   // black-body models: multiply by max(0, flame)
    vec2 temperature_in{0.0f, 1.0f};  // grid values ...
    vec2 temperature_kelvin{0.0f,
                            1.0f};  // ... that stand for these temperatures [K]; linear, extrapolated, never below 0
};

struct MediumSettings {
    SmokeSettings smoke;
    FireSettings fire;
    ColourRole colour_role = ColourRole::Albedo;
};

// Settings of a further volume that differ from the shot's. Its phase function is the shot's.
struct MediumChanges {
    std::optional<float> extinction_per_metre;
    std::optional<Rgb> albedo;
    std::optional<FireModel> model;
    std::optional<float> strength, threshold;
    std::optional<Rgb> colour;
    std::optional<std::vector<RampStop>> ramp;
};

MediumSettings changed(MediumSettings settings, const MediumChanges& changes);

}  // namespace brisance
