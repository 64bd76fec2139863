// What counts as haze beside dense smoke: one measure for all who treat it apart.
#pragma once

#include <span>

namespace brisance {

// The mean extinction where light meets smoke, by extinction [1/m]: that of the smoke proper, however much haze there
// is around it.
inline double extinction_met(std::span<const float> extinction) {
    double sum = 0.0, squares = 0.0;
    for (const float e : extinction) {
        sum += e;
        squares += double(e) * e;
    }
    return sum > 0.0 ? squares / sum : 0.0;
}

// Of extinction_met(): no more is thin smoke.
constexpr float kThinSmoke = 0.05f;
// Of the nodes with extinction that are thin: fringes of real smoke are up to a third; above this there is haze.
constexpr float kFringes = 0.4f;

}  // namespace brisance
