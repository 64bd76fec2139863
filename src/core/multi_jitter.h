// Numbers that the samples of a pixel divide among themselves, so that together they cover what they choose from.
//
// Correlated multi-jittered sampling (Kensler, Correlated Multi-Jittered Sampling, Pixar Technical Memo 13-01, 2013):
// of m^2 samples one lies in each cell of an m x m grid, one in each of m^2 columns, and one in each of m^2 rows. The
// m samples with different places along both sides of the pixel do so in m columns and m rows.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/rng.h"
#include "core/vec.h"

namespace brisance {

class MultiJitter {
public:
    // `side`: m. `order`: names the pixel and what is chosen; others are arranged otherwise.
    MultiJitter(std::uint32_t side, Rng order) : side_(side) {
        for (std::uint32_t& key : keys_)
            key = static_cast<std::uint32_t>(order.next_double() * 0x1p30) | 0x40000000u;
    }

    // In [0, 1)^3, for one of m^2 samples; each third number is of one of m^2 strata, too. `jitter`: within the strata.
    dvec3 at(std::uint32_t sample, Rng& jitter) const {
        const std::uint32_t m = side_, n = m * m, row = sample / m % m, column = sample % m;
        const double x = place(row, m, keys_[0]) + (place(column, m, keys_[1]) + jitter.next_double()) / m,
                     y = place(column, m, keys_[2]) + (place(row, m, keys_[3]) + jitter.next_double()) / m,
                     z = place(sample % n, n, keys_[4]) + jitter.next_double();
        return glm::min(dvec3(x / m, y / m, z / n), dvec3(1.0 - 0x1p-53));
    }

private:
    // Where element i of n stands in the permutation that the key names. Each step is a bijection of the next power of
    // two, repeated until it stays below n.
    static std::uint32_t place(std::uint32_t i, std::uint32_t n, std::uint32_t key) {
        const std::uint32_t mask = std::bit_ceil(n) - 1;
        const int half = std::max(1, int(std::bit_width(mask)) / 2);
        do {
            for (std::uint32_t k = key; k != 0; k >>= 6) {
                i = (i * (2 * k + 1) + (k >> 3)) & mask;
                i ^= i >> half;
            }
        } while (i >= n);
        return i;
    }

    std::uint32_t side_, keys_[5];
};

}  // namespace brisance
