// Rounding to whole numbers without a call into the mathematical library.
#pragma once

#include <cmath>
#include <cstdint>

namespace brisance {

// The whole number nearest to x, of two the one farther from zero, as std::llround gives it, for |x| < 2^63. What is
// added is the largest number below one half: one half itself would round the number before it up.
inline std::int64_t nearest_whole(double x) {
    return static_cast<std::int64_t>(x + std::copysign(0x1.fffffffffffffp-2, x));
}

}  // namespace brisance
