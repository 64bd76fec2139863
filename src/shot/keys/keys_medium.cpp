#include "shot/keys/keys.h"

namespace brisance {
namespace {

void add_smoke_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "smoke.extinction_per_metre", "extinction coefficient where density is 1 [1/m]", real_float(radiometric()),
        [](Shot & s) -> auto& { return s.medium.smoke.extinction_per_metre; }));
    keys.push_back(make_key(
        "smoke.albedo", "share of the extinguished light that is scattered, linear Rec. 709", rgb({0.0, 1.0}),
        [](Shot & s) -> auto& { return s.medium.smoke.albedo; }));
    keys.push_back(make_key(
        "smoke.mean_cosine", "Henyey-Greenstein g: above 0 scatters forward, below 0 backward",
        real_float({-1.0, 1.0, true, true}), [](Shot & s) -> auto& { return s.medium.smoke.mean_cosine; }));
}

void add_fire_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "fire.model", "flame: strength * (flame - threshold) * ramp; blackbody: Planck [W/(m^2 sr)]", fire_model(),
        [](Shot & s) -> auto& { return s.medium.fire.model; }));
    keys.push_back(make_key(
        "fire.convention",
        "times_absorption: emission per metre is radiance times absorption; direct: whatever the density",
        choice<EmissionConvention>(
            {{"times_absorption", EmissionConvention::TimesAbsorption}, {"direct", EmissionConvention::Direct}}),
        [](Shot & s) -> auto& { return s.medium.fire.convention; }));
    keys.push_back(make_key(
        "fire.strength", "multiplies the emission", real_float(radiometric()),
        [](Shot & s) -> auto& { return s.medium.fire.strength; }));
    keys.push_back(make_key(
        "fire.threshold", "subtracted from the emitting grid's values, before interpolation", real_float(radiometric()),
        [](Shot & s) -> auto& { return s.medium.fire.threshold; }));
    keys.push_back(make_key(
        "fire.colour", "multiplies the emission, linear Rec. 709", rgb(tint()),
        [](Shot & s) -> auto& { return s.medium.fire.colour; }));
    keys.push_back(make_key(
        "fire.ramp", "colour over the flame grid's values, linear in between; empty: white", ramp(),
        [](Shot & s) -> auto& { return s.medium.fire.ramp; }));
    keys.push_back(make_key(
        "fire.modulate_by_flame", "multiplies black-body emission by the flame grid", flag(),
        [](Shot & s) -> auto& { return s.medium.fire.modulate_by_flame; }));
    keys.push_back(make_key(
        "fire.temperature_in", "two values of the temperature grid ...", pair_of(grid_value()),
        [](Shot & s) -> auto& { return s.medium.fire.temperature_in; }));
    keys.push_back(make_key(
        "fire.temperature_kelvin", "... and the temperatures they stand for [K]; linear beyond them", pair_of(kelvin()),
        [](Shot & s) -> auto& { return s.medium.fire.temperature_kelvin; }));
}

}  // namespace

void add_medium_keys(std::vector<Key>& keys) {
    add_smoke_keys(keys);
    add_fire_keys(keys);
    keys.push_back(make_key(
        "colour_role", "what the colour grid multiplies",
        choice<ColourRole>({{"albedo", ColourRole::Albedo}, {"emission", ColourRole::Emission}}),
        [](Shot & s) -> auto& { return s.medium.colour_role; }));
}

}  // namespace brisance
