// Whether a sequence burns, and how its values become radiance.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "first_look/survey.h"
#include "medium/settings.h"

namespace brisance {

enum class Fire { None, Flame, Kelvin };

struct FireChoice {
    Fire fire = Fire::None;
    bool temperature_is_smoke = false;  // nothing else is there to be seen
    std::string why;
};

// A flame grid that is not empty is fire, and so is a temperature grid whose hot part glows when read as kelvin.
// Temperatures of a few units are a simulation's, not kelvin, and by themselves no fire.
FireChoice choose_fire(const SequenceSurvey& survey);

// Of strength 1. Flames: from dull red to yellow white, rising steeply with the flame, so that what burns low is dark
// soot before what burns bright. Kelvin: a black body, times the flame where there is one.
FireSettings fire_of(const FireChoice& choice, const SequenceSurvey& survey);

// The greatest value of a role in all frames that were looked at; 0 where there is none.
double most_of(const SequenceSurvey& survey, std::optional<ValueSummary> FrameSurvey::*role);

}  // namespace brisance
