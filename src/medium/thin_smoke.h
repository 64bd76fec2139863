// The definition of thin smoke beside dense smoke, shared by all code that treats it separately.
#pragma once

#include <span>

namespace brisance {

// The mean extinction weighted by extinction [1/m]. It is that of the dense smoke, however much thin smoke surrounds
// it.
inline double extinction_met(std::span<const float> extinction) {
    double sum = 0.0, squares = 0.0;
    for (const float e : extinction) {
        sum += e;
        squares += double(e) * e;
    }
    return sum > 0.0 ? squares / sum : 0.0;
}

// Smoke is thin up to this share of extinction_met().
constexpr float kThinSmoke = 0.05f;
// Share of thin nodes among those with extinction. Fringes of real smoke make up to a third; above this share the
// volume holds thin smoke of its own.
constexpr float kFringes = 0.4f;

}  // namespace brisance
