// The extinction that light meets in a medium.
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

}  // namespace brisance
